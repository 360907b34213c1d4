"""A second, independent reader of the EXR files that midway writes: scanlines of float or half,
uncompressed, ZIPS or ZIP. Source: "OpenEXR file layout" (openexr.com)."""

import struct
import zlib

LINES_PER_CHUNK = {0: 1, 2: 1, 3: 16}  # none, ZIPS, ZIP
TYPE = {0: ("I", 4), 1: ("e", 2), 2: ("f", 4)}


def read_string(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


class ExrFile:
    """attributes: name -> raw bytes; channels: [(name, type)] in file order; chunks: raw bytes of
    each block of scanlines, for comparisons to the bit; width, height, origin."""

    def __init__(self, path):
        data = path.read_bytes()
        if data[:4] != b"\x76\x2f\x31\x01":
            raise ValueError(f"{path} is no EXR file")
        at = 8
        self.attributes = {}
        while data[at]:
            name, at = read_string(data, at)
            _, at = read_string(data, at)
            size, = struct.unpack_from("<I", data, at)
            self.attributes[name] = data[at + 4:at + 4 + size]
            at += 4 + size
        self.compression = self.attributes["compression"][0]
        x0, y0, x1, y1 = struct.unpack("<4i", self.attributes["dataWindow"])
        self.origin, self.width, self.height = (x0, y0), x1 - x0 + 1, y1 - y0 + 1
        self.channels = []
        raw, place = self.attributes["channels"], 0
        while raw[place]:
            name, place = read_string(raw, place)
            self.channels.append((name, struct.unpack_from("<i", raw, place)[0]))
            place += 16
        lines = LINES_PER_CHUNK[self.compression]
        count = (self.height + lines - 1) // lines
        self.chunks = []
        for offset in struct.unpack_from(f"<{count}Q", data, at + 1):
            _, size = struct.unpack_from("<ii", data, offset)
            self.chunks.append(data[offset + 8:offset + 8 + size])

    def pixels(self):
        """Channel name -> list of height lists of width numbers."""
        lines = LINES_PER_CHUNK[self.compression]
        planes = {name: [] for name, _ in self.channels}
        row_bytes = sum(TYPE[kind][1] for _, kind in self.channels) * self.width
        for index, chunk in enumerate(self.chunks):
            rows = min(lines, self.height - index * lines)
            if self.compression and len(chunk) < rows * row_bytes:
                chunk = unpack(zlib.decompress(chunk))
            at = 0
            for _ in range(rows):
                for name, kind in self.channels:
                    letter, size = TYPE[kind]
                    planes[name].append(struct.unpack_from(f"<{self.width}{letter}", chunk, at))
                    at += size * self.width
        return planes


def unpack(data):
    """Undoes EXR's byte differences and the splitting into even and odd bytes."""
    values = bytearray(data)
    for i in range(1, len(values)):
        values[i] = (values[i - 1] + values[i] - 128) & 255
    half = (len(values) + 1) // 2
    result = bytearray(len(values))
    result[0::2], result[1::2] = values[:half], values[half:]
    return bytes(result)
