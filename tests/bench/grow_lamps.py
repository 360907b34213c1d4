#!/usr/bin/env python3
"""Hangs copies of the lamps of a scene under its ceiling until so many nodes shine: what do many
lamps cost, and what does the tree over them save? With --one, a single lamp shines among the same
geometry.

    grow_lamps.py ../../assets/lanterns.glb many.glb 5260 [--one]
"""

import argparse
import copy
import json
import random
import struct

DARK = {"name": "dark"}


def read_glb(path):
    data = open(path, "rb").read()
    size, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + size]), data[20 + size:]


def write_glb(path, scene, rest):
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as out:
        out.write(b"glTF" + struct.pack("<III", 2, 20 + len(text) + len(rest), len(text)))
        out.write(b"JSON" + text + rest)


def shines(scene, mesh):
    materials = [scene["materials"][p["material"]] for p in scene["meshes"][mesh]["primitives"]]
    return any(any(m.get("emissiveFactor", [0])) for m in materials)


def triangles(scene, mesh):
    primitives = scene["meshes"][mesh]["primitives"]
    return sum(scene["accessors"][p["indices"]]["count"] // 3 for p in primitives)


def hang_copies(scene, count):
    """A quarter of the size, anywhere in the upper third of the courtyard."""
    place = random.Random(5)
    nodes = scene["nodes"]
    lamps = [n for n in nodes if "mesh" in n and shines(scene, n["mesh"])]
    small = [n for n in lamps if triangles(scene, n["mesh"]) <= 20]
    roots = scene["scenes"][scene.get("scene", 0)]["nodes"]
    for _ in range(count - len(lamps)):
        node = copy.deepcopy(place.choice(small))
        node["name"] = "copy"
        at = [place.uniform(-3.4, 3.4), place.uniform(2.1, 3.2), place.uniform(-5.8, 2)]
        if "matrix" in node:
            node["matrix"][:12] = [x * 0.25 if i % 4 < 3 else x
                                   for i, x in enumerate(node["matrix"][:12])]
            node["matrix"][12:15] = at
        else:
            node["translation"] = at
            node["scale"] = [x * 0.25 for x in node.get("scale", [1, 1, 1])]
        nodes.append(node)
        roots.append(len(nodes) - 1)


def leave_one(scene):
    """The first lamp keeps its light; the others stay where they are, dark."""
    scene["materials"].append(DARK)
    dark = {}
    lamps = [n for n in scene["nodes"] if "mesh" in n and shines(scene, n["mesh"])]
    for node in lamps[1:]:
        if node["mesh"] not in dark:
            mesh = copy.deepcopy(scene["meshes"][node["mesh"]])
            for primitive in mesh["primitives"]:
                primitive["material"] = len(scene["materials"]) - 1
            dark[node["mesh"]] = len(scene["meshes"])
            scene["meshes"].append(mesh)
        node["mesh"] = dark[node["mesh"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source")
    parser.add_argument("out")
    parser.add_argument("count", type=int)
    parser.add_argument("--one", action="store_true")
    options = parser.parse_args()
    scene, rest = read_glb(options.source)
    hang_copies(scene, options.count)
    if options.one:
        leave_one(scene)
    write_glb(options.out, scene, rest)


if __name__ == "__main__":
    main()
