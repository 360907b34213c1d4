#!/usr/bin/env python3
"""Scans the includes of renderer/ and app/ and fails on one that breaks the layout.

Includes point left only: math <- image <- shading <- scene <- {io, integrator} <- render <- report
<- app; one third-party library stays in one room. Usage: tests/check_includes.py [ROOT]
"""

import re
import sys

from support import whole_tree

LAYERS = {"math": 0, "image": 1, "shading": 2, "scene": 3, "io": 4, "integrator": 4,
          "render": 5, "report": 6}
APP_LAYER = 7

# Library: (what its headers look like, prefixes of the paths that may include it; "" is anywhere).
LIBRARIES = {
    "Embree": (r"embree\d?/|rtcore", ["renderer/scene/accel.cpp"]),
    "tinygltf": (r"tiny_gltf\.h|tinygltf/", ["renderer/io/"]),
    "Draco": (r"draco/", ["renderer/io/"]),
    "meshoptimizer": (r"meshoptimizer", ["renderer/io/"]),
    "OpenEXR": (r"OpenEXR/|Imath/|Imf|Imath|Iex|openexr", ["renderer/image/"]),
    "stb_image": (r"(stb/)?stb_image\.h$", ["renderer/image/", "renderer/io/"]),
    "stb": (r"(stb/)?stb_", ["renderer/image/"]),
    "GLFW, GL, ImGui": (r"GLFW/|GL/|GLES\d?/|EGL/|KHR/|glad/|(backends/)?imgui|ImGui", ["app/viewer/"]),
    "CLI11": (r"CLI/", ["app/batch/"]),
    "nlohmann-json": (r"nlohmann/", ["renderer/io/", "renderer/render/", "renderer/report/",
                                     "renderer/image/", "app/"]),
    "fmt": (r"fmt/", [""]),
    "GLM": (r"glm/", [""]),
    # Not third-party: the C library, POSIX and the compiler's own.
    "system": (r"(sys|linux|asm)/|(dirent|dlfcn|errno|fcntl|fenv|float|inttypes|limits|locale|math|poll|"
               r"pthread|sched|signal|spawn|stdio|stdlib|string|time|unistd|[a-z]mmintrin|"
               r"x86intrin|cpuid)\.h$", [""]),
    "standard library": (r"[a-z_0-9]+$", [""]),
}
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<([^>]+)>|"([^"]+)")')
SOURCES = {".h", ".cpp", ".hpp", ".cc", ".inl", ".c"}


def layer_of(path):
    """Layer of a path written from the root, or None for a file that belongs to no layer."""
    parts = path.split("/")
    if parts[0] == "app":
        return APP_LAYER
    return LAYERS.get(parts[1]) if len(parts) > 2 else None


def resolve(root, path, name):
    """The file that a quoted include in `path` means, written from the root; None: not ours."""
    folder = path.rsplit("/", 1)[0]
    for base in (folder, "renderer", "app"):
        if (root / base / name).is_file():
            return f"{base}/{name}"
    return None


def room_of(path):
    """The folder whose files may include one another; the window's panels share its room."""
    return "app/viewer" if path.startswith("app/viewer/") else path.rsplit("/", 1)[0]


def check_own(path, target, name):
    """What is wrong with `path` including our file `target`, or None."""
    if ".." in name.split("/"):
        return "is written with ..; write it from renderer/"
    source, destination = layer_of(path), layer_of(target)
    same_room = room_of(path) == room_of(target)
    if path.startswith("app/batch/") and target.startswith("app/viewer/"):
        return "takes the window into the program without one"
    if same_room or source > destination:
        return None
    return "does not point left (math <- image <- shading <- scene <- io, integrator <- ...)"


def check_library(path, name):
    """What is wrong with `path` including the library header `name`, or None."""
    for library, (pattern, rooms) in LIBRARIES.items():
        if re.match(pattern, name):
            if any(path.startswith(room) for room in rooms):
                return None
            return f"belongs to {library}, allowed in {' '.join(rooms)} only"
    return "is no file of ours and no library known here (tests/check_includes.py lists them)"


def check_file(root, path):
    text = (root / path).read_text(encoding="utf-8", errors="replace")
    if layer_of(path) is None:
        yield f"{path}: stands in no known folder of renderer/ (tests/check_includes.py lists them)"
        return
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        name = match[1] or match[2]
        target = resolve(root, path, name) if match[2] else None
        wrong = check_own(path, target, name) if target else check_library(path, name)
        if wrong:
            yield f"{path}:{number}: include of {name} {wrong}"


def violations(root):
    """All violations under `root`, one line each."""
    found = []
    for _, path in whole_tree.files(root, ("renderer", "app"), SOURCES):
        found += check_file(root, path)
    return found


if __name__ == "__main__":
    sys.exit(whole_tree.main(__file__, violations, "includes: all point left"))
