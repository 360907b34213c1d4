"""midway check: the audit of a scene and the suite's frame."""

import json

from harness import CliTest


class Check(CliTest):
    def check(self, *arguments, **options):
        return self.run_midway("check", self.scene, "--size", "32x24", "--paths", "2000", "--rays",
                               "2000", *arguments, **options)

    def test_a_sound_scene_passes_and_the_verdict_comes_first(self):
        out = self.check().stdout
        self.assertRegex(out.splitlines()[0], r"tiny\.gltf: all \d+ checks passed$")
        self.assertNotIn("FAILED", out)

    def test_json_holds_all_figures_for_any_number_of_threads(self):
        one = json.loads(self.check("--json", "--threads", "1").stdout)
        three = json.loads(self.check("--json", "--threads", "3").stdout)
        self.assertEqual(one, three)
        self.assertTrue(one["passed"])
        self.assertGreaterEqual(one["paths"], 2000)
        self.assertGreaterEqual(one["rays"]["rays"], 2000)
        self.assertEqual([0, 0.1, 0.5, 1, 2, 8, 32], [w["exponent"] for w in one["weights"]])
        for w in one["weights"]:
            self.assertLessEqual(w["recursive_against_direct"]["worst"], 1e-9)
        for check in one["checks"]:
            self.assertTrue(check["passed"], check)

    def test_what_is_not_finite_fails_with_the_command_that_replays_it(self):
        # The lamp's light is a finite number; divided by the densities it is none any more.
        done = self.check("--lamp-strength", "1e38", "--json", status=1)
        audit = json.loads(done.stdout)
        failed = [c for c in audit["checks"] if not c["passed"]]
        self.assertTrue(any("not finite" in c["name"] for c in failed), failed)
        replay = next(c for c in failed if "not finite" in c["name"])["replay"].split()
        self.assertEqual("midway", replay[0])
        # The audit draws with all families, whatever `auto` would choose.
        self.assertEqual("bdpt", replay[replay.index("--technique") + 1])
        self.assertRegex(self.run_midway(*replay[1:]).stdout, r"value .*\b(inf|nan)\b")

    def test_the_report_is_one_page(self):
        self.check("--report", self.out / "audit.html")
        self.assert_files("audit.html")
        page = (self.out / "audit.html").read_text()
        for text in ["Numerical audit", "Float beside double", "Weights"]:
            self.assertIn(text, page)

    def test_a_part_of_the_suite_runs_alone(self):
        done = self.run_midway("check", "--only", "film", "--json", "--report",
                               self.out / "suite.html", seconds=120)
        suite = json.loads(done.stdout)
        self.assertTrue(suite["passed"])
        self.assertEqual({"film"}, {c["group"] for c in suite["cases"]})
        self.assert_files("suite.html")

    def test_wrong_usage(self):
        self.assertIn("--only", self.refused("check", "--only", "nothing", status=2))
        self.refused("check", self.scene, "--only", "film", status=2)
        self.refused("check", self.scene, "--paths", "0", status=2)
        self.refused("check", self.scene, "--size", "0x8", status=2)
        self.refused("check", self.folder / "absent.gltf", status=1)
