"""Films: shards and checkpoints give the bits of a single run, and only what fits is joined."""

import tiny_scene
from exr_file import ExrFile
from harness import CliTest


class Shards(CliTest):
    def film(self, name, *arguments, spp=7, seed=5):
        path = self.folder / f"{name}.film"
        self.render("--seed", seed, "--spp", spp, "-o", path, *arguments)
        return path

    def test_merge_to_the_bits_of_one_run(self):
        whole = self.render_exr("whole", "--spp", 7)
        shards = [self.film(i, "--shard", f"{i}/3", "--threads", i + 1) for i in range(3)]
        merged = self.out / "merged.exr"
        for order in [(0, 1, 2), (2, 0, 1), (1, 2, 0)]:
            with self.subTest(order=order):
                self.run_midway("merge", *(shards[i] for i in order), "-o", merged)
                self.assertEqual(ExrFile(whole).chunks, ExrFile(merged).chunks)

    def test_merge_in_steps(self):
        whole = self.film("whole")
        shards = [self.film(i, "--shard", f"{i}/4") for i in range(4)]
        halves = [self.folder / "low.film", self.folder / "high.film"]
        self.run_midway("merge", *shards[:2], "-o", halves[0])
        self.run_midway("merge", *shards[2:], "-o", halves[1])
        images = [self.out / "a.exr", self.out / "b.exr"]
        self.run_midway("merge", halves[1], halves[0], "-o", images[0])
        self.run_midway("merge", whole, "-o", images[1])
        self.assertEqual(ExrFile(images[0]).chunks, ExrFile(images[1]).chunks)

    def test_merge_writes_every_kind(self):
        film = self.film("a")
        self.run_midway("merge", film, "-o", self.out / "a.exr", "-o", self.out / "a.png",
                        "-o", self.out / "a.film")
        self.assert_files("a.exr", "a.film", "a.png")

    def test_merge_refuses_what_does_not_fit(self):
        first = self.film("first", "--shard", "0/2")
        other_scene = tiny_scene.write_gltf(self.folder / "other.gltf", albedo=0.5)
        strange = self.folder / "strange.film"
        self.run_midway("render", other_scene, "--size", "32x24", "--seed", 5, "--spp", 7,
                        "--shard", "1/2", "-o", strange)
        for case, film in {
                "the same samples twice": first,
                "another seed": self.film("seed", "--shard", "1/2", seed=6),
                "another technique": self.film("path", "--shard", "1/2", "--technique", "path"),
                "another scene": strange,
                "no film": self.scene,
                "a missing film": self.folder / "nowhere.film"}.items():
            with self.subTest(case=case):
                self.refused("merge", first, film, "-o", self.out / "a.exr", status=1)
                self.assert_files()

    def test_a_damaged_film_is_refused(self):
        whole = self.film("whole").read_bytes()
        cut = self.folder / "cut.film"
        for size in [0, 4, 100, len(whole) // 2, len(whole) - 1]:
            with self.subTest(size=size):
                cut.write_bytes(whole[:size])
                self.refused("merge", cut, "-o", self.out / "a.exr", status=1)
        cut.write_bytes(whole + b"\0")
        self.refused("merge", cut, "-o", self.out / "a.exr", status=1)
        self.assert_files()

    def test_wrong_shards_are_refused(self):
        for shard in ["3/3", "-1/3", "0/0", "1", "1/2/3", "a/b"]:
            with self.subTest(shard=shard):
                self.refused("render", self.scene, "--size", "8x8", "--spp", 7, f"--shard={shard}",
                             "-o", self.out / "a.film", status=2)


class Checkpoints(CliTest):
    def setUp(self):
        super().setUp()
        self.checkpoint = self.folder / "checkpoint.film"

    def resume(self, spp, *arguments, **options):
        return self.render_exr("resumed", "--spp", spp, "--checkpoint", self.checkpoint, "--resume",
                               *arguments, **options)

    def assert_like_one_run(self, spp):
        resumed = ExrFile(self.resume(spp))
        whole = ExrFile(self.render_exr("whole", "--spp", spp))
        self.assertEqual(whole.chunks, resumed.chunks)

    def start_long(self, *arguments):
        process = self.start("render", self.scene, "--size", "32x24", "--seed", 5, "--time", 600,
                             "-o", self.out / "long.exr", "--checkpoint", self.checkpoint,
                             *arguments)
        self.wait_until_rendering(process, seconds=3)
        return process

    def passes(self):
        """How many samples the checkpoint holds, as merge writes it into an image's header."""
        image = self.folder / "passes.exr"
        self.run_midway("merge", self.checkpoint, "-o", image)
        return int(ExrFile(image).attributes["midway:spp"])

    def test_go_on_to_the_bits_of_one_run(self):
        self.render_exr("first", "--spp", 3, "--threads", 1, "--checkpoint", self.checkpoint)
        self.assert_like_one_run(8)

    def test_resume_starts_where_there_is_none(self):
        self.assert_like_one_run(2)

    def test_survive_a_kill(self):
        process = self.start_long("--checkpoint-every", 0.5)
        process.kill()
        process.wait()
        self.assert_like_one_run(self.passes() + 3)

    def test_ctrl_c_ends_with_75(self):
        self.assertEqual(75, self.interrupt(self.start_long()))
        self.assertEqual(32, ExrFile(self.out / "long.exr").width)
        self.assert_like_one_run(self.passes() + 3)

    def test_of_another_render_are_refused(self):
        self.render_exr("first", "--spp", 3, "--checkpoint", self.checkpoint)
        for arguments in [("--seed", 6), ("--seed", 5, "--technique", "path"),
                          ("--seed", 5, "--camera", "low")]:
            with self.subTest(arguments=arguments):
                self.refused("render", self.scene, "--size", "32x24", "--spp", 4, "--resume",
                             "--checkpoint", self.checkpoint, "-o", self.out / "other.exr",
                             *arguments, status=1)
        self.assertFalse((self.out / "other.exr").exists())
