"""The window drawn in memory, driven by scripts."""

import json
import re
import subprocess
from pathlib import Path

import tiny_scene
import window_test
from exr_file import ExrFile
from window_test import WindowTest, part, read_png, wait_for

ERROR_LINE = re.compile(r"^midway-view: error: \S.* \(.+\); \S.*$")


class Pictures(WindowTest):
    def test_screenshot_holds_image_and_panels(self):
        self.run_view("--offscreen", "--window", "1000x600", "--frames", 3, "--screenshot",
                      "shot.png", self.scene)
        self.keep("shot.png")
        picture = read_png(self.folder / "shot.png")
        self.assertEqual((1000, 600), picture[:2])
        left, middle = part(picture, 0, 0, 200, 500), part(picture, 400, 100, 600, 500)
        self.assertGreater(len(set(left)), 20, "the left column is empty")
        self.assertTrue(any(max(p) > 180 for p in left), "no text in the left column")
        self.assertGreater(len(set(middle)), 50, "the image is empty")
        self.assertGreater(sum(map(sum, middle)) / len(middle), 15, "the image is black")

    def test_osmesa_draws_the_same_window(self):
        done = self.play("wait frames 3", "--gl", "osmesa", self.scene, status=None)
        if "libOSMesa" in done.stderr:
            self.skipTest("libOSMesa is missing")
        script = "wait loaded\nset pause on\nset size 16x12\nwait idle\nset panels off\n" \
                 "wait frames 5\nscreenshot {}"
        self.play(script.format("egl.png"), self.scene)
        self.play(script.format("osmesa.png"), "--gl", "osmesa", self.scene)
        egl, osmesa = (part(read_png(self.folder / n), 0, 0, 400, 300)
                       for n in ("egl.png", "osmesa.png"))
        self.assertLessEqual(max(abs(a - b) for p, q in zip(egl, osmesa) for a, b in zip(p, q)), 1)

    def test_saved_png_is_what_is_seen(self):
        """Shader and PNG writer differ by less than one of 255 steps, in every curve and channel."""
        looks = {"srgb": "", "bright": "set exposure 2.3", "filmic": "set curve filmic",
                 "agx": "set curve agx\nset exposure 1", "stops": "set curve srgb\n"
                 "set exposure 0\nset false-colour on", "error": "set channel error",
                 "samples": "set channel samples", "albedo": "set channel albedo",
                 "normal": "set channel normal", "depth": "set channel depth",
                 "object": "set channel object"}
        script = f"open {self.scene}\nset size 64x48\nset spp 4\nwait idle\nset panels off\n" \
                 "set zoom 1\n"
        for name, look in looks.items():
            script += f"{look}\nwait seconds 0.3\nwait idle\nscreenshot seen-{name}.png\n" \
                      f"save saved-{name}.png\nwait saved\n"
        self.play(script)
        pictures = set()
        for name in looks:
            with self.subTest(name):
                seen = read_png(self.folder / f"seen-{name}.png")
                saved = read_png(self.folder / f"saved-{name}.png")
                if name != "samples":  # one value for all pixels
                    self.assertEqual((64, 48), saved[:2])
                    seen_pixels = part(seen, 168, 126, 232, 174)
                    saved_pixels = part(saved, 0, 0, 64, 48)
                    pictures.add(tuple(saved_pixels))
                else:
                    seen_pixels, saved_pixels = part(seen, 200, 150, 201, 151), part(saved, 0, 0, 1, 1)
                worst = max(abs(a - b) for p, q in zip(seen_pixels, saved_pixels)
                            for a, b in zip(p, q))
                self.assertLessEqual(worst, 1)
        self.assertEqual(len(looks) - 1, len(pictures), "two looks are the same picture")


