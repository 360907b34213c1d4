"""A person's visit: the window on a display in memory, with real mouse and key events."""

import json
import time
import unittest
from pathlib import Path

import tiny_scene
from exr_file import ExrFile
from window_test import TOOLS, HandsTest, read_png, wait_for


@unittest.skipIf(TOOLS, f"{' and '.join(TOOLS)} missing (app/packages.txt lists them)")
class Visit(HandsTest):
    saved = 0

    def save(self):
        """Saves with Ctrl+S and returns the EXR file."""
        self.saved += 1
        path = self.folder / ("tiny.exr" if self.saved == 1 else f"tiny-{self.saved}.exr")
        self.press("ctrl+s")
        self.assertTrue(wait_for(path.exists), f"{path.name} was not saved")
        return ExrFile(path)

    def save_until(self, good, what):
        """Saves until the file is as it should be: an edit may still be on its way."""
        for _ in range(8):
            exr = self.save()
            if good(exr):
                return exr
        return self.fail(f"the saved image does not show it: {what}")

    def test_open_orbit_switch_save_reload_quit(self):
        self.open_window(self.scene, "--window", "1280x720", "--size", "64x48", "--spp", 4)
        self.wait_for_title("tiny.gltf - Midway")
        self.hand("mousemove", 640, 300)
        first = self.save()
        self.look("1-open")
        self.assertEqual((64, 48), (first.width, first.height))
        self.assertIn(b'"technique":"auto"', first.attributes["midway:settings"])

        self.drag(640, 300, -80, 24)
        self.look("2-orbit")
        seen = first.attributes["midway:scene_hash"]
        self.save_until(lambda e: e.attributes["midway:scene_hash"] != seen, "another camera")

        self.hand("mousemove", 52, 49, "click", 1)
        self.look("3-technique")
        self.save_until(lambda e: b'"technique":"path"' in e.attributes["midway:settings"],
                        "path tracing")
        self.hand("mousemove", 99, 126, "click", 1)
        self.look("4-exponent")
        balance = self.save_until(lambda e: e.attributes["midway:exponent"] == b"1", "exponent 1")

        self.press("ctrl+p")
        self.assertTrue(wait_for((self.folder / "tiny.png").exists))
        self.assertEqual((64, 48), read_png(self.folder / "tiny.png")[:2])

        tiny_scene.write_gltf(self.scene, albedo=0.2)
        self.press("F5")
        seen = balance.attributes["midway:scene_hash"]
        last = self.save_until(lambda e: e.attributes["midway:scene_hash"] != seen, "another file")
        self.assertIn(b'"technique":"path"', last.attributes["midway:settings"])
        self.look("5-reload")

        other = tiny_scene.write_gltf(self.folder / "other.gltf")
        self.press("ctrl+o")
        time.sleep(1)
        self.hand("type", "--delay", "20", str(other))
        self.press("Return")
        self.wait_for_title("other.gltf - Midway")
        self.look("6-other")

        self.press("Escape")
        self.hand("mousemove", 640, 300)
        self.press("ctrl+q")
        self.assertIsNotNone(wait_for(lambda: self.process.poll() is not None))
        self.assertEqual(0, self.process.returncode, self.process.stderr.read())
        memory = (self.folder / "config" / "midway" / "imgui.ini").read_text()
        self.assertIn(f"Recent={other}\nRecent={self.scene}", memory)
        self.assertIn("Size=1280,720", memory)

    def pyramid_cells(self, *arguments):
        """Where the cells of the pyramid lie in a window of 1280 x 720, by strategy."""
        self.play("wait loaded\nset pyramid on\nwait strategies 1\nwait frames 3\nreport cells.json",
                  *arguments, size="1280x720")
        pyramid = self.report("cells.json")["pyramid"]
        self.assertEqual(45, len(pyramid["cells"]))
        return {(c["s"], c["t"]): c for c in pyramid["cells"]}

    def window_values(self):
        """What a session saved now says of the window."""
        self.sessions = getattr(self, "sessions", 0) + 1
        path = self.folder / ("idol.midway" if self.sessions == 1 else f"idol-{self.sessions}.midway")
        self.press("ctrl+shift+s")
        self.assertTrue(wait_for(path.exists), f"{path.name} was not saved")
        return json.loads(path.read_text())["window"]

    def picture(self, number):
        """A PNG of what is seen."""
        path = self.folder / ("idol.png" if number == 1 else f"idol-{number}.png")
        self.press("ctrl+p")
        self.assertTrue(wait_for(path.exists), f"{path.name} was not saved")
        return read_png(path)

    def test_pyramid_choose_add_bare_and_back(self):
        idol = Path(__file__).resolve().parents[2] / "assets" / "idol.glb"
        arguments = [idol, "--size", "64x48", "--spp", 24]
        cells = self.pyramid_cells(*arguments)
        self.assertTrue(cells[1, 1]["left_out"])
        self.assertFalse(cells[2, 1]["left_out"])
        self.open_window(*arguments, "--window", "1280x720")
        self.wait_for_title("idol.glb - Midway")
        self.hand("mousemove", 640, 300)
        self.press("shift+p")
        self.assertEqual("on", self.window_values()["pyramid"])
        whole = self.picture(1)

        def click(cell, *held):
            at = cells[cell]["x"], cells[cell]["y"]
            self.hand("mousemove", *at)
            time.sleep(0.3)
            for key in held:
                self.hand("keydown", key)
            self.hand("click", 1)
            time.sleep(0.3)
            for key in held:
                self.hand("keyup", key)

        click((2, 1))
        self.look("8-strategy")
        self.assertEqual("2,1", self.window_values()["strategies"])
        one = self.picture(2)
        click((1, 1))
        self.assertEqual("2,1", self.window_values()["strategies"], "what is left out has no picture")
        click((1, 4), "ctrl")
        self.assertEqual("2,1;1,4", self.window_values()["strategies"])
        self.look("9-sum")
        self.hand("mousemove", 845, 41, "click", 1)
        values = self.window_values()
        self.assertEqual(("bare", "2,1;1,4"), (values["pyramid-weights"], values["strategies"]))
        self.look("10-bare")
        bare = self.picture(3)
        self.assertEqual(3, len({tuple(map(bytes, p[2])) for p in (whole, one, bare)}))
        self.press("Escape")
        self.assertEqual("none", self.window_values()["strategies"])
        # The render never began anew, and its file is the whole image of all its samples.
        self.press("ctrl+s")
        self.assertTrue(wait_for((self.folder / "idol.exr").exists))
        self.press("shift+p")
        self.assertEqual("off", self.window_values()["pyramid"])
        self.press("ctrl+q")
        self.assertIsNotNone(wait_for(lambda: self.process.poll() is not None))
        self.assertEqual(0, self.process.returncode, self.process.stderr.read())

    def test_first_visit_opens_the_idol_and_offers_the_tour(self):
        self.open_window("--window", "900x600", "--size", "64x64", "--spp", 1)
        self.wait_for_title("idol.glb - Midway")
        self.look("7-first")
        self.hand("mousemove", 450, 300)
        self.press("ctrl+q")
        self.assertIsNotNone(wait_for(lambda: self.process.poll() is not None))
        self.assertEqual(0, self.process.returncode)
