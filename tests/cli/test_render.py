"""`midway render`: the files it writes, the same bits every time, statistics, interruption."""

import json
import re
import struct

import harness
import tiny_scene
from exr_file import ExrFile
from harness import CliTest

STATS_KEYS = """scene technique exponent size max_bounces seed threads spp seconds_load seconds_build
seconds_render cpu_seconds paths_camera paths_light rays_closest rays_shadow peak_memory_bytes
nonfinite nonfinite_first strategies left_out not_covered""".split()


class Files(CliTest):
    def test_every_kind_is_written_and_nothing_else(self):
        self.render("--spp", 2, "-o", self.out / "a.exr", "-o", self.out / "a.png",
                    "-o", self.out / "a.film")
        self.assert_files("a.exr", "a.film", "a.png")
        png = (self.out / "a.png").read_bytes()
        self.assertEqual(b"\x89PNG\r\n\x1a\n", png[:8])
        self.assertEqual((32, 24), struct.unpack(">2I", png[16:24]))
        exr = ExrFile(self.out / "a.exr")
        self.assertEqual((32, 24), (exr.width, exr.height))
        self.assertLessEqual({"R", "G", "B"}, {name for name, _ in exr.channels})
        pixels = exr.pixels()["R"]
        self.assertGreater(sum(map(sum, pixels)), 0, "the image is black")

    def test_the_exr_header_says_how_it_was_made(self):
        header = ExrFile(self.render_exr("a", "--spp", 3)).attributes
        told = " ".join([*header, *(raw.decode("latin-1") for raw in header.values())]).lower()
        for word in ["seed", "spp", "hash", "version"]:
            self.assertIn(word, told)

    def test_a_glb_gives_the_image_of_its_gltf(self):
        glb = tiny_scene.write_glb(self.folder / "tiny.glb")
        a = self.render_exr("a", "--spp", 2)
        b = self.out / "b.exr"
        self.run_midway("render", glb, "--size", "32x24", "--seed", 5, "--spp", 2, "-o", b)
        self.assertEqual(ExrFile(a).chunks, ExrFile(b).chunks)

    def test_names_with_spaces_and_umlauts_work(self):
        scene = tiny_scene.write_gltf(self.folder / "ein Zürich.gltf")
        self.run_midway("render", scene, "--size", "8x8", "--spp", 1, "-o", self.out / "ä b.png")
        self.assert_files("ä b.png")

    def test_an_old_image_is_replaced(self):
        image = self.out / "a.png"
        image.write_text("old")
        self.render("--spp", 1, "-o", image)
        self.assertTrue(image.read_bytes().startswith(b"\x89PNG"))

    def test_strategies_are_named_layers(self):
        layers = self.folder / "layers.exr"
        self.render("--spp", 2, "--technique", "bdpt", "-o", self.out / "a.exr",
                    "--strategies", layers)
        names = {name for name, _ in ExrFile(layers).channels}
        self.assertLessEqual({"s2t0.R", "s2t1.G", "s2t2.B", "s2t2.raw.R", "s1t2.raw.B"}, names)

    def test_weighted_layers_sum_to_the_image(self):
        image, layers = self.folder / "a.exr", self.folder / "layers.exr"
        # As many bounces as there are layers for.
        self.render("--spp", 4, "--technique", "bdpt", "--max-bounces", 6, "-o", image,
                    "--strategies", layers)
        whole, parts = ExrFile(image).pixels(), ExrFile(layers).pixels()
        weighted = [name for name in parts if name.count(".") == 1 and name.endswith(".G")]
        self.assertGreater(len(weighted), 15)
        lit = 0
        for y, row in enumerate(whole["G"]):
            for x, value in enumerate(row):
                self.assertAlmostEqual(value, sum(parts[name][y][x] for name in weighted),
                                       delta=1e-5 * value)
                lit += value > 0
        self.assertGreater(lit, 300)

    def test_says_what_a_technique_and_single_strategies_leave_out(self):
        scene = harness.SOURCE / "assets" / "idol.glb"
        done = self.run_midway("render", scene, "--size", "8x8", "--spp", 1, "--technique",
                               "light", "-o", self.out / "a.exr")
        self.assertIn("light does not cover: lamp or sky > smooth surface > camera", done.stderr)
        # Asked for by name, a strategy is there whatever `auto` would choose without it.
        image = self.out / "b.exr"
        done = self.render("--spp", 16, "--only", "1,3", "-o", image)
        self.assertNotIn("adds nothing", done.stderr)
        self.assertGreater(max(map(max, ExrFile(image).pixels()["G"])), 0)
        done = self.render("--spp", 1, "--only", "2,4", "--max-bounces", 2, "-o", image)
        self.assertIn("--only 2,4 adds nothing: paths end after 2 bounces", done.stderr)

    def test_aovs_are_named_layers(self):
        layers = self.folder / "layers.exr"
        self.render("--spp", 2, "-o", self.out / "a.exr", "--aov", layers)
        names = " ".join(name for name, _ in ExrFile(layers).channels).lower()
        for word in ["albedo", "normal", "depth", "object", "variance"]:
            self.assertIn(word, names)