class Files(WindowTest):
    def test_saved_exr_is_that_of_the_copied_command_line(self):
        for name, words in {
                "as it comes": "",
                "technique": "set technique path\nset exponent 1\nset max-bounces 3\nset seed 7",
                "auto": "set technique auto\nset max-bounces 5",
                "camera": "camera orbit 23.7 -11\ncamera dolly 0.83\nset fov 41.3",
                "lens": "set aperture 0.031\nset focus 4.7",
                "light": "set lamp-strength 0.3\nset sky 0.1,0.2,0.37\nset sky-strength 1.7",
                "same paths": "set same-paths on\nset exponent 1.37",
                "crop": "set crop 5,7,31,29",
                "families": "set families emitter,connect\nset filter box\nset sampler independent",
        }.items():
            with self.subTest(name):
                self.play(f"open {self.scene}\nset size 48x36\nwait loaded\n{words}\nset spp 3\n"
                          "wait idle\ncopy line.txt\nsave window.exr\nwait saved")
                batch = self.run_command_line(self.folder / "line.txt")
                self.assertEqual(batch.read_bytes(), (self.folder / "window.exr").read_bytes())
                batch.unlink()

    def test_session_brings_back_the_same_bits(self):
        self.play(f"open {self.scene}\nset size 40x30\nset spp 2\nwait loaded\n"
                  "set technique light\ncamera look 3 1\nset lamp-strength 2\nset exposure -1.5\n"
                  "set curve filmic\nwait idle\nsave a.exr\nsave-session s.midway\nwait saved\n"
                  "set exposure 0\nset curve srgb\nset technique bdpt\nopen s.midway\nwait idle\n"
                  "save b.exr\nsave-session t.midway\nwait saved")
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())
        self.assertEqual((self.folder / "s.midway").read_text(),
                         (self.folder / "t.midway").read_text())

    def test_dropped_sky_lights_the_scene(self):
        sky = Path(__file__).resolve().parents[2] / "assets" / "terrace_sky.hdr"
        self.play(f"open {self.scene}\nset size 24x18\nset spp 2\nwait idle\nsave dark.exr\n"
                  f"wait saved\ndrop {sky}\nwait idle\nsave lit.exr\nwait saved\nreport report.json")
        self.assertEqual("", self.report()["error"])
        dark, lit = (sum(map(sum, ExrFile(self.folder / n).pixels()["R"]))
                     for n in ("dark.exr", "lit.exr"))
        self.assertGreater(lit, dark * 1.01)

    def test_broken_file_leaves_the_scene(self):
        (self.folder / "broken.gltf").write_text("{")
        self.play(f"open {self.scene}\nset size 24x18\nset spp 2\nwait idle\nsave a.exr\nwait saved\n"
                  "open broken.gltf\nwait loaded\nwait frames 3\nreport report.json\n"
                  "screenshot broken.png\nset seed 0\nsave b.exr\nwait saved")
        self.keep("broken.png")
        self.assertRegex(self.report()["error"], r"^\S.* \(.*broken\.gltf.*\); \S.*$")
        self.assertTrue(self.report()["scene"].endswith("tiny.gltf"))
        self.assertEqual((self.folder / "a.exr").read_bytes(), (self.folder / "b.exr").read_bytes())

    def test_changed_file_is_read_again_and_the_camera_stays(self):
        script = self.folder / "script.txt"
        script.write_text(f"timeout {60 * window_test.slow:g}\nopen {self.scene}\nset size 24x18\n"
                          "set spp 2\nwait loaded\ncamera orbit 20 5\nwait idle\nsave a.exr\n"
                          "wait saved\nreport first.json\nwait reload\nwait idle\nsave b.exr\n"
                          "wait saved\ncopy line.txt\nquit\n")
        process = subprocess.Popen([str(window_test.view), "--offscreen", "--script", str(script)],
                                   cwd=self.folder, env=self.environment)
        self.addCleanup(process.kill)
        self.assertTrue(wait_for((self.folder / "first.json").exists))
        tiny_scene.write_gltf(self.scene, albedo=0.2)
        self.assertEqual(0, process.wait(timeout=120 * window_test.slow))
        self.assertIn("--look-at", (self.folder / "line.txt").read_text())
        batch = self.run_command_line(self.folder / "line.txt")
        self.assertEqual(batch.read_bytes(), (self.folder / "b.exr").read_bytes())
        self.assertNotEqual((self.folder / "a.exr").read_bytes(),
                            (self.folder / "b.exr").read_bytes())


