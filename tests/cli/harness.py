"""What the command line tests share: running midway, and what its answers must look like."""

import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import tiny_scene

ERROR_LINE = re.compile(r"^midway: error: \S.* \(.+\); \S.*$")
SIZE = "32x24"

SOURCE = Path(__file__).resolve().parents[2]

# Set by run_tests.py: the program, and a factor on every time limit (sanitizer builds are slow).
program = None
slow = 1.0


class CliTest(unittest.TestCase):
    """Each case has a folder of its own (self.folder) with tiny.gltf in it."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="midway-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.scene = tiny_scene.write_gltf(self.folder / "tiny.gltf")
        self.out = self.folder / "out"
        self.out.mkdir()

    def run_midway(self, *arguments, seconds=60, status=0):
        """Runs midway; fails unless it ends in time with this exit status (None: any)."""
        command = [str(program), *map(str, arguments)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=seconds * slow,
                                  stdin=subprocess.DEVNULL, check=False, errors="replace")
        except subprocess.TimeoutExpired:
            self.fail(f"did not end within {seconds * slow:g} s: {' '.join(command)}")
        if status is not None:
            self.assertEqual(status, done.returncode, f"{' '.join(command)}\n{done.stderr}")
        return done

    def render(self, *arguments, size=SIZE, **options):
        """A short render of the tiny scene."""
        return self.run_midway("render", self.scene, "--size", size, *arguments, **options)

    def render_exr(self, name, *arguments, seed=5, **options):
        path = self.out / f"{name}.exr"
        self.render("-o", path, "--seed", seed, *arguments, **options)
        return path

    def refused(self, *arguments, status, seconds=15):
        """Runs midway, which must refuse with this status, one error line, and nothing on stdout.
        Returns the line."""
        done = self.run_midway(*arguments, status=status, seconds=seconds)
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        self.assertEqual(1, len(lines), f"one line, but stderr is:\n{done.stderr}")
        self.assertRegex(lines[0], ERROR_LINE)
        self.assertEqual("", done.stdout)
        return lines[0]

    def stats(self, *arguments, **options):
        """Renders with --stats and returns what the file says."""
        file = self.folder / "stats.json"
        self.render("-o", self.out / "stats.exr", "--stats", file, *arguments, **options)
        return json.loads(file.read_text())

    def start(self, *arguments):
        """Starts midway; it is killed when the case ends."""
        process = subprocess.Popen([str(program), *map(str, arguments)], text=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)

        def stop():
            if process.poll() is None:
                process.kill()
            process.communicate()
        self.addCleanup(stop)
        return process

    def wait_until_rendering(self, process, seconds=2):
        """Lets a long render get under way."""
        time.sleep(seconds * slow)
        if process.poll() is not None:
            self.fail(f"ended by itself with {process.returncode}:\n{process.stderr.read()}")

    def interrupt(self, process, seconds=15):
        """Sends Ctrl-C and returns the exit status."""
        os.kill(process.pid, signal.SIGINT)
        return process.wait(timeout=seconds * slow)

    def assert_files(self, *names):
        """Nothing but these files lies in the output folder: no part left beside."""
        self.assertEqual(sorted(names), sorted(path.name for path in self.out.iterdir()))