class Output(CliTest):
    def test_progress_goes_to_stderr_and_quiet_is_quiet(self):
        self.assertEqual("", self.render("--spp", 2, "-o", self.out / "a.exr", "--quiet").stderr)
        self.assert_files("a.exr")
        done = self.render("--spp", 2, "-o", self.out / "a.exr")
        self.assertNotIn("\r", done.stderr, "a bar is for terminals only")
        self.assertNotIn("\x1b", done.stderr)

    def test_time_ends_a_render(self):
        stats = self.stats("--time", 1)
        self.assertGreaterEqual(stats["spp"], 1)
        self.assertLess(stats["seconds_render"], 10)


class SameBits(CliTest):
    def test_for_any_number_of_threads(self):
        for technique in ["path", "light", "bdpt"]:
            with self.subTest(technique=technique):
                images = [ExrFile(self.render_exr(f"{technique}{threads}", "--spp", 5,
                                                  "--technique", technique, "--threads", threads))
                          for threads in [1, 2, 7]]
                self.assertEqual(images[0].chunks, images[1].chunks)
                self.assertEqual(images[0].chunks, images[2].chunks)

    def test_of_the_film_too(self):
        films = []
        for threads in [1, 2, 7]:
            film = self.out / f"{threads}.film"
            self.render("--spp", 3, "--seed", 5, "--threads", threads, "-o", film)
            films.append(film.read_bytes())
        self.assertEqual(films[0], films[1])
        self.assertEqual(films[0], films[2])

    def test_twice_and_others_for_another_seed(self):
        first, again, other = (ExrFile(self.render_exr(name, "--spp", 2, seed=seed)).chunks
                               for name, seed in [("a", 1), ("b", 1), ("c", 2)])
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)


class Stats(CliTest):
    def test_have_every_key(self):
        stats = self.stats("--spp", 4, "--seed", 9, "--threads", 2, "--technique", "bdpt",
                           "--exponent", 1, "--max-bounces", 5)
        self.assertEqual([], [key for key in STATS_KEYS if key not in stats])
        told = {key: stats[key] for key in ["spp", "seed", "threads", "max_bounces", "nonfinite"]}
        self.assertEqual({"spp": 4, "seed": 9, "threads": 2, "max_bounces": 5, "nonfinite": 0}, told)
        self.assertEqual(1, stats["exponent"])
        self.assertIn("bdpt", stats["technique"])
        self.assertGreater(stats["peak_memory_bytes"], 1 << 20)
        self.assertGreaterEqual(stats["paths_camera"], 4 * 32 * 24)

    def test_count_every_strategy_once(self):
        stats = self.stats("--spp", 4, "--technique", "bdpt", "--max-bounces", 3)
        strategies = stats["strategies"]
        pairs = [(entry["s"], entry["t"]) for entry in strategies]
        self.assertEqual(len(pairs), len(set(pairs)))
        for s, t in pairs:
            self.assertTrue(s >= 1 and t >= 0 and (s, t) != (1, 1) and s + t <= 5, (s, t))
        self.assertLessEqual({(2, 0), (2, 1), (2, 2), (1, 2)}, set(pairs))
        for entry in strategies:
            for key in ["samples", "energy", "second_moment", "rays"]:
                self.assertGreaterEqual(entry[key], 0)

    def test_do_not_depend_on_the_threads(self):
        def countable(threads):
            stats = self.stats("--spp", 3, "--threads", threads)
            return {key: stats[key] for key in ["paths_camera", "paths_light", "rays_closest",
                                                "rays_shadow", "strategies"]}
        self.assertEqual(countable(1), countable(2))


