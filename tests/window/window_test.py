"""What the tests of the window share: a scene, scripts, pictures, and a display with hands."""

import json
import os
import shlex
import shutil
import struct
import subprocess
import tempfile
import time
import unittest
import zlib
from pathlib import Path

import tiny_scene

# Set by run_tests.py.
view = midway = None
slow = 1.0
pictures = None  # a folder where pictures are left to be looked at

# What a person has chosen elsewhere must not reach a test.
LEFT_OUT = ("DISPLAY", "WAYLAND_DISPLAY", "XDG_CONFIG_HOME")


def read_png(path):
    """(width, height, rows of bytes, three a pixel) of an 8-bit RGB PNG."""
    data = Path(path).read_bytes()
    width, height, depth, kind = struct.unpack_from(">IIBB", data, 16)
    if data[:8] != b"\x89PNG\r\n\x1a\n" or (depth, kind) != (8, 2):
        raise ValueError(f"{path} is no 8-bit RGB PNG")
    at, packed = 8, b""
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw, rows, before = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        start = y * (3 * width + 1)
        before = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + 3 * width]), before)
        rows.append(before)
    return width, height, rows


def unfilter(kind, row, above):
    """One row of a PNG from its differences."""
    for i, value in enumerate(row):
        left, up = (row[i - 3] if i >= 3 else 0), above[i]
        corner = above[i - 3] if i >= 3 else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = up
        elif kind == 3:
            guess = (left + up) // 2
        elif kind == 4:
            guess = min((abs(up - corner), 0, left), (abs(left - corner), 1, up),
                        (abs(left + up - 2 * corner), 2, corner))[2]
        else:
            guess = 0
        row[i] = (value + guess) & 255
    return bytes(row)


def part(picture, x0, y0, x1, y1):
    """The pixels of a rectangle as a list of (r, g, b)."""
    _, _, rows = picture
    return [tuple(rows[y][3 * x:3 * x + 3]) for y in range(y0, y1) for x in range(x0, x1)]


class WindowTest(unittest.TestCase):
    """Each case has a folder of its own with tiny.gltf in it, and works there."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="midway-window-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.scene = tiny_scene.write_gltf(self.folder / "tiny.gltf")
        self.environment = {k: v for k, v in os.environ.items() if k not in LEFT_OUT}
        self.environment["XDG_CONFIG_HOME"] = str(self.folder / "config")

    def run_view(self, *arguments, status=0, seconds=180):
        done = subprocess.run([str(view), *map(str, arguments)], capture_output=True, text=True,
                              timeout=seconds * slow, stdin=subprocess.DEVNULL, check=False,
                              cwd=self.folder, env=self.environment)
        if status is not None:
            self.assertEqual(status, done.returncode, done.stderr)
        return done

    def play(self, script, *arguments, size="400x300", **options):
        """Plays a script offscreen, in the case's folder; `quit` is added."""
        path = self.folder / "script.txt"
        path.write_text(f"timeout {60 * slow:g}\n{script}\nquit\n")
        return self.run_view("--offscreen", "--window", size, "--script", path, *arguments,
                             **options)

    def report(self, name="report.json"):
        return json.loads((self.folder / name).read_text())

    def run_command_line(self, path):
        """Runs a command line that the window copied, with our own program."""
        words = shlex.split(Path(path).read_text())
        self.assertEqual("midway", words[0])
        done = subprocess.run([str(midway), *words[1:], "--quiet"], capture_output=True, text=True,
                              timeout=120 * slow, check=False, cwd=self.folder)
        self.assertEqual(0, done.returncode, done.stderr)
        return self.folder / words[words.index("-o") + 1]

    def keep(self, name):
        """Leaves a picture of the case's folder where somebody wants to look at it."""
        if pictures:
            pictures.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.folder / name, pictures / name)


def wait_for(what, seconds=40):
    """The first true value of what(), asked again and again; None where none comes in time."""
    end = time.monotonic() + seconds * slow
    while time.monotonic() < end:
        value = what()
        if value:
            return value
        time.sleep(0.1)
    return None


