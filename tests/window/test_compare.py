"""A against B, references and the curves of the error: offscreen by scripts, and by hand."""

import subprocess
import time
import unittest
from pathlib import Path

import window_test
from window_test import TOOLS, HandsTest, WindowTest, part, read_png, wait_for

ASSETS = Path(__file__).resolve().parents[2] / "assets"


class Compare(WindowTest):
    def prepared(self, more, **options):
        """tiny.gltf by path tracing kept as A, then bidirectionally; the image's pixels are the
        window's, its middle at 200, 150."""
        return self.play(f"open {self.scene}\nset size 64x48\nset spp 4\nset technique path\n"
                         "wait idle\nkeep\nset technique bdpt\nwait idle\nset panels off\n"
                         f"set zoom 1\n{more}", **options)

    def test_saved_png_of_a_comparison_is_what_is_seen(self):
        """Shader and PNG writer differ by less than one of 255 steps; the wipe cuts at one pixel."""
        looks = {"a": "set compare a", "b": "set compare b",
                 "wipe": "set compare wipe\nset wipe 0.4",
                 "agx": "set exposure 1\nset curve agx\nset wipe 0.71",
                 "stops": "set false-colour on",
                 "difference": "set compare difference\nset difference absolute:0.02",
                 "relative": "set difference relative:0.3",
                 "dark": "set exposure -3"}
        script = ""
        for name, look in looks.items():
            script += f"{look}\nwait frames 4\nscreenshot seen-{name}.png\n" \
                      f"save saved-{name}.png\nwait saved\n"
        self.prepared(script)
        saved = {name: part(read_png(self.folder / f"saved-{name}.png"), 0, 0, 64, 48)
                 for name in looks}
        for name in looks:
            with self.subTest(name):
                seen = read_png(self.folder / f"seen-{name}.png")
                # Captions and the handle of the wipe stand over the upper rows, its line over a
                # few columns.
                line = {"wipe": 26, "agx": 45, "stops": 45}.get(name)
                kept = [(x, y) for y in range(39, 48) for x in range(64)
                        if line is None or abs(x - line) > 3]
                rows = seen[2]
                worst_of = max(abs(rows[126 + y][3 * (168 + x) + c] - saved[name][64 * y + x][c])
                               for x, y in kept for c in range(3))
                self.assertLessEqual(worst_of, 1)
        self.assertEqual(len(looks) - 1, len({tuple(s) for n, s in saved.items() if n != "dark"}))
        self.assertEqual(saved["relative"], saved["dark"], "a share does not depend on exposure")
        for y in range(48):
            row = [64 * y + x for x in range(64)]
            cut = [saved["a" if x < 26 else "b"][i] for x, i in enumerate(row)]
            self.assertEqual(cut, [saved["wipe"][i] for i in row], f"row {y}")

    def test_crops_lie_over_a(self):
        """B is black where the crop ends; what is subtracted lies over each other."""
        self.prepared("set compare difference\nset difference absolute:0.02\nset crop 9,7,41,37\n"
                      "wait idle\nreport crop.json\nwait frames 4\nscreenshot seen.png\n"
                      "save difference.png\nwait saved\nset compare wipe\nset wipe 0.5\nwait frames 3\n"
                      "save wipe.png\nwait saved\nset compare a\nwait frames 3\nsave a.png\n"
                      "wait saved")
        self.assertEqual("difference", self.report("crop.json")["compare"]["shown"])
        # The rows that no caption covers.
        seen, difference = read_png(self.folder / "seen.png"), read_png(self.folder / "difference.png")
        for y in (7, 10, 36):
            there = part(difference, 9, y, 41, y + 1)
            self.assertGreater(len(set(there)), 16)
            worst = max(abs(a - b) for p, q in zip(there, part(seen, 177, 126 + y, 209, 127 + y))
                        for a, b in zip(p, q))
            self.assertLessEqual(worst, 1, f"row {y}")
        self.assertEqual("another region is rendered", self.report("crop.json")["compare"]["remark"])
        wipe, a = read_png(self.folder / "wipe.png"), read_png(self.folder / "a.png")
        self.assertEqual((64, 48), wipe[:2])
        self.assertEqual(part(a, 0, 0, 32, 48), part(wipe, 0, 0, 32, 48))
        self.assertEqual({(0, 0, 0)}, set(part(wipe, 42, 0, 64, 48)))
        self.assertGreater(len(set(part(wipe, 32, 8, 41, 36))), 50)

    def test_another_view_is_refused_and_said(self):
        self.prepared("set compare wipe\nwait frames 3\nreport same.json\ncamera orbit 20\nwait idle\n"
                      "report moved.json\nset compare a\nwait frames 3\nreport a.json\n"
                      "set compare difference\nset size 32x24\nwait idle\nreport size.json\n"
                      "keep\nset compare difference\nset lamp-strength 2\nwait idle\n"
                      "report edited.json")
        self.assertEqual("wipe", self.report("same.json")["compare"]["shown"])
        for name, shown, why in (("moved", "b", "the camera moved"), ("a", "a", "the camera moved"),
                                 ("size", "b", "the image's size changed from 64 x 48"),
                                 ("edited", "difference", "")):
            compare = self.report(f"{name}.json")["compare"]
            self.assertEqual((shown, why), (compare["shown"], compare["refusal"]), name)
        self.assertEqual("the scene was edited", self.report("edited.json")["compare"]["remark"])

    def test_nothing_of_it_restarts_a_render(self):
        self.prepared("report before.json\nkeep second\nset compare-with 1\nset compare wipe\n"
                      "wait frames 2\nset wipe 0.2\nset compare difference\nset difference relative\n"
                      "wait frames 2\nkey y\nkey y\nkey h\nset compare-with second\nsave ref.exr\n"
                      "wait saved\nreference ref.exr\nwait measured\nset compare-with reference\n"
                      "set compare wipe\nset plot on\nwait frames 3\nsave-plot p.csv\n"
                      "save-plot p.png\nwait saved\nreference none\nreport after.json")
        before, after = self.report("before.json"), self.report("after.json")
        self.assertEqual(before["job"], after["job"])
        self.assertEqual("", after["error"])
        self.assertEqual(2, len(after["compare"]["kept"]))
        self.assertEqual(2 * 64 * 48 * 12, after["compare"]["bytes"])
        self.assertEqual((960, 600), read_png(self.folder / "p.png")[:2])

    def test_kept_images_are_bounded(self):
        self.prepared("\n".join(f"keep k{i}\nwait frames 2" for i in range(8)) +
                      "\nreport report.json")
        report = self.report()
        self.assertEqual(8, len(report["compare"]["kept"]))
        self.assertRegex(report["error"], r"^8 images are kept already \(.+\); delete")

    def test_image_kept_too_early_comes_with_its_first_pass(self):
        self.play(f"open {self.scene}\nset size 64x48\nset spp 2\nwait loaded\n"
                  "set technique path\nkeep early\nwait idle\nreport report.json")
        self.assertEqual(["early"], self.report()["compare"]["kept"])


