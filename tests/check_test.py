#!/usr/bin/env python3
"""The group `style`: the tree obeys check_includes.py, check_names.py and check_style.py, and they see
what they should: every rule is broken once in a tree made for it."""

import sys
import tempfile
import unittest
from pathlib import Path

import check_includes
import check_names
import check_style
from support import counted

ROOT = Path(__file__).resolve().parent.parent


def found(check, files):
    """What `check` says of a tree of these files (path -> text)."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            file = Path(folder) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return check.violations(Path(folder))


class TheTree(unittest.TestCase):
    def test_includes_point_left(self):
        self.assertEqual([], check_includes.violations(ROOT))

    def test_names_are_given_once(self):
        self.assertEqual([], check_names.violations(ROOT))

    def test_obeys_the_house_rules(self):
        self.assertEqual([], check_style.violations(ROOT))


class IncludeRules(unittest.TestCase):
    def broken_by(self, path, line, other=()):
        files = {name: "" for name in other}
        files[path] = line + "\n"
        return len(found(check_includes, files)) == 1

    def test_left_is_allowed(self):
        headers = ["renderer/math/a.h", "renderer/scene/s.h", "renderer/integrator/mis.h",
                   "renderer/render/film.h"]
        for path, line in [
                ("renderer/scene/x.cpp", '#include "math/a.h"'),
                ("renderer/scene/x.cpp", '#include "scene/s.h"'),
                ("renderer/scene/x.cpp", '#include "s.h"'),
                ("renderer/io/x.cpp", '#include "scene/s.h"'),
                ("app/batch/x.cpp", '#include "render/film.h"'),
                ("renderer/math/x.cpp", "#include <vector>"),
                ("renderer/math/x.cpp", "#include <sys/stat.h>"),
                ("renderer/math/x.cpp", "#include <glm/glm.hpp>"),
                ("renderer/math/x.cpp", '// #include "scene/s.h"')]:
            self.assertFalse(self.broken_by(path, line, headers), f"{path}: {line}")

    def test_right_and_sideways_are_found(self):
        headers = ["renderer/scene/s.h", "renderer/io/load.h", "renderer/integrator/mis.h",
                   "renderer/math/a.h", "app/viewer/window.h", "app/batch/options.h"]
        for path, line in [
                ("renderer/math/x.h", '#include "scene/s.h"'),
                ("renderer/scene/x.h", '#  include "integrator/mis.h"'),
                ("renderer/io/x.cpp", '#include "integrator/mis.h"'),
                ("renderer/integrator/x.cpp", '#include "io/load.h"'),
                ("renderer/scene/x.h", '#include "../math/a.h"'),
                ("renderer/report/x.cpp", '#include "batch/options.h"'),
                ("app/batch/x.cpp", '#include "viewer/window.h"')]:
            self.assertTrue(self.broken_by(path, line, headers), f"{path}: {line}")

    def test_libraries_keep_to_their_rooms(self):
        for path, line in [
                ("renderer/scene/accel.cpp", "#include <embree3/rtcore.h>"),
                ("renderer/io/gltf.cpp", "#include <tiny_gltf.h>"),
                ("renderer/io/gltf.cpp", "#include <stb/stb_image.h>"),
                ("renderer/image/png.cpp", "#include <stb/stb_image_write.h>"),
                ("renderer/image/exr.cpp", "#include <OpenEXR/ImfOutputFile.h>"),
                ("app/viewer/window.cpp", "#include <GLFW/glfw3.h>"),
                ("app/batch/main.cpp", "#include <CLI/CLI.hpp>"),
                ("renderer/report/stats.cpp", "#include <nlohmann/json.hpp>")]:
            self.assertFalse(self.broken_by(path, line), f"{path}: {line}")
        for path, line in [
                ("renderer/scene/accel.h", "#include <embree3/rtcore.h>"),
                ("renderer/scene/mesh.cpp", "#include <embree4/rtcore.h>"),
                ("renderer/scene/load.cpp", "#include <tiny_gltf.h>"),
                ("renderer/io/out.cpp", "#include <stb/stb_image_write.h>"),
                ("renderer/shading/texture.cpp", '#include "stb_image.h"'),
                ("renderer/render/film.cpp", "#include <OpenEXR/ImfOutputFile.h>"),
                ("renderer/math/half.h", "#include <ImathBox.h>"),
                ("app/batch/main.cpp", "#include <GLFW/glfw3.h>"),
                ("renderer/render/view.cpp", '#include "imgui.h"'),
                ("app/viewer/main.cpp", "#include <CLI/CLI.hpp>"),
                ("renderer/scene/x.cpp", "#include <nlohmann/json.hpp>"),
                ("renderer/math/x.cpp", "#include <Eigen/Dense>"),
                ("renderer/math/x.cpp", '#include "no_such_file.h"')]:
            self.assertTrue(self.broken_by(path, line), f"{path}: {line}")

    def test_a_folder_without_a_layer_is_found(self):
        self.assertTrue(self.broken_by("renderer/misc/x.cpp", ""))


class NameRules(unittest.TestCase):
    def count(self, first, second):
        return len(found(check_names, {"renderer/a/x.h": first, "app/viewer/y.cpp": second}))

    def test_a_type_of_two_files_is_found(self):
        for kind in ["struct A ", "class A final ", "enum A ", "enum class A : int ", "union A "]:
            self.assertEqual(1, self.count("namespace m {\nstruct A {\n};\n}\n",
                                           "namespace m {\n" + kind + "{\n};\n}\n"), kind)

    def test_what_nobody_else_sees_may_be_called_alike(self):
        one = "namespace m {\nstruct A {\n};\n}\n"
        for other in ["namespace m {\nnamespace {\nstruct A {};\n}\n}\n", "namespace n { struct A {}; }",
                      "namespace m { void f() { struct A {}; } }", "namespace m { struct A::B {}; }",
                      "namespace m { struct B { struct A {}; }; }", "namespace m { struct A; }",
                      "// namespace m { struct A {}; }", "namespace m { A f(struct A a) {} }"]:
            self.assertEqual(0, self.count(one, other), other)


class StyleRules(unittest.TestCase):
    def count(self, text, path="renderer/math/x.cpp"):
        return len(found(check_style, {path: text}))

    def test_long_files_are_found(self):
        self.assertEqual(0, self.count("int x;\n" * 400))
        self.assertEqual(1, self.count("int x;\n" * 401))
        self.assertEqual(1, self.count("x = 1\n" * 401, "tests/long.py"))

    def test_long_functions_are_found(self):
        def body(lines):
            return "{\n" + "    if (a) { b({1, 2}); }\n" * lines + "}\n"
        for head in ["int f(int a) ", "Foo::Foo(int a) : a_(a) ", "auto f() -> int ",
                     "namespace {\nstruct S {\n    int f() const "]:
            tail = "};\n}\n" if "struct" in head else ""
            self.assertEqual(0, self.count(head + body(60) + tail), head)
            self.assertEqual(1, self.count(head + body(61) + tail), head)
        self.assertEqual(1, self.count("int f(int a) " + body(61), "app/batch/x.cpp"))

    def test_what_is_no_function_may_be_long(self):
        for head in ["namespace a ", "struct S ", "const int t[] = ", "enum class E : int "]:
            self.assertEqual(0, self.count(head + "{\n" + "    // {\n" * 100 + "};\n"), head)

    def test_inheritance_is_found(self):
        self.assertEqual(1, self.count("class A : public B {};\n"))
        self.assertEqual(1, self.count("template <class... Ts>\nstruct A : Ts... {};\n"))
        self.assertEqual(1, self.count("struct A final\n    : B {};\n"))
        self.assertEqual(0, self.count("class A : public B {};\n", "app/viewer/x.cpp"))
        self.assertEqual(0, self.count("enum class A : std::uint8_t { x };\nstruct A { int b : 3; };\n"))
        self.assertEqual(0, self.count("// class A : public B {};\n"))
        self.assertEqual(0, self.count("class Memory : public Imf::IStream {};\n"))

    def test_printing_in_the_renderer_is_found(self):
        for line in ["std::cout << 1;", "std::cerr << 1;", 'printf("x");', 'fmt::print("x");']:
            self.assertEqual(1, self.count(line), line)
            self.assertEqual(0, self.count(line, "app/batch/x.cpp"), line)
        for line in ['log("std::cout");', "std::snprintf(b, 1, c);", "// std::cout"]:
            self.assertEqual(0, self.count(line), line)

    def test_small_absolute_numbers_are_found(self):
        for line in ["float offset = 1e-4f;", "t > 0.001f", "d < .0005", "const float epsilon = x;",
                     "if (c > 0.999f)", "ray.tnear = 1e-3;", "x * 1.0001f"]:
            self.assertEqual(1, self.count(line, "renderer/scene/x.cpp"), line)
            self.assertEqual(0, self.count(line, "renderer/image/x.cpp"), line)
        for line in ["0x1p-24f * x", "// 1e-4", 'f("1e-4");', "0.5f * x", "x = 1.0f", "a1e_4 = 10;"]:
            self.assertEqual(0, self.count(line, "renderer/scene/x.cpp"), line)

    def test_promises_are_found(self):
        self.assertEqual(1, self.count("// TO" "DO: later\n"))
        self.assertEqual(1, self.count("# FIX" "ME\n", "tests/x.py"))
        self.assertEqual(0, self.count("// the method of Todorov\n"))


if __name__ == "__main__":
    sys.exit(counted.run(unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__])))
