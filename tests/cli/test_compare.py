"""`midway compare`, and errors while rendering: files, columns, continuing, refusals."""

import csv
import json
import os
from pathlib import Path

import harness
from harness import CliTest
from support import browser

COLUMNS = ["technique", "exponent", "seed", "seconds", "cpu_seconds", "spp", "mse", "rmse", "relmse",
           "relmse_trimmed", "smape", "bias", "bias_z"]


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        return reader.fieldnames, list(reader)


def same_curve(points, others):
    """Within the digits that a page keeps."""
    return len(points) == len(others) and all(
        abs(a - b) <= 1e-4 * abs(a) for p, q in zip(points, others) for a, b in zip(p, q))


class Compare(CliTest):
    def compare(self, *arguments, size="24x16", **options):
        return self.run_midway("compare", self.scene, "-o", self.out, "--size", size, *arguments,
                               **options)

    def short(self, *arguments, **options):
        return self.compare("--time", 0.2, "--seeds", 2, "--techniques", "path,bdpt:1",
                            "--reference-time", 1, *arguments, **options)

    def summary(self, folder=None):
        return json.loads(((folder or self.out) / "summary.json").read_text())

    def test_leaves_report_table_summary_and_images(self):
        done = self.short()
        self.assert_files("convergence.csv", "films", "images", "references", "report.html",
                          "summary.json")
        self.assertEqual({"reference.exr", "path.exr", "bdpt-1.exr"},
                         {path.name for path in (self.out / "images").iterdir()})
        self.assertIn("report.html", done.stdout)
        names, rows = rows_of(self.out / "convergence.csv")
        self.assertEqual(COLUMNS, names)
        self.assertEqual({("path", "2", "0"), ("path", "2", "1"), ("bdpt", "1", "0"),
                          ("bdpt", "1", "1")},
                         {(r["technique"], r["exponent"], r["seed"]) for r in rows})
        for technique in ("path", "bdpt"):
            times = [float(r["seconds"]) for r in rows
                     if r["technique"] == technique and r["seed"] == "0"]
            self.assertEqual(sorted(times), times)
            self.assertGreaterEqual(times[-1], 0.2)
        told = self.summary()
        self.assertTrue(told["complete"])
        self.assertGreater(told["reference"]["floor_relmse"], 0)
        self.assertGreater(told["metric_seconds"], 0)
        self.assertIn("compare", told["command"])
        self.assertEqual(["path", "bdpt:1"], [t["label"] for t in told["techniques"]])
        self.assertNotIn("efficiency", told["techniques"][0])
        self.assertGreater(told["techniques"][1]["efficiency"]["value"], 0)
        html = (self.out / "report.html").read_text(encoding="utf-8")
        self.assertIn("bdpt:1", html)

    def test_what_was_measured_is_shown_by_a_browser(self):
        if not browser.installed():
            self.skipTest("no Chromium to open the report in (chromium)")
        self.short()
        page = self.out / "report.html"
        curves = ("Chart.getChart(document.querySelector('.plot canvas')).data.datasets.filter("
                  "d => d.label === '{}').map(d => d.data.map(p => [p.x, p.y]))")
        with browser.Browser() as chromium:
            chromium.open(page)
            for t in self.summary()["techniques"]:
                drawn = chromium.evaluate(curves.format(t["label"]))
                # A logarithmic axis has no place for an error that is below the reference's own.
                measured = [(p["seconds"], p["relmse"]["value"]) for p in t["band"]
                            if p["relmse"]["value"] > 0]
                self.assertTrue(any(same_curve(measured, curve) for curve in drawn), t["label"])
            self.assertEqual([], chromium.messages, "the console stays empty")
            self.assertEqual([page.resolve().as_uri()], chromium.requests)

    def test_goes_on_where_it_was(self):
        self.short()
        before = (self.out / "convergence.csv").read_bytes()
        films = {p.name: p.stat().st_mtime_ns for p in (self.out / "films").iterdir()}
        self.short()
        self.assertEqual(before, (self.out / "convergence.csv").read_bytes())
        self.assertEqual(films, {p.name: p.stat().st_mtime_ns
                                 for p in (self.out / "films").iterdir()})
        # More seeds: those that are there stay as they are.
        old = list(csv.DictReader(before.decode().splitlines()))
        self.compare("--time", 0.2, "--seeds", 3, "--techniques", "path,bdpt:1",
                     "--reference-time", 1)
        _, rows = rows_of(self.out / "convergence.csv")
        self.assertEqual(old, [r for r in rows if r["seed"] != "2"])
        # More time: the curves go on from their last points.
        self.compare("--time", 0.4, "--seeds", 2, "--techniques", "path,bdpt:1",
                     "--reference-time", 1)
        _, rows = rows_of(self.out / "convergence.csv")
        first = [r for r in old if r["technique"] == "path" and r["seed"] == "0"]
        self.assertEqual(first, rows[:len(first)])
        self.assertGreater(len(rows), len(old))

    def test_a_kept_reference_of_another_render_is_rendered_again(self):
        self.short()
        first, second = sorted((self.out / "references").glob("*.film"))[:2]
        kept = second.read_bytes()
        first.write_bytes(kept)  # of another seed
        self.short()
        self.assertNotEqual(kept, first.read_bytes())

    def test_damaged_films_are_made_anew(self):
        self.short()
        film = self.out / "films" / "path-seed1.film"
        whole = film.read_bytes()
        # Cut, or of other samples than the points beside it.
        for broken in (whole[:-100], (self.out / "films" / "path-seed0.film").read_bytes()):
            film.write_bytes(broken)
            self.assertIn("anew", self.short().stderr)
            self.assertNotEqual(broken, film.read_bytes())
            self.assertTrue(self.summary()["complete"])
        self.assertNotIn("anew", self.short().stderr)
        # The very render, but of fewer passes than the points were measured at.
        older = film.read_bytes()
        longer = ("--time", 0.4, "--seeds", 2, "--techniques", "path,bdpt:1", "--reference-time", 1)
        self.compare(*longer)
        film.write_bytes(older)
        self.assertIn("anew", self.compare(*longer).stderr)
        reference = next((self.out / "references").glob("*.film"))
        reference.write_bytes(b"no film")
        self.short()
        self.assertGreater(len(reference.read_bytes()), 1000)

    def test_names_may_be_any_bytes(self):
        odd = self.folder / os.fsdecode(b"r\xe9sultats")
        odd.mkdir()
        scene = odd / os.fsdecode(b"sc\xe8ne.gltf")
        scene.write_bytes(Path(self.scene).read_bytes())
        self.run_midway("compare", scene, "-o", odd, "--size", "8x8", "--time", 0.1, "--seeds", 1,
                        "--techniques", "path")
        self.assertTrue((odd / "report.html").is_file())
        self.assertTrue(self.summary(odd)["complete"])
        self.run_midway("render", scene, "--size", "8x8", "--spp", 1, "-o", odd / "a.exr",
                        "--stats", odd / "a.json")

    def test_another_setting_starts_anew_and_says_so(self):
        self.short()
        told = self.short("--max-bounces", 2).stderr
        self.assertIn("anew", told)

    def test_ends_at_ctrl_c_with_a_report(self):
        reference = self.folder / "r.film"
        self.render("-o", reference, "--spp", 64, "--seed", 99, size="24x16")
        process = self.start("compare", self.scene, "-o", self.out, "--size", "24x16", "--time", 60,
                             "--seeds", 2, "--techniques", "path,bdpt", "--reference", reference)
        self.wait_until_rendering(process)
        self.assertEqual(130, self.interrupt(process))
        told = self.summary()
        self.assertFalse(told["complete"])
        self.assertTrue(any("stopped early" in w for w in told["warnings"]))
        self.assertIn("stopped early", (self.out / "report.html").read_text(encoding="utf-8").lower())
        _, rows = rows_of(self.out / "convergence.csv")
        self.assertGreater(len(rows), 4)

    def test_takes_a_reference_and_finds_a_planted_bias(self):
        # Lamps a fifth stronger in the reference: every technique is too dark by that. With so
        # little time z is some 20 standard errors on any machine; the statistical tests plant 1 %.
        self.render("-o", self.out / "r.film", "--spp", 4096, "--seed", 99, "--lamp-strength", 1.2,
                    size="24x16")
        told = self.compare("--time", 0.1, "--seeds", 6, "--techniques", "bdpt", "--reference",
                            self.out / "r.film", status=0)
        self.assertIn("BIASED", told.stdout)
        bias = self.summary()["techniques"][0]["bias"]
        self.assertTrue(bias["flagged"])
        self.assertAlmostEqual(1 / 1.2 - 1, bias["relative"]["value"], delta=0.02)

    def test_one_percent_is_flagged_on_cornell_within_a_minute(self):
        # Two techniques, three seeds, two seconds each (more for a slow build): then the mean of one of them is made 1 %
        # too bright where the run keeps it, and the same command goes on from there. False alarm of
        # the first half: 1e-3 by the limit's own making, and less on a quiet machine than on none:
        # the more samples, the better the test's normality holds.
        scene = harness.SOURCE / "assets" / "cornell.glb"
        command = ("compare", scene, "-o", self.out, "--size", "64x64", "--time",
                   2 * harness.slow, "--seeds", 3, "--techniques", "path,bdpt",
                   "--reference-time", 8 * harness.slow)
        self.run_midway(*command)
        sound = {t["label"]: t["bias"] for t in self.summary()["techniques"]}
        for kept in (self.out / "films").glob("bdpt-2-seed*.json"):
            curve = json.loads(kept.read_text())
            for half in ("luminance_a", "luminance_b"):
                curve[half] *= 1.01
            kept.write_text(json.dumps(curve))
        done = self.run_midway(*command)
        planted = {t["label"]: t["bias"] for t in self.summary()["techniques"]}
        self.assertIn("BIASED", done.stdout)
        self.assertTrue(planted["bdpt:2"]["flagged"])
        self.assertAlmostEqual(0.01, planted["bdpt:2"]["relative"]["value"]
                               - sound["bdpt:2"]["relative"]["value"], delta=1e-4)
        self.assertIn("bdpt:2 is biased, or the reference",
                      (self.out / "report.html").read_text(encoding="utf-8"))
        for verdict in (sound["path"], sound["bdpt:2"], planted["path"]):
            self.assertFalse(verdict["flagged"], verdict)

    def test_a_gap_that_the_reference_has_too_excuses_no_bias(self):
        # Nothing finds all of five-lights; bdpt renders the reference, path lacks more than it.
        self.run_midway("compare", harness.SOURCE / "assets" / "five-lights.glb", "-o", self.out,
                        "--sky", "0.1,0.16,0.28", "--size", "16x16", "--time", 0.2, "--seeds", 2,
                        "--techniques", "path,bdpt:1,bdpt:2")
        told = self.summary()
        self.assertIn(told["reference"]["technique"], ("bdpt:1", "bdpt:2"))
        self.assertEqual([True, False, False],
                         [t["bias"]["expected"] for t in told["techniques"]])
        for technique in told["techniques"]:
            self.assertTrue(technique["not_covered"])

    def test_refuses_what_makes_no_sense(self):
        for arguments in (["--time", 1, "--techniques", "path,path"], ["--techniques", "path"],
                          ["--time", 1, "--techniques", "photons"], ["--time", 1, "--seeds", 0],
                          ["--time", -1], ["--time", 1, "--suite", self.scene],
                          ["--time", 1, "--techniques", ""],
                          ["--time", 1, "--reference", "a.exr", "--reference-time", 2]):
            self.refused("compare", self.scene, "-o", self.out, *arguments, status=2)
        self.refused("compare", "-o", self.out, "--time", 1, status=2)
        small = self.render_exr("small", "--spp", 1, size="8x8")
        self.refused("compare", self.scene, "-o", self.out, "--time", 1, "--size", "9x9",
                     "--reference", small, status=1)