class Choices(CliTest):
    """Options change what they should; how well is for the statistical tests."""

    def chunks(self, *arguments):
        return ExrFile(self.render_exr("x", "--spp", 2, *arguments)).chunks

    def test_cameras_go_by_name_and_by_number(self):
        self.assertEqual(self.chunks("--camera", "low"), self.chunks("--camera", 1))
        self.assertEqual(self.chunks("--camera", "eye"), self.chunks())
        self.assertNotEqual(self.chunks("--camera", "low"), self.chunks())

    def test_options_that_change_the_image(self):
        plain = self.chunks("--technique", "bdpt")
        for option in [("--look-at", "0,2,3,0,0,0"), ("--fov", 20), ("--sky", "1,1,1"),
                       ("--lamp-strength", 2), ("--max-bounces", 1), ("--exponent", 1),
                       ("--technique", "path"), ("--families", "emitter,next-event"),
                       ("--only", "2,1"), ("--sampler", "independent")]:
            with self.subTest(option=option):
                technique = [] if "--technique" in option else ["--technique", "bdpt"]
                self.assertNotEqual(plain, self.chunks(*technique, *option))

    def test_auto_is_the_path_tracer_where_nothing_more_is_needed(self):
        direct = ["--max-bounces", 1]
        plain = self.chunks("--technique", "path", *direct)
        self.assertEqual(plain, self.chunks(*direct))
        self.assertEqual(plain, self.chunks("--technique", "auto", "--threads", 1, *direct))
        done = self.render("-o", self.folder / "told.exr", "--spp", 1, "--stats",
                           self.folder / "told.json", "--technique", "auto", *direct)
        self.assertIn("auto: path tracing, no light subpaths", done.stderr)
        plan = json.loads((self.folder / "told.json").read_text())["plan"]
        self.assertEqual(0, plan["light_subpaths_per_pixel"])
        self.assertEqual(1, plan["direct_light_samples"])
        self.assertGreater(len(plan["weighed_up"]), 3)

    def test_no_bounces_show_emitters_alone(self):
        pixels = ExrFile(self.render_exr("x", "--spp", 2, "--max-bounces", 0)).pixels()
        self.assertTrue(all(value in (0, 1) or 0 <= value <= 1.001
                            for row in pixels["R"] for value in row))

    def test_crop_renders_its_pixels(self):
        exr = ExrFile(self.render_exr("x", "--spp", 2, "--crop", "8,4,24,20"))
        self.assertIn((exr.width, exr.height), [(16, 16), (32, 24)])


class DebugPixel(CliTest):
    def replay(self, where, *arguments, **options):
        return self.render("--seed", 5, "--spp", 4, "--debug-pixel", where, *arguments, **options)

    def test_says_the_same_every_time(self):
        first = self.replay("10,12,3", "--threads", 1).stdout
        self.assertTrue(first.strip())
        self.assertEqual(first, self.replay("10,12,3", "--threads", 2).stdout)
        self.assertNotEqual(first, self.replay("10,12,2").stdout)

    def test_writes_the_sample_out_in_full(self):
        # Names of vertices, what each path gave, and weights of all strategies that sum to one.
        lines = self.replay("10,12,3", "--exponent", "0,2", "--technique", "bdpt").stdout.splitlines()
        self.assertRegex(lines[0], r"^pixel 10,12 sample 3 light subpath \d+$")
        path = self.replay("10,12,3", "--technique", "path").stdout.splitlines()
        self.assertEqual("pixel 10,12 sample 3 no light subpath", path[0])
        self.assertRegex(lines[1], r"^  C0 camera at .* pdf_fwd - ")
        self.assertTrue(any(re.match(r"  L0 .*throughput", line) for line in lines), lines)
        sums, paths = None, 0
        for line in lines + ["  end"]:
            if not line.startswith("    "):
                if sums:
                    paths += 1
                    for total in sums:
                        self.assertAlmostEqual(1, total, 4, line)
                sums = None
            elif weights := re.findall(r"(?:weight\(\d\)|direct) (\S+)", line):
                sums = [a + float(b) for a, b in zip(sums or [0] * 4, weights, strict=True)]
        self.assertGreater(paths, 0)

    def test_refuses_what_is_outside(self):
        for where in ["32,0,0", "0,24,0", "-1,0,0", "1,2", "a,b,c"]:
            with self.subTest(where=where):
                self.refused("render", self.scene, "--size", "32x24", f"--debug-pixel={where}",
                             status=2)


class Interruption(CliTest):
    def long_render(self, image):
        process = self.start("render", self.scene, "--size", "64x48", "--time", 600, "-o", image,
                             "--stats", self.folder / "stats.json")
        self.wait_until_rendering(process)
        return process

    def test_ctrl_c_writes_the_image_whole(self):
        image = self.out / "a.exr"
        image.write_text("old")
        process = self.long_render(image)
        self.assertEqual("old", image.read_text(), "touched before the end")
        self.assertEqual(130, self.interrupt(process))
        self.assertEqual(64, ExrFile(image).width)
        self.assert_files("a.exr")
        stats = json.loads((self.folder / "stats.json").read_text())
        self.assertGreaterEqual(stats["spp"], 1)

    def test_an_interrupted_render_is_the_shorter_one(self):
        image = self.out / "a.exr"
        self.interrupt(self.long_render(image))
        spp = json.loads((self.folder / "stats.json").read_text())["spp"]
        again = self.out / "b.exr"
        self.render("--spp", spp, "-o", again, size="64x48")
        self.assertEqual(ExrFile(image).chunks, ExrFile(again).chunks)

    def test_a_killed_render_leaves_no_part_of_an_image(self):
        image = self.out / "a.exr"
        process = self.long_render(image)
        process.kill()
        process.wait()
        self.assertFalse(image.exists())