class Desktop:
    """Xvfb on a display number that it finds itself, and xdotool in it."""

    def __init__(self, environment):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x720x24", "-nolisten", "tcp",
             "-noreset"],  # or the first client that leaves makes the server start anew
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            pass_fds=[write])
        os.close(write)
        with open(read, encoding="ascii") as told:  # ends when the server does
            number = told.readline().strip()
        if not number:
            self.close()
            raise RuntimeError("Xvfb found no display number")
        self.environment = dict(environment, DISPLAY=f":{number}")
        if not wait_for(lambda: self.hand("getdisplaygeometry")):
            self.close()
            raise RuntimeError(f"Xvfb does not answer on display {number}")

    def hand(self, *arguments):
        """xdotool's answer, empty where it failed."""
        done = subprocess.run(["xdotool", *map(str, arguments)], capture_output=True, text=True,
                              check=False, env=self.environment, timeout=60 * slow)
        return done.stdout if done.returncode == 0 else ""

    def close(self):
        if self.server.poll() is None:
            self.server.terminate()
        self.server.wait()


TOOLS = [tool for tool in ("Xvfb", "xdotool") if not shutil.which(tool)]


class HandsTest(WindowTest):
    """A window on a display in memory, with real mouse and key events. Skip where TOOLS are missing."""

    def setUp(self):
        super().setUp()
        self.desktop = Desktop(self.environment)
        self.addCleanup(self.desktop.close)
        self.hand = self.desktop.hand

    def open_window(self, *arguments):
        self.process = subprocess.Popen(
            [str(view), *map(str, arguments)], cwd=self.folder, text=True,
            env=self.desktop.environment, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.addCleanup(self.process.communicate)
        self.addCleanup(self.process.kill)

    def wait_for_title(self, title):
        if not wait_for(lambda: self.hand("search", "--name", f"^{title}$")):
            if self.process.poll() is not None:
                self.fail(f"ended with {self.process.returncode}: {self.process.stderr.read()}")
            self.fail(f"no window is called {title}")

    def look(self, name):
        """A picture of the screen for whoever wants one."""
        if pictures and shutil.which("import"):
            subprocess.run(["import", "-window", "root", f"visit-{name}.png"], check=False,
                           cwd=self.folder, env=self.desktop.environment)
            self.keep(f"visit-{name}.png")

    def press(self, key):
        self.hand("key", key)

    def drag(self, x, y, dx, dy):
        """As a hand drags: a busy window must have frames between press, moves and release."""
        self.hand("mousemove", x, y)
        time.sleep(0.2 * slow)
        self.hand("mousedown", 1)
        time.sleep(0.2 * slow)
        for step in range(1, 9):
            self.hand("mousemove", x + dx * step // 8, y + dy * step // 8)
            time.sleep(0.03 * slow)
        time.sleep(0.2 * slow)
        self.hand("mouseup", 1)

    def open_in_steps(self, lines, title, waits=()):
        """Opens the window with a script that then leaves mouse and keys to the hands, and reports
        whenever state() gives the word."""
        lines = ["timeout 200", *lines, "wait loaded", "wait idle", "hands off"]
        for step in range(40):
            lines += [f"wait file go-{step}", "wait idle", *waits, "wait frames 3",
                      f"report look-{step}.json"]
        (self.folder / "script.txt").write_text("\n".join(lines))
        self.step = 0
        self.open_window("--window", "1280x720", "--script", "script.txt")
        self.wait_for_title(title)

    def state(self):
        """What the window reports once it has done what it was asked to."""
        time.sleep(0.3 * slow)
        (self.folder / f"go-{self.step}").touch()
        path = self.folder / f"look-{self.step}.json"
        self.step += 1
        if not wait_for(path.exists, 120):
            self.fail(f"no report; {self.process.poll()}")
        return json.loads(path.read_text())

    def click_in(self, report, section, below):
        """A click in the section so many pixels below its top."""
        x0, y0, _, _ = report["sections"][section]
        self.hand("mousemove", round(x0 + 70), round(y0 + below), "click", 1)