class Suite(CliTest):
    def write(self, **changes):
        suite = {"size": "16x12", "time": 0.1, "seeds": 2, "techniques": ["path", "bdpt"],
                 "reference-time": 0.5,
                 "scenes": [{"name": "one", "scene": "tiny.gltf"},
                            {"name": "two", "scene": "tiny.gltf", "sky": "0.2,0.3,0.4"}]}
        suite.update(changes)
        path = self.folder / "suite.json"
        path.write_text(json.dumps(suite))
        return path

    def test_makes_a_report_of_every_scene_and_one_page(self):
        self.run_midway("compare", "--suite", self.write(), "-o", self.out)
        self.assert_files("index.html", "one", "references", "summary.json", "table.md", "two")
        for name in ("one", "two"):
            self.assertTrue((self.out / name / "report.html").is_file())
        told = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(["one", "two"], [scene["name"] for scene in told["scenes"]])
        self.assertEqual("--sky 0.2,0.3,0.4", told["scenes"][1]["settings"]["scene options"])
        table = (self.out / "table.md").read_text()
        self.assertIn("| one |", table)
        self.assertIn("`bdpt:2`", table)
        # What is typed comes before what the file says.
        self.run_midway("compare", "--suite", self.write(), "-o", self.out, "--techniques", "path")
        self.assertNotIn("`bdpt:2`", (self.out / "table.md").read_text())

    def test_a_stop_before_the_first_curve_leaves_the_page_as_it_was(self):
        command = ("compare", "--suite", self.write(), "-o", self.out)
        self.run_midway(*command)
        written = [self.out / name for name in ("index.html", "summary.json", "table.md")]
        before = [file.read_bytes() for file in written]
        process = self.start(*command, "--reference-time", 60)
        self.wait_until_rendering(process)
        self.assertEqual(130, self.interrupt(process))
        self.assertEqual(before, [file.read_bytes() for file in written])

    def test_refuses_broken_suites(self):
        scene = {"name": "one", "scene": "tiny.gltf"}
        for scenes in ([], [scene, scene], [{**scene, "name": "../x"}], [{**scene, "name": ""}],
                       [{**scene, "scene": "none.glb"}], [{**scene, "colour": 1}], [{"name": "a"}],
                       [{**scene, "name": "index.html"}], [{**scene, "scene": 7}]):
            self.refused("compare", "--suite", self.write(scenes=scenes), "-o", self.out, status=1)
        for change in ({"time": -1}, {"seeds": "many"}, {"paint": 1},
                       {"reference-time": -1}):
            self.refused("compare", "--suite", self.write(**change), "-o", self.out, status=1)
        self.refused("compare", "--suite", self.write(techniques=[]), "-o", self.out, status=2)
        sessions = [{**scene, "scene": "tiny.midway"}]
        (self.folder / "tiny.midway").write_text("{}")
        self.refused("compare", "--suite", self.write(scenes=sessions), "-o", self.out, status=1)
        # Options of a scene belong to the file; a file is no folder.
        for option in (["--sky", "1,1,1"], ["--lamp-strength", 2], ["--camera", 0]):
            self.refused("compare", "--suite", self.write(), "-o", self.out, *option, status=2)
        self.refused("compare", "--suite", self.write(), "-o", self.folder / "tiny.midway", status=1)
        self.refused("compare", "--suite", self.folder / "none.json", "-o", self.out, status=1)