class Edits(WindowTest):
    """Lights and materials: what the window shows is what a file with these values shows."""

    WORDS = ("edit material chalk base_color 0.3,0.7,0.1\nedit material chalk roughness 0.15\n"
             "edit material 1 emission_color 1,0.3,0.2\nedit material lamp emission_strength 7.7\n"
             "edit light bulb kind spot\nedit light bulb strength 11.3\n"
             "edit light bulb outer_angle 0.9\nedit light bulb inner_angle 0.2\n")

    def edited_file(self):
        other = tiny_scene.document()
        chalk, lamp = other["materials"]
        chalk["pbrMetallicRoughness"].update(baseColorFactor=[0.3, 0.7, 0.1, 1],
                                             roughnessFactor=0.15)
        lamp["emissiveFactor"] = [1, 0.3, 0.2]
        lamp["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": 7.7}}
        other["extensionsUsed"].append("KHR_materials_emissive_strength")
        bulb = other["extensions"]["KHR_lights_punctual"]["lights"][0]
        bulb.update(type="spot", intensity=11.3,
                    spot={"innerConeAngle": 0.2, "outerConeAngle": 0.9})
        path = self.folder / "edited.gltf"
        path.write_text(json.dumps(other))
        return path

    def bits(self, name):
        exr = ExrFile(self.folder / name)
        return exr.chunks, exr.attributes["midway:scene_hash"]

    def test_an_edit_is_as_if_the_file_had_the_value_and_undo_takes_it_back(self):
        self.play(f"open {self.edited_file()}\nset size 40x30\nset spp 2\nwait idle\n"
                  f"save file.exr\nwait saved\nopen {self.scene}\nwait idle\nsave before.exr\n"
                  f"wait saved\n{self.WORDS}wait idle\nsave edited.exr\nwait saved\n"
                  "copy line.txt\nsave-session s.midway\nwait saved\nreport edited.json\n"
                  + "undo\n" * 8 + "wait idle\nsave undone.exr\nwait saved\nreport undone.json\n"
                  + "redo\n" * 8 + "wait idle\nsave redone.exr\nwait saved\n"
                  "reset\nwait idle\nsave reset.exr\nwait saved\nreport reset.json\n"
                  "open s.midway\nwait idle\nsave session.exr\nwait saved")
        for name in ("edited.exr", "redone.exr", "session.exr"):
            self.assertEqual(self.bits("file.exr"), self.bits(name), name)
        for name in ("undone.exr", "reset.exr"):
            self.assertEqual(self.bits("before.exr"), self.bits(name), name)
        self.assertNotEqual(self.bits("before.exr"), self.bits("edited.exr"))
        self.assertEqual((8, 0), tuple(self.report("edited.json")[k] for k in ("undo", "redo")))
        self.assertEqual((0, 8), tuple(self.report("undone.json")[k] for k in ("undo", "redo")))
        self.assertEqual(9, self.report("reset.json")["undo"])
        self.assertEqual(3, len(self.report("edited.json")["edits"]))
        batch = self.run_command_line(self.folder / "line.txt")
        self.assertEqual(batch.read_bytes(), (self.folder / "edited.exr").read_bytes())

    def test_edits_find_their_place_after_a_reload(self):
        self.play(f"open {self.scene}\nset size 24x18\nset spp 1\nwait idle\n{self.WORDS}"
                  "wait idle\nsave a.exr\nwait saved\nreload\nwait reload\nwait idle\n"
                  "save b.exr\nwait saved\nreport b.json")
        self.assertEqual(self.bits("a.exr"), self.bits("b.exr"))
        self.assertEqual(3, len(self.report("b.json")["edits"]))

    def test_edits_of_what_a_reloaded_file_no_longer_holds_are_named(self):
        self.play(f"open {self.scene}\nset size 24x18\nset spp 1\nwait idle\n{self.WORDS}"
                  "wait idle\nsave-session s.midway\nwait saved")
        other = tiny_scene.document()
        other["materials"][0]["name"] = "slate"
        self.scene.write_text(json.dumps(other))
        self.play("open s.midway\nwait idle\nreport r.json")
        report = self.report("r.json")
        self.assertEqual("", report["error"])
        self.assertTrue(any('"chalk"' in line for line in report["warnings"]), report["warnings"])

    def test_a_click_selects_and_a_drag_is_one_step(self):
        """On the first lamp's strength; the rows of the right column have fixed places."""
        self.play(f"open {self.scene}\nset size 64x48\nset spp 2\nwait idle\nwait frames 3\n"
                  "key u\nclick 500 420\nwait idle\nwait frames 3\nscreenshot selected.png\n"
                  "report selected.json", size="1000x800")
        self.keep("selected.png")
        selected = self.report("selected.json")["selected"]
        self.assertEqual({"object": "room", "material": "chalk"}, selected)

    def test_every_edit_shows_an_image_and_its_time_is_told(self):
        edits = "".join(f"edit light bulb strength {i}\nwait image\nwait frames 2\n"
                        for i in range(10, 20))
        self.play(f"open {self.scene}\nset size 64x48\nwait spp 1\nmark\n{edits}report r.json")
        report = self.report("r.json")
        self.assertEqual(10, report["edit_to_image"]["count"])
        self.assertGreater(report["edit_to_image"]["median"], 0)
        self.assertEqual(['light "bulb": strength 19'], report["edits"])