class ErrorOverTime(WindowTest):
    def test_curves_are_those_of_the_error_log(self):
        """Every point has the very numbers that midway render --error-log gives the same samples."""
        self.play(f"open {self.scene}\nset size 32x24\nset seed 9\nset spp 64\nwait idle\n"
                  "save ref.exr\nwait saved\nreference ref.exr\nwait measured\nset spp 8\n"
                  "set seed 0\nset technique path\nwait idle\nwait measured\nset technique bdpt\n"
                  "set same-paths on\nwait idle\nwait measured\nsave-plot curves.csv\nwait saved\n"
                  "report report.json")
        names = "relmse relmse_trimmed mse smape bias".split()
        rows = [dict(zip((self.folder / "curves.csv").read_text().splitlines()[0].split(","),
                         line.split(",")))
                for line in (self.folder / "curves.csv").read_text().splitlines()[1:]]
        rows = [r for r in rows if r["seed"] == "0"]
        self.assertEqual({"path": {"2"}, "bdpt": {"0", "1", "2", "4"}},
                         {t: {r["exponent"] for r in rows if r["technique"] == t}
                          for t in ("path", "bdpt")})
        for technique, exponents in (("path", "2"), ("bdpt", "0,1,2,4")):
            done = subprocess.run(
                [str(window_test.midway), "render", str(self.scene), "-o", "x.exr", "--size",
                 "32x24", "--spp", "8", "--technique", technique, "--exponent", exponents,
                 "--reference", "ref.exr", "--error-log", "log.csv", "--quiet"],
                cwd=self.folder, capture_output=True, text=True, check=False)
            self.assertEqual(0, done.returncode, done.stderr)
            log = (self.folder / "log.csv").read_text().splitlines()
            log = [dict(zip(log[0].split(","), line.split(","))) for line in log[1:]]
            log = {(r["exponent"], r["spp"]): r for r in log}
            mine = [r for r in rows if r["technique"] == technique]
            self.assertTrue(any(r["spp"] == "8" for r in mine))
            for row in mine:
                for name in names:
                    self.assertEqual(log[row["exponent"], row["spp"]][name], row[name], name)

    def test_curves_stay_with_the_image_and_go_with_another(self):
        self.play(f"open {self.scene}\nset size 32x24\nset spp 8\nset technique path\nwait idle\n"
                  "wait measured\nset technique light\nwait idle\nwait measured\n"
                  "set technique bdpt\nset sampler independent\nwait idle\nwait measured\n"
                  "report three.json\nset max-bounces 3\nwait idle\nwait measured\n"
                  "report bounces.json\ncamera orbit 9\nwait idle\nwait measured\nreport camera.json")
        labels = {name: [c["label"] for c in self.report(f"{name}.json")["curves"]]
                  for name in ("three", "bounces", "camera")}
        self.assertEqual(["path", "light", "bdpt:2, independent"], labels["three"])
        self.assertEqual(["bdpt:2, independent"], labels["bounces"])
        self.assertEqual(["bdpt:2, independent"], labels["camera"])
        for curve in self.report("three.json")["curves"]:
            self.assertEqual(8, curve["points"][-1]["spp"])
            self.assertGreater(curve["points"][-1]["estimate"], 0)

    def test_wrong_references_are_one_line(self):
        (self.folder / "broken.exr").write_bytes(b"v/1\x01" + bytes(40))
        self.play(f"open {self.scene}\nset size 32x24\nset spp 2\nwait idle\nsave other.exr\n"
                  "wait saved\nset size 24x32\nwait idle\nreference other.exr\nwait measured\n"
                  "report size.json\nreference nowhere.exr\nwait saved\nwait frames 3\n"
                  "report missing.json\nreference broken.exr\nwait saved\nwait frames 3\n"
                  "report broken.json\nset size 32x24\nwait idle\nwait measured\nreport again.json")
        self.assertRegex(self.report("size.json")["error"],
                         r"^reference is of another size: 32x24 \(.*other.exr\); the image is 24x32")
        self.assertRegex(self.report("missing.json")["error"], r"^\S.* \(.*nowhere.exr.*\); \S")
        self.assertRegex(self.report("broken.json")["error"], r"^\S.* \(.*broken.exr.*\); \S")
        again = self.report("again.json")
        self.assertEqual("", again["compare"]["reference"]["refusal"])
        self.assertIn("relmse", again["curves"][0]["points"][-1])


