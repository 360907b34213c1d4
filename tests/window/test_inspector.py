"""The path inspector: by scripts, and with real mouse and key events on the idol."""

import json
import math
import unittest
from pathlib import Path

from window_test import TOOLS, HandsTest, WindowTest, part, read_png, wait_for

IDOL = Path(__file__).resolve().parents[2] / "assets" / "idol.glb"


def luminance(rgb):
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


class Inspector(WindowTest):
    def assert_weights(self, seen):
        """The render's weights sum to one over all strategies, and so does the direct form."""
        for path in seen["paths"]:
            for kind in ("weight", "direct"):
                total = sum(k[kind] for k in path["strategies"])
                self.assertAlmostEqual(1, total, 4, f"{kind} of {path['strategy']}")

    def assert_gave(self, seen):
        """What the sample gave is the sum of what its paths gave to this pixel."""
        own = [p["gave"] for p in seen["paths"] if p["pixel"] == seen["pixel"]]
        for channel in range(3):
            total = sum(gave[channel] for gave in own)
            self.assertTrue(math.isclose(total, seen["gave"][channel], rel_tol=1e-5, abs_tol=1e-12))

    def test_a_script_inspects_samples_and_finds_the_brightest(self):
        self.play(f"open {self.scene}\nset size 64x48\nset spp 8\nwait idle\n"
                  "inspect 20,30,5\nwait inspected\nwait frames 2\nscreenshot inspected.png\n"
                  "report one.json\ninspect 20,30,brightest\nwait inspected\nreport best.json\n"
                  "inspect brightest\nwait inspected\nreport image.json\n"
                  "inspect path 0\nwait inspected\ncamera orbit 30 5\nwait idle\nwait inspected\n"
                  "report moved.json\ninspect off\nwait frames 2\nreport off.json",
                  size="1280x720")
        self.keep("inspected.png")
        one, best, image = (self.report(f"{n}.json")["inspector"] for n in ("one", "best", "image"))
        self.assertEqual([20, 30], one["pixel"])
        self.assertEqual([20, 30, 5], one["sample"])
        self.assertEqual("camera", one["camera"][0]["kind"])
        self.assertGreater(one["lines"]["all"], 0)
        for seen in (one, best, image):
            self.assert_weights(seen)
            self.assert_gave(seen)
        self.assertEqual([20, 30], best["pixel"])
        self.assertGreaterEqual(luminance(best["gave"]), luminance(one["gave"]))
        moved = self.report("moved.json")["inspector"]
        self.assertTrue(moved["camera_moved"])
        self.assertEqual(image["sample"], moved["sample"], "the path stays where it is in space")
        self.assertEqual(image["camera"], moved["camera"])
        self.assertNotIn("inspector", self.report("off.json"))
        # The dock is there, and the frame about the pixel is white.
        picture = read_png(self.folder / "inspected.png")
        self.assertGreater(len(set(part(picture, 0, 480, 1280, 680))), 30)

    def test_mistakes_name_their_line(self):
        for words in ("1", "1,2,three", "path 3", "path", "nonfinite", "-1,2"):
            with self.subTest(words):
                done = self.play(f"open {self.scene}\nset size 16x12\nset spp 1\nwait idle\n"
                                 f"inspect {words}", status=1)
                self.assertRegex(done.stderr, r"^midway-view: error: .*script.txt:6\); \S")


@unittest.skipIf(TOOLS, f"{' and '.join(TOOLS)} missing (app/packages.txt lists them)")
class InspectorVisit(HandsTest):
    """The camera looks at a caustic; the hands click, press keys and drag."""

    assert_weights = Inspector.assert_weights
    assert_gave = Inspector.assert_gave

    def until(self, good, what):
        """The inspector's part of the first report that is as it should be."""
        def look():
            try:
                seen = json.loads((self.folder / "now.json").read_text())
            except (OSError, ValueError):
                return None
            return seen if good(seen.get("inspector")) else None
        seen = wait_for(look, 100)
        if not seen:
            if self.process.poll() is not None:
                self.fail(f"ended with {self.process.returncode}: {self.process.stderr.read()}")
            self.fail(f"the report does not show it: {what}")
        return seen.get("inspector")

    def test_a_caustic_and_a_firefly_of_the_idol(self):
        script = self.folder / "script.txt"
        # 453 pixels high is what the dock leaves: one image pixel is 1.77 on the screen.
        script.write_text(f"timeout 300\nopen {IDOL}\nset size 256x256\nset spp 8\nwait idle\n"
                          "hands off\n" + "wait seconds 0.2\nreport now.json\n" * 3000)
        self.open_window("--window", "1280x720", "--script", script)
        self.wait_for_title("idol.glb - Midway")
        self.until(lambda seen: seen is None, "the first report")

        self.hand("mousemove", 598, 300)
        self.press("i")
        self.until(lambda seen: seen is not None, "the inspector is open")
        self.hand("mousemove", 598, 338, "click", 1)
        caustic = self.until(lambda seen: seen and "pixel" in seen, "a pixel was inspected")
        self.look("inspector-1-caustic")
        self.assertTrue(95 < caustic["pixel"][0] < 115 and 180 < caustic["pixel"][1] < 202,
                        caustic["pixel"])
        self.assertEqual(caustic["pixel"] + [0], caustic["sample"])
        self.assertEqual("surface", caustic["camera"][1]["kind"])
        self.assert_weights(caustic)
        self.assert_gave(caustic)

        # The button for the brightest sample of this pixel: in a caustic light tracing gives most,
        # and its sample is another pixel's.
        self.hand("mousemove", 500, 472, "click", 1)
        brightest = self.until(
            lambda seen: seen and "gave" in seen and not seen["searching"] and
            luminance(seen["gave"]) > luminance(caustic["gave"]), "a brighter sample was found")
        self.look("inspector-2-brightest")
        self.assertEqual(caustic["pixel"], brightest["pixel"])
        self.assertIn("light tracing", brightest["paths"][0]["strategy"])
        self.assertNotEqual(brightest["pixel"], brightest["sample"][:2])
        self.assertIn("idol", [v["object"] for v in brightest["light"]])
        self.assert_weights(brightest)
        self.assert_gave(brightest)

        self.press("shift+i")
        firefly = self.until(
            lambda seen: seen and "gave" in seen and not seen["searching"] and
            luminance(seen["gave"]) > luminance(brightest["gave"]), "the firefly was found")
        self.look("inspector-3-firefly")
        self.assertNotEqual(caustic["pixel"], firefly["pixel"])
        self.assert_weights(firefly)
        self.assert_gave(firefly)

        self.drag(640, 300, -80, 24)
        moved = self.until(lambda seen: seen and seen["camera_moved"], "the camera turned")
        self.look("inspector-4-moved")
        self.assertEqual(firefly["camera"], moved["camera"])
        self.assertEqual(firefly["gave"], moved["gave"])

        self.press("i")
        self.until(lambda seen: seen is None, "the inspector is closed")
        self.press("ctrl+q")
        self.assertIsNotNone(wait_for(lambda: self.process.poll() is not None))
        self.assertEqual(0, self.process.returncode, self.process.stderr.read())

