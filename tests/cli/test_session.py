"""Sessions, and the command line that a window copies: both make the bits they stand for."""

import json
import shutil

import tiny_scene
from exr_file import ExrFile
from harness import CliTest


class Sessions(CliTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "s.midway"

    def write(self, file=None, **fields):
        session = {"format": "midway session", "version": 1, "scene": "tiny.gltf",
                   "render": {"width": 32, "height": 24, "seed": 5}, "limits": {"spp": 3}}
        session.update(fields)
        (file or self.file).write_text(json.dumps(session))

    def render_session(self, name, *arguments, status=0):
        path = self.out / f"{name}.exr"
        self.run_midway("render", self.file, "-o", path, *arguments, status=status)
        return path

    def assert_same(self, first, second):
        a, b = ExrFile(first), ExrFile(second)
        self.assertEqual(a.chunks, b.chunks)
        for name in ["midway:spp", "midway:settings", "midway:scene_hash"]:
            self.assertEqual(a.attributes[name], b.attributes[name], name)

    def test_are_rendered_like_their_options(self):
        look_at = [0.1, 1.0000000000000002, 3.3, 0, 0.5, -0.1]
        self.write(camera={"look_at": look_at, "fov": 51.5, "aperture": 0.01, "focus": 3.25},
                   lights={"sky_color": "0.1,0.2,0.3", "sky_strength": 0.5, "lamp_strength": 2},
                   render={"width": 30, "height": 20, "technique": "path", "exponents": [1],
                           "families": "emitter,next-event", "max_bounces": 3, "seed": 9,
                           "sampler": "independent", "filter": "gaussian", "clamp": 4,
                           "crop": [2, 3, 20, 18]})
        session = self.render_session("session")
        direct = self.out / "direct.exr"
        self.run_midway(
            "render", self.scene, "-o", direct, "--look-at=" + ",".join(map(repr, look_at)),
            "--fov", 51.5, "--aperture", 0.01, "--focus", 3.25, "--sky", "0.1,0.2,0.3",
            "--sky-strength", 0.5, "--lamp-strength", 2, "--size", "30x20", "--technique", "path",
            "--exponent", 1, "--families", "emitter,next-event", "--max-bounces", 3, "--seed", 9,
            "--sampler", "independent", "--filter", "gaussian", "--clamp", 4,
            "--crop", "2,3,20,18", "--spp", 3)
        self.assert_same(session, direct)

    def test_the_command_line_wins(self):
        self.write(camera={"name": "low"}, lights={"lamp_strength": 3},
                   limits={"spp": 3, "seconds": 100})
        session = self.render_session("session", "--camera", "eye", "--lamp-strength", 1,
                                      "--seed", 7, "--size", "16x16", "--spp", 2,
                                      "--technique", "path:1")
        direct = self.out / "direct.exr"
        self.run_midway("render", self.scene, "-o", direct, "--camera", "eye", "--seed", 7,
                        "--size", "16x16", "--spp", 2, "--technique", "path:1")
        self.assert_same(session, direct)

    def test_find_their_scene_from_anywhere(self):
        deep = self.folder / "a" / "b"
        deep.mkdir(parents=True)
        self.write(deep / "s.midway", scene="../../tiny.gltf")
        self.write()
        self.run_midway("render", deep / "s.midway", "-o", self.out / "deep.exr")
        self.assert_same(self.render_session("near"), self.out / "deep.exr")
        shutil.move(self.scene, self.folder / "gone.gltf")
        self.refused("render", self.file, "-o", self.out / "a.exr", status=1)

    def test_info_tells_of_the_scene(self):
        self.write(lights={"sky_color": "1,1,1"})
        told = json.loads(self.run_midway("info", self.file, "--json").stdout)
        self.assertEqual("colour", told["sky"])
        self.assertTrue(told["scene"].endswith("tiny.gltf"))

    def test_edits_are_as_if_the_file_had_them(self):
        other = tiny_scene.document()
        chalk, lamp = other["materials"]
        chalk["pbrMetallicRoughness"].update(baseColorFactor=[0.3, 0.7, 0.1, 1],
                                             roughnessFactor=0.15, metallicFactor=0.6)
        lamp["emissiveFactor"] = [1, 0.3, 0.2]
        lamp["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": 7.7},
                              "KHR_materials_ior": {"ior": 1.7}}
        other["extensionsUsed"] += ["KHR_materials_emissive_strength", "KHR_materials_ior"]
        bulb = other["extensions"]["KHR_lights_punctual"]["lights"][0]
        bulb.update(type="spot", intensity=11.3, color=[0.2, 1, 0.7],
                    spot={"innerConeAngle": 0.2, "outerConeAngle": 0.9})
        (self.folder / "other.gltf").write_text(json.dumps(other))
        self.write(scene="other.gltf")
        of_file = self.render_session("of_file")
        self.write(version=2, edits={
            "lights": [{"index": 0, "name": "bulb", "kind": "spot", "strength": 11.3,
                        "color": [0.2, 1, 0.7], "inner_angle": 0.2, "outer_angle": 0.9}],
            "materials": [{"index": 0, "name": "chalk", "base_color": [0.3, 0.7, 0.1],
                           "roughness": 0.15, "metallic": 0.6},
                          {"index": 1, "name": "lamp", "emission_color": [1, 0.3, 0.2],
                           "emission_strength": 7.7, "ior": 1.7}]})
        self.assert_same(of_file, self.render_session("edited"))
        told = json.loads(self.run_midway("info", self.file, "--json").stdout)
        self.assertEqual(3, len(told["edits"]))
        self.assertIn('edited: material "chalk": base_color 0.3,0.7,0.1, metallic 0.6',
                      self.run_midway("info", self.file).stdout)

    def test_edits_of_what_is_gone_are_warned_of(self):
        self.write()
        plain = self.render_session("plain")
        self.write(version=2, edits={"lights": [{"index": 4, "name": "moon", "on": False}]})
        path = self.out / "gone.exr"
        done = self.run_midway("render", self.file, "-o", path)
        self.assertIn('warning: edit of light "moon" left out', done.stderr)
        self.assert_same(plain, path)

    def test_check_and_compare_take_them(self):
        self.write(version=2, edits={"materials": [{"index": 0, "name": "chalk",
                                                    "transmission": 1, "roughness": 0}]})
        checked = self.run_midway("check", self.file, "--paths", 200, "--rays", 0, "--json").stdout
        self.assertIn("s.midway", json.loads(checked)["command"])
        self.run_midway("compare", self.file, "-o", self.out / "report", "--time", 0.05,
                        "--reference-time", 0.1, "--seeds", 1, "--techniques", "path,bdpt:2")
        self.assertTrue((self.out / "report" / "report.html").exists())

    def test_unknown_fields_are_warned_of(self):
        self.write(mood="calm")
        done = self.run_midway("render", self.file, "-o", self.out / "a.exr")
        self.assertIn('warning: session field "mood"', done.stderr)

    def test_broken_ones_are_refused(self):
        for case, fields in {
                "another version": {"version": 3}, "no scene": {"scene": ""},
                "a session in a session": {"scene": "s.midway"},
                "a size of nothing": {"render": {"width": 0}},
                "text for a number": {"camera": {"fov": "wide"}},
                "an unknown technique": {"render": {"technique": "magic\n"}},
                "no samples": {"limits": {"spp": 0}}}.items():
            with self.subTest(case=case):
                self.write(**fields)
                self.refused("render", self.file, "-o", self.out / "a.exr", status=1)
        self.file.write_text("{")
        self.refused("info", self.file, status=1)
        self.write(render={"exponents": [77]})
        self.refused("render", self.file, "-o", self.out / "a.exr", status=2)
        self.assert_files()