@unittest.skipIf(TOOLS, f"{' and '.join(TOOLS)} missing (app/packages.txt lists them)")
class CompareByHand(HandsTest):
    """As a person would, with real events; a script only waits for the word and reports."""

    def open_idol(self):
        self.open_in_steps([f"open {ASSETS / 'idol.glb'}", "set size 142x138", "set spp 4"],
                           "idol.glb - Midway", ["wait measured"])

    def test_path_against_bdpt_on_the_idol(self):
        self.open_idol()
        self.assertEqual(["auto"], [c["label"] for c in self.state()["curves"]])
        self.hand("mousemove", 640, 300)
        self.press("1")
        self.assertEqual(["path"], [c["label"] for c in self.state()["curves"]][-1:])
        self.press("shift+y")
        kept = self.state()["compare"]["kept"]
        self.assertRegex(kept[0], r"^path, 4 samples, ")
        self.press("3")
        self.press("h")
        first = self.state()
        self.assertEqual(("wipe", 0.5), (first["compare"]["shown"], first["compare"]["wipe"]))
        self.assertEqual(("A: path, 4 samples", "B: bdpt:2, 4 samples"),
                         (first["compare"]["a"], first["compare"]["b"]))
        self.look("compare-1-wipe")

        # The image covers the whole width of the view, 710 points. Every report waits for frames, so
        # that a busy machine sees each step of the hand.
        self.hand("mousemove", 640, 346)
        self.state()
        self.hand("mousedown", 1)
        self.state()
        for x in (600, 560, 498):
            self.hand("mousemove", x, 360)
        self.state()
        self.hand("mouseup", 1)
        dragged = self.state()
        self.assertAlmostEqual(0.3, dragged["compare"]["wipe"], delta=0.01)
        self.assertEqual(first["job"], dragged["job"], "the line of the wipe is not the camera")
        self.hand("mousemove", 700, 300)

        self.press("y")
        self.assertEqual("a", self.state()["compare"]["shown"])
        self.press("y")
        self.assertEqual("wipe", self.state()["compare"]["shown"])
        self.hand("keydown", "y")
        time.sleep(1)
        self.assertEqual("a", self.state()["compare"]["shown"])
        self.hand("keyup", "y")
        self.assertEqual("wipe", self.state()["compare"]["shown"])
        self.press("h")
        self.assertEqual("difference", self.state()["compare"]["shown"])
        self.look("compare-2-difference")

        self.press("ctrl+s")
        self.assertTrue(wait_for((self.folder / "idol.exr").exists))
        self.click_in(self.state(), "Error over time", 12)
        self.click_in(self.state(), "Error over time", 40)
        time.sleep(1)
        self.hand("type", "--delay", "20", "idol.exr")
        self.press("Return")
        self.assertTrue(wait_for(lambda: self.state()["compare"]["reference"]))
        self.hand("mousemove", 640, 300)
        self.press("2")
        state = self.state()
        self.assertEqual("", state["error"])
        self.assertEqual({"auto", "path", "bdpt:2", "light"}, {c["label"] for c in state["curves"]})
        self.assertEqual(0, next(c for c in state["curves"]
                                 if c["label"] == "bdpt:2")["points"][-1]["relmse"])
        self.assertGreater(next(c for c in state["curves"]
                                if c["label"] == "light")["points"][-1]["relmse"], 0)
        self.look("compare-3-plot")