class ErrorLog(CliTest):
    def setUp(self):
        super().setUp()
        self.reference = self.out / "r.film"
        self.render("-o", self.reference, "--spp", 400, "--seed", 9)

    def test_writes_the_errors_of_every_exponent_while_rendering(self):
        log = self.out / "log.csv"
        image = self.render_exr("a", "--spp", 11, "--exponent", "1,2", "--reference",
                                self.reference, "--error-log", log)
        names, rows = rows_of(log)
        self.assertEqual(COLUMNS, names)
        self.assertEqual([str(n) for n in (1, 2, 3, 4, 5, 6, 7, 8, 10, 11) for _ in (1, 2)],
                         [r["spp"] for r in rows])
        self.assertEqual({"1", "2"}, {r["exponent"] for r in rows})
        self.assertFalse(image.exists())  # one image for each exponent
        self.render("-o", self.out / "r.exr", "--spp", 400, "--seed", 9)
        told = json.loads(self.run_midway("diff", self.out / "a.b2.exr", self.out / "r.exr",
                                          "--json").stdout)
        last = rows[-1]
        self.assertAlmostEqual(told["mean_ratio"] - 1, float(last["bias"]), places=9)
        self.assertAlmostEqual(told["smape"], float(last["smape"]), places=9)
        # The reference's own variance is subtracted.
        self.assertLess(float(last["relmse"]), told["relmse"])
        self.assertGreater(float(last["relmse"]), 0.8 * told["relmse"])

    def test_what_auto_decides_with_is_time_too(self):
        log = self.out / "log.csv"
        told = self.stats("--spp", 1, "--technique", "auto", "--reference", self.reference,
                          "--error-log", log)
        _, rows = rows_of(log)
        decision = told["plan"]["seconds"]
        self.assertGreater(decision, 0)
        self.assertGreater(float(rows[0]["seconds"]), decision)
        self.assertGreater(float(rows[0]["cpu_seconds"]), 0.3 * decision)

    def test_stops_at_an_error_and_always_at_the_same_sample(self):
        spp = {self.stats("--target-error", 0.05, "--threads", threads, "--seed", 3)["spp"]
               for threads in (1, 2, 3)}
        self.assertEqual(1, len(spp))
        self.assertGreater(spp.pop(), 4)
        against = [self.stats("--target-error", target, "--reference", self.reference)["spp"]
                   for target in (0.1, 0.01)]
        self.assertLess(against[0], against[1])
        error = json.loads(self.run_midway("diff", self.out / "stats.exr", self.image_of_reference(),
                                           "--json").stdout)["relmse"]
        self.assertLess(error, 0.013)
        self.assertEqual(6, self.stats("--target-error", 1e-9, "--spp", 6)["spp"])

    def image_of_reference(self):
        path = self.out / "reference.exr"
        self.run_midway("merge", self.reference, "-o", path)
        return path

    def test_refuses_logs_without_a_reference(self):
        image = self.out / "x.exr"
        for arguments in (["--error-log", "e.csv"], ["--reference", self.reference],
                          ["--target-error", 0]):
            self.refused("render", self.scene, "-o", image, *arguments, status=2)
        self.refused("render", self.scene, "-o", image, "--size", "9x9", "--reference",
                     self.reference, "--target-error", 0.1, status=1)
