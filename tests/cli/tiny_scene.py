"""A scene that renders in a blink: floor, back wall, a lamp quad above, a point light, two cameras."""

import base64
import json
import struct


def quad(corner, u, v):
    """Four corners of a parallelogram, counter-clockwise seen from u x v."""
    def at(a, b):
        return [corner[i] + a * u[i] + b * v[i] for i in range(3)]
    return [at(0, 0), at(1, 0), at(1, 1), at(0, 1)]


def document(albedo=0.6):
    """The glTF document as a dictionary; its one buffer is a data URI."""
    quads = [quad([-2, 0, 2], [4, 0, 0], [0, 0, -4]),       # floor, up
             quad([-2, 0, -2], [4, 0, 0], [0, 3, 0]),       # wall, towards the camera
             quad([-0.5, 2, -0.5], [1, 0, 0], [0, 0, 1])]   # lamp, down
    positions = [point for corners in quads for point in corners]
    data = b"".join(struct.pack("<3f", *point) for point in positions)
    data += struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    indices = len(quads)
    accessors = [{"bufferView": 0, "byteOffset": 48 * i, "componentType": 5126, "count": 4,
                  "type": "VEC3", "min": [min(p[k] for p in corners) for k in range(3)],
                  "max": [max(p[k] for p in corners) for k in range(3)]}
                 for i, corners in enumerate(quads)]
    accessors.append({"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"})
    camera = {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}
    return {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "name": "bulb", "intensity": 3}]}},
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64,"
                     + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48 * len(quads)},
                        {"buffer": 0, "byteOffset": 48 * len(quads), "byteLength": 12}],
        "accessors": accessors,
        "materials": [
            {"name": "chalk", "pbrMetallicRoughness": {
                "baseColorFactor": [albedo, 0.9 * albedo, 0.7 * albedo, 1],
                "metallicFactor": 0, "roughnessFactor": 0.8}},
            {"name": "lamp", "emissiveFactor": [1, 1, 1],
             "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}],
        "meshes": [{"name": "room", "primitives": [
            {"attributes": {"POSITION": i}, "indices": indices, "material": int(i == 2)}
            for i in range(3)]}],
        "cameras": [camera, camera],
        "nodes": [{"mesh": 0, "name": "room"},
                  {"camera": 0, "name": "eye", "translation": [0, 1.2, 4]},
                  {"camera": 1, "name": "low", "translation": [0.5, 0.4, 3]},
                  {"name": "bulb", "translation": [1, 1.5, 1],
                   "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "scenes": [{"nodes": [0, 1, 2, 3]}],
        "scene": 0,
    }


def write_gltf(path, **options):
    path.write_text(json.dumps(document(**options)))
    return path


def write_glb(path, **options):
    """The same scene as .glb, its buffer in the binary chunk."""
    scene = document(**options)
    data = base64.b64decode(scene["buffers"][0].pop("uri").split(",")[1])
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(data), 0x004E4942) + data
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
    return path
