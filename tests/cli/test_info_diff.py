"""`midway info` and `midway diff`: JSON for programs, text for people, and the published formulas."""

import json
import math

from exr_file import ExrFile
from harness import CliTest

DIFF_KEYS = {"mse", "rmse", "relmse", "relmse_trimmed", "smape", "flip", "mean_ratio",
             "bias", "bias_z"}


class Info(CliTest):
    def test_speaks_json(self):
        told = json.loads(self.run_midway("info", self.scene, "--json").stdout)
        self.assertIsInstance(told, dict)
        self.assertTrue(told)

    def test_tells_people_what_is_in_the_scene(self):
        text = self.run_midway("info", self.scene).stdout
        for word in ["eye", "point"]:
            self.assertIn(word, text)
        self.assertIn("left out: textures: no material has one", text)
        self.assertIn("used: connect:", text)

    def test_measures_what_each_leave_out_saves(self):
        text, told = (self.run_midway("info", self.scene, "--cost", "--rounds", 2, *more).stdout
                      for more in ((), ("--json",)))
        told = json.loads(told)
        self.assertIn("families", told["plan"])
        rows = {row["what"]: row for row in told["measured"]["rows"]}
        for what in ("textures", "strategy images"):
            self.assertRegex(text, rf"{what} +[0-9.]+ +[0-9.]+ .*same bits")
            self.assertTrue(rows[what]["same_bits"], what)
            self.assertGreater(rows[what]["seconds_done"]["median"], 0)
            self.assertIn(what, {line["what"] for line in told["left_out"]} | {"strategy images"})
        for what in ("transparency", "normal maps"):
            self.assertLess(abs(rows[what]["mean_ratio"] - 1), 0.05, what)

    def test_rounds_are_those_of_the_measurement(self):
        self.refused("info", self.scene, "--rounds", 3, status=2)


class Bench(CliTest):
    def test_speaks_json_and_text(self):
        options = ("--size", "24x24", "--rounds", 1, "--threads", 2)
        told = json.loads(self.run_midway("bench", self.scene, *options, "--json").stdout)
        for key in ("limit_ratio", "samples_per_second", "rays_per_second", "sharing", "scaling"):
            self.assertIn(key, told)
        self.assertAlmostEqual(1, sum(told["shares"].values()), places=6)
        self.assertEqual([1, 2], [s["threads"] for s in told["scaling"]])
        text = self.run_midway("bench", self.scene, "--technique", "path", *options).stdout
        self.assertIn("the same rays alone", text)

    def test_refuses_wrong_usage(self):
        self.refused("bench", self.scene, "--rounds", 0, status=2)
        self.refused("bench", self.out / "nowhere.glb", status=1)


class Diff(CliTest):
    def setUp(self):
        super().setUp()
        # More than 1000 pixels: the trimmed error leaves one out.
        self.a = self.render_exr("a", "--spp", 2, size="48x32")
        self.b = self.render_exr("b", "--spp", 3, seed=6, size="48x32")

    def diff(self, *arguments, **options):
        return json.loads(self.run_midway("diff", *arguments, "--json", **options).stdout)

    def test_finds_no_difference_of_an_image_from_itself(self):
        told = self.diff(self.a, self.a)
        self.assertEqual(DIFF_KEYS, DIFF_KEYS & told.keys())
        for key in DIFF_KEYS - {"mean_ratio", "bias_z"}:
            self.assertEqual(0, told[key], key)
        self.assertEqual(1, told["mean_ratio"])
        self.assertIsNone(told["bias_z"])  # neither tells its own error

    def test_films_tell_their_own_errors(self):
        films = []
        for name, spp, lamps in (("c", 64, 1), ("d", 32, 1), ("e", 64, 1.3)):
            films.append(self.out / f"{name}.film")
            self.render("-o", films[-1], "--spp", spp, "--seed", spp, "--lamp-strength", lamps)
        told = self.diff(films[1], films[0])
        self.assertAlmostEqual(told["mean_ratio"] - 1, told["bias"])
        self.assertLess(abs(told["bias_z"]), 4.4)  # false alarm 1e-5
        self.assertNotEqual(0, told["bias_z"])
        # A third more light is far outside.
        self.assertGreater(self.diff(films[2], films[0])["bias_z"], 6)
        self.assertIsNone(self.diff(films[1], films[0], "--mask", self.a_mask(films[0]))["bias_z"])

    def a_mask(self, film):
        path = self.out / "mask.exr"
        self.run_midway("merge", film, "-o", path)
        return path

    def test_computes_the_published_formulas(self):
        told = self.diff(self.a, self.b)
        planes = [ExrFile(path).pixels() for path in (self.a, self.b)]
        x, r = ([value for channel in "RGB" for row in plane[channel] for value in row]
                for plane in planes)
        n = len(x)
        luminance = 3 / n * sum(weight * value for weight, channel in
                                zip((0.2126, 0.7152, 0.0722), "RGB")
                                for row in planes[1][channel] for value in row)
        square = [(p - q) ** 2 for p, q in zip(x, r)]
        mse = sum(square) / n
        relative = [e / (q * q + 0.01 * luminance ** 2) for e, q in zip(square, r)]
        smape = sum(abs(p - q) / (abs(p) + abs(q)) for p, q in zip(x, r) if p or q) / n
        other = 3 / n * sum(weight * value for weight, channel in
                            zip((0.2126, 0.7152, 0.0722), "RGB")
                            for row in planes[0][channel] for value in row)
        # Planes follow each other: a pixel's channels lie a third of the list apart.
        pixels = sorted(sum(relative[i::n // 3]) / 3 for i in range(n // 3))
        kept = pixels[:len(pixels) - len(pixels) // 1000]
        expected = {"mse": mse, "rmse": math.sqrt(mse), "relmse": sum(relative) / n,
                    "smape": smape, "mean_ratio": other / luminance,
                    "relmse_trimmed": sum(kept) / len(kept)}
        for key, value in expected.items():
            self.assertAlmostEqual(1, told[key] / value, places=6, msg=key)

    def test_has_a_bar(self):
        relmse = self.diff(self.a, self.b)["relmse"]
        self.assertGreater(relmse, 0)
        self.run_midway("diff", self.a, self.b, "--max-relmse", relmse * 1.01)
        self.run_midway("diff", self.a, self.b, "--max-relmse", relmse * 0.99, status=1)

    def test_prints_text_without_json(self):
        self.assertIn("relmse", self.run_midway("diff", self.a, self.b).stdout.lower())

    def test_refuses_what_cannot_be_compared(self):
        small = self.render_exr("small", "--spp", 1, size="8x8")
        self.refused("diff", self.a, small, status=1)
        self.refused("diff", self.a, self.out / "nowhere.exr", status=1)
        broken = self.out / "broken.exr"
        broken.write_bytes(self.a.read_bytes()[:100])
        self.refused("diff", self.a, broken, status=1)
        self.refused("diff", self.a, status=2)