class Behaviour(WindowTest):
    def test_finished_window_rests(self):
        """At most a twentieth of a core, the look at the files once a second included."""
        self.play(f"open {self.scene}\nset size 24x18\nset spp 1\nwait idle\nwait seconds 6\nmark\n"
                  "wait seconds 4\nreport report.json")
        report = self.report()
        self.assertLessEqual(report["frames"]["count"], 8)
        self.assertLess(report["cpu_seconds"], 0.05 * report["seconds"])

    def test_exposure_and_exponent_of_the_same_paths_do_not_restart(self):
        self.play(f"open {self.scene}\nset size 24x18\nset same-paths on\nset spp 2\nwait idle\n"
                  "report before.json\nset exposure 1\nset curve agx\nset channel error\n"
                  "set panels off\nset exponent 0\nwait frames 3\nset exponent 1\nset zoom 4\n"
                  "resize 500x400\nwait seconds 1\nwait idle\nreport after.json")
        self.assertEqual(self.report("before.json")["job"], self.report("after.json")["job"])

    def test_camera_and_settings_restart(self):
        self.play(f"open {self.scene}\nset size 24x18\nset spp 2\nwait idle\nreport a.json\n"
                  "camera orbit 5\nwait idle\nreport b.json\nset technique path\nwait idle\n"
                  "report c.json\nset lamp-strength 2\nwait idle\nreport d.json\n"
                  "set spp 4\nwait spp 4\nwait idle\nreport e.json")
        jobs = [self.report(f"{name}.json")["job"] for name in "abcde"]
        self.assertTrue(jobs[0] < jobs[1] < jobs[2] < jobs[3] == jobs[4], jobs)

    def test_hands_reach_the_panels(self):
        self.play(f"open {self.scene}\nset size 48x36\nset spp 2\nwait idle\nscreenshot a.png\n"
                  "key Tab\nwait frames 3\nscreenshot b.png\nkey Tab\nkey F1\nwait frames 3\n"
                  "screenshot c.png\nkey Escape\nkey 1\nwait idle\nsave path.exr\nwait saved\n"
                  "key b\nwait idle\nsave balance.exr\nwait saved\nreport r1.json\n"
                  "drag 500 300 560 320\nwait seconds 1\nwait idle\nreport r2.json",
                  size="1000x600")
        shots = [read_png(self.folder / f"{n}.png")[2] for n in "abc"]
        self.assertTrue(shots[0] != shots[1] != shots[2] != shots[0])
        self.keep("c.png")
        path, balance = (ExrFile(self.folder / n).attributes for n in ("path.exr", "balance.exr"))
        self.assertIn(b'"technique":"path"', path["midway:settings"])
        self.assertEqual(b"1", balance["midway:exponent"])
        self.assertLess(self.report("r1.json")["job"], self.report("r2.json")["job"])


