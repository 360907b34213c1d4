"""Wrong usage ends with status 2 and one line that helps; help goes to stdout with status 0."""

from harness import CliTest


class Usage(CliTest):
    def test_help_names_every_command(self):
        text = self.run_midway("--help").stdout
        for command in ["render", "info", "diff"]:
            self.assertIn(command, text)

    def test_help_of_render_names_its_options(self):
        text = self.run_midway("render", "--help").stdout
        for option in ["--technique", "--exponent", "--spp", "--time", "--size", "--crop",
                       "--max-bounces", "--seed", "--threads", "--camera", "--look-at", "--fov",
                       "--sky", "--exposure", "--families", "--only", "--stats", "--debug-pixel",
                       "--quiet"]:
            self.assertIn(option, text)

    def test_no_command_is_refused(self):
        self.refused(status=2)

    def test_an_unknown_command_is_refused(self):
        self.refused("rendre", self.scene, status=2)

    def test_an_unknown_option_is_refused(self):
        line = self.refused("render", self.scene, "-o", self.out / "a.exr", "--sppp", 4, status=2)
        self.assertIn("--sppp", line)
        self.assert_files()

    def test_render_without_a_scene_is_refused(self):
        self.refused("render", "-o", self.out / "a.exr", status=2)

    def test_render_without_an_output_is_refused(self):
        self.refused("render", self.scene, "--spp", 1, status=2)

    def test_an_output_of_unknown_kind_is_refused(self):
        self.refused("render", self.scene, "--spp", 1, "-o", self.out / "a.jpg", status=2)
        self.assert_files()

    def test_values_outside_their_range_are_refused(self):
        number = 0
        for option, values in {
                "--spp": ["0", "-1", "x", "1.5", "99999999999999999999"],
                "--time": ["0", "-3", "nan", "inf", "soon"],
                "--size": ["0x0", "-4x4", "32", "32x", "x32", "1000000x1000000", "32x24x3"],
                "--technique": ["photon", "bdpt:", "bdpt:-1", "bdpt:nan", ""],
                "--exponent": ["-1", "nan", "33", "two"],
                "--threads": ["-1", "many"],
                "--max-bounces": ["-1", "x"],
                "--seed": ["-1", "x"],
                "--crop": ["0,0,0,0", "0,0,4", "5,5,2,2", "a,b,c,d"],
                "--fov": ["0", "180", "-5", "nan"],
                "--families": ["emitter,mirror", ","],
                "--only": ["1,1", "0,2", "2", "-1,2"],
                "--look-at": ["0,0,0", "0,0,0,0,0,nan", "1,1,1,1,1,1"],
                "--filter": ["sinc"],
                "--sampler": ["halton"]}.items():
            small = [] if option == "--size" else ["--size", "8x8"]
            for value in values:
                with self.subTest(option=option, value=value):
                    image = self.folder / f"{number}.exr"
                    number += 1
                    self.refused("render", self.scene, "-o", image, *small,
                                 f"{option}={value}", status=2)
                    self.assertFalse(image.exists())
