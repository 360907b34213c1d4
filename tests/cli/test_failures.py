"""What fails while running ends with status 1 and one line, and leaves no file behind."""

import json

import tiny_scene
from harness import CliTest


class BrokenScenes(CliTest):
    def refuse_scene(self, path):
        for command in [("render", path, "--spp", 1, "--size", "8x8", "-o", self.out / "a.exr"),
                        ("info", path)]:
            line = self.refused(*command, status=1)
            self.assertIn(path.name, line)
        self.assert_files()

    def test_a_missing_file_is_named(self):
        self.refuse_scene(self.folder / "nowhere.gltf")

    def test_a_folder_is_no_scene(self):
        folder = self.folder / "folder.gltf"
        folder.mkdir()
        self.refuse_scene(folder)

    def test_an_empty_file_is_refused(self):
        for name in ["empty.gltf", "empty.glb"]:
            file = self.folder / name
            file.write_bytes(b"")
            self.refuse_scene(file)

    def test_a_truncated_glb_is_refused_wherever_it_was_cut(self):
        whole = tiny_scene.write_glb(self.folder / "whole.glb").read_bytes()
        self.run_midway("info", self.folder / "whole.glb")
        for size in [3, 11, 12, 19, 20, 200, len(whole) // 2, len(whole) - 1]:
            with self.subTest(size=size):
                file = self.folder / "cut.glb"
                file.write_bytes(whole[:size])
                self.refuse_scene(file)

    def test_broken_json_is_refused(self):
        file = self.folder / "broken.gltf"
        file.write_text('{"asset": {"version": "2.0"')
        self.refuse_scene(file)

    def test_a_missing_buffer_is_refused(self):
        document = tiny_scene.document()
        document["buffers"][0]["uri"] = "gone.bin"
        file = self.folder / "no-buffer.gltf"
        file.write_text(json.dumps(document))
        self.refuse_scene(file)

    def test_a_buffer_outside_the_folder_is_not_opened(self):
        secret = self.folder / "secret.bin"
        secret.write_bytes(b"\0" * 4096)
        inner = self.folder / "inner"
        inner.mkdir()
        for uri in ["../secret.bin", "%2e%2e/secret.bin", str(secret), f"file://{secret}"]:
            with self.subTest(uri=uri):
                document = tiny_scene.document()
                document["buffers"][0]["uri"] = uri
                file = inner / "outside.gltf"
                file.write_text(json.dumps(document))
                self.refuse_scene(file)

    def test_an_index_out_of_range_is_refused_or_left_out(self):
        document = tiny_scene.document()
        document["meshes"][0]["primitives"][0]["indices"] = 99
        file = self.folder / "index.gltf"
        file.write_text(json.dumps(document))
        done = self.run_midway("info", file, status=None)
        if done.returncode == 0:
            self.assertIn("room", done.stdout)
        else:
            self.refuse_scene(file)

    def test_an_unknown_camera_is_refused(self):
        for camera in ["nobody", "99", "-1"]:
            with self.subTest(camera=camera):
                done = self.render("--spp", 1, "-o", self.out / "a.exr", f"--camera={camera}",
                                   status=None)
                self.assertIn(done.returncode, [1, 2], done.stderr)
                self.assertIn("midway: error: ", done.stderr)
        self.assert_files()


class UnwritableOutputs(CliTest):
    def test_are_noticed_before_the_render(self):
        for path in ["/nonexistent-folder/a.exr", self.scene / "a.png"]:
            with self.subTest(path=path):
                self.refused("render", self.scene, "--size", "64x48", "--time", 60, "-o", path,
                             status=1, seconds=20)
        self.assert_files()

    def test_a_folder_in_place_of_the_image_is_refused(self):
        folder = self.out / "a.exr"
        folder.mkdir()
        self.refused("render", self.scene, "--size", "8x8", "--time", 60, "-o", folder, status=1,
                     seconds=20)
        self.assert_files("a.exr")

    def test_one_bad_output_of_two_spoils_neither(self):
        self.refused("render", self.scene, "--size", "8x8", "--spp", 1, "-o", self.out / "a.exr",
                     "-o", "/nonexistent-folder/a.png", status=1)
        self.assert_files()

    def test_an_old_image_survives_a_failure(self):
        image = self.out / "a.exr"
        image.write_text("old")
        self.refused("render", self.folder / "nowhere.gltf", "--spp", 1, "-o", image, status=1)
        self.assertEqual("old", image.read_text())