class Pyramid(WindowTest):
    START = "open {}\nset size 48x36\nset spp 8\nset panels off\n"

    def test_strategies_show_and_the_file_stays_the_image(self):
        """Opening and choosing never restart the render; PNG as seen, EXR as midway render."""
        self.play("set pyramid on\n" + self.START.format(self.scene) + "wait idle\nreport a.json\n"
                  "save whole.png\nwait saved\nset strategies 2,1\nwait seconds 0.3\n"
                  "save one.png\nsave one.exr\nwait saved\nset strategies 2,1;3,1;longer\n"
                  "set pyramid-weights bare\nwait seconds 0.3\nsave bare.png\nwait saved\n"
                  "report b.json\nset strategies none\nset pyramid off\nwait frames 3\n"
                  "copy line.txt\nsave again.png\nwait saved\nreport c.json", size="1280x720")
        a, b, c = (self.report(f"{name}.json") for name in "abc")
        self.assertEqual((a["job"], a["spp"]), (c["job"], c["spp"]))
        self.assertEqual(8, a["pyramid"]["passes"])
        self.assertEqual([[2, 1], [3, 1], [0, 0]], b["pyramid"]["selected"])
        self.assertFalse(c["pyramid"]["open"])
        self.assertEqual(0, c["pyramid"]["passes"], "nothing is kept while it is closed")
        whole, one, bare, again = (read_png(self.folder / f"{name}.png")[2]
                                   for name in ("whole", "one", "bare", "again"))
        self.assertEqual(whole, again)
        self.assertTrue(whole != one != bare != whole)
        batch = self.run_command_line(self.folder / "line.txt")
        self.assertEqual(batch.read_bytes(), (self.folder / "one.exr").read_bytes())

    def test_chosen_cells_are_at_full_size_from_then_on(self):
        self.play(self.START.format(self.scene) + "wait idle\nset pyramid on\nset strategies 2,1\n"
                  "wait seconds 0.5\nreport a.json\nset spp 12\nwait strategies 4\nwait idle\n"
                  "report b.json\nscreenshot pyramid.png", size="1280x720")
        self.keep("pyramid.png")
        a, b = self.report("a.json"), self.report("b.json")
        self.assertEqual((0, False), (a["pyramid"]["passes"], a["pyramid"]["full_size"]))
        self.assertEqual((4, True), (b["pyramid"]["passes"], b["pyramid"]["full_size"]))
        self.assertEqual(12, b["spp"])
        self.assertEqual(a["job"], b["job"])

    def test_what_auto_leaves_out_is_shown_as_left_out(self):
        """Its plan has no light tracing here; the next camera's is shown once it is made."""
        self.play(f"open {self.scene}\nset size 48x36\nset spp 4\n"
                  "set families emitter,next-event,light\nset pyramid on\nwait idle\n"
                  "wait frames 3\nreport auto.json\nscreenshot auto.png\nset technique bdpt\n"
                  "wait idle\nwait frames 3\nreport bdpt.json\nset technique auto\n"
                  "camera orbit 1\nwait idle\nwait frames 3\nreport moved.json", size="1280x720")
        self.keep("auto.png")
        left_out = {}
        for name in ("auto", "bdpt", "moved"):
            told = self.report(f"{name}.json")
            left_out[name] = [c["left_out"] for c in told["pyramid"]["cells"]
                              if (c["s"], c["t"]) in ((1, 2), (1, 3))]
            self.assertIn("textures: no material has one", told["left_out"])
        self.assertEqual({"auto": [True] * 2, "bdpt": [False] * 2, "moved": [True] * 2}, left_out)

    def test_a_session_brings_the_pyramid_back(self):
        self.play(self.START.format(self.scene) + "set strategies 1,2;longer\n"
                  "set pyramid-weights bare\nset pyramid-exposure own\nset pyramid-share noise\n"
                  "wait idle\nsave-session s.midway\nwait saved\nset pyramid off\n"
                  "set pyramid-weights weighted\nopen s.midway\nwait idle\n"
                  "save-session t.midway\nwait saved\nreport r.json")
        self.assertEqual((self.folder / "s.midway").read_text(),
                         (self.folder / "t.midway").read_text())
        pyramid = self.report("r.json")["pyramid"]
        self.assertEqual((True, True), (pyramid["open"], pyramid["bare"]))
        self.assertEqual([[1, 2], [0, 0]], pyramid["selected"])

    def test_osmesa_draws_the_same_pyramid(self):
        done = self.play("wait frames 3", "--gl", "osmesa", self.scene, status=None)
        if "libOSMesa" in done.stderr:
            self.skipTest("libOSMesa is missing")
        script = "set pyramid on\nset pyramid-exposure own\n" + self.START.format(self.scene) + \
            "wait idle\nwait frames 5\nscreenshot {}"
        self.play(script.format("egl.png"), size="900x600")
        self.play(script.format("osmesa.png"), "--gl", "osmesa", size="900x600")
        egl, osmesa = (part(read_png(self.folder / n), 0, 0, 900, 600)
                       for n in ("egl.png", "osmesa.png"))
        self.assertLessEqual(max(abs(a - b) for p, q in zip(egl, osmesa) for a, b in zip(p, q)), 1)


class Refusals(WindowTest):
    def refused(self, done):
        self.assertRegex(done.stderr.strip(), ERROR_LINE)

    def test_without_a_display_one_line_says_what_to_do(self):
        done = self.run_view(self.scene, status=1)
        self.refused(done)
        self.assertIn("--offscreen", done.stderr)
        self.assertIn("midway render", done.stderr)

    def test_wrong_usage(self):
        for words in (["--windwo", "3x3"], ["--window", "3"], ["--technique", "photon"],
                      ["a.glb", "b.glb"], ["--frames"], ["--spp", "0"]):
            with self.subTest(words):
                self.refused(self.run_view("--offscreen", *words, status=2))

    def test_faults_of_a_script_name_their_line(self):
        for text, line in {"frobnicate": 2, "set technique": 2, "set technique photon": 2,
                           "set exponent -1": 2, "wait forever": 2, "key Hyper": 2,
                           f"open {self.scene}\nwait loaded\ncamera hop 3": 4}.items():
            with self.subTest(text):
                done = self.play(text, status=1)
                self.refused(done)
                self.assertIn(f"script.txt:{line})", done.stderr)

    def test_a_missing_script(self):
        self.refused(self.run_view("--offscreen", "--script", "nowhere.txt", status=1))
