#!/usr/bin/env python3
"""What the strategy pyramid costs: samples a second with it closed and open, in turns.

    tests/window/pyramid_cost.py --view build/release/bin/midway-view [--scene S.glb] [--size WxH]
                                 [--rounds N] [--passes N] [--full S,T]

One window, drawn in memory, renders one image all the time; rounds of closed and open alternate, each
of so many whole passes. Prints every round and the median ratio with its 95 % interval (order
statistics). `--full 2,1` keeps that strategy at full size besides.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

ASSETS = Path(__file__).resolve().parents[2] / "assets"


def script(arguments, folder):
    """Lines that open and close the pyramid and report the passes between."""
    lines = [f"open {arguments.scene}", f"set size {arguments.size}", "set technique bdpt",
             "timeout 3600", "wait spp 2"]
    done = 2
    for i in range(arguments.rounds):
        for state in ("off", "on"):
            lines.append(f"set pyramid {state}")
            if state == "on" and arguments.full:
                lines.append(f"set strategies {arguments.full}")
            # The pass that is under way ends as it was begun.
            lines += [f"wait spp {done + 2}", f"report {folder}/{i}-{state}-a.json",
                      f"wait spp {done + 2 + arguments.passes}",
                      f"report {folder}/{i}-{state}-b.json"]
            done += 2 + arguments.passes + 1
    return "\n".join(lines + ["quit", ""])


def rate(folder, i, state):
    a, b = (json.loads((folder / f"{i}-{state}-{k}.json").read_text()) for k in "ab")
    return (b["spp"] - a["spp"]) * a["size"][0] * a["size"][1] / (
        b["seconds_render"] - a["seconds_render"])


def interval(values):
    """95 % interval of the median: the k-th smallest and largest, binomially."""
    values, n = sorted(values), len(values)
    below, k = 0.0, 0
    while k < n // 2:
        below += math.comb(n, k) / 2 ** n
        if below > 0.025:
            break
        k += 1
    k = max(k, 1)
    return values[k - 1], values[n - k]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--view", required=True, type=Path, help="midway-view")
    parser.add_argument("--scene", default=ASSETS / "idol.glb", type=Path)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", default=9, type=int)
    parser.add_argument("--passes", default=3, type=int)
    parser.add_argument("--full")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "script.txt").write_text(script(arguments, folder))
        subprocess.run([arguments.view, "--offscreen", "--window", "1280x720", "--script",
                        folder / "script.txt"], check=True,
                       env=dict(os.environ, XDG_CONFIG_HOME=name))
        ratios = []
        for i in range(arguments.rounds):
            closed, opened = rate(folder, i, "off"), rate(folder, i, "on")
            ratios.append(opened / closed)
            print(f"round {i + 1}: closed {closed:,.0f} open {opened:,.0f} samples/s, "
                  f"ratio {ratios[-1]:.3f}")
        low, high = interval(ratios)
        print(f"median ratio {statistics.median(ratios):.3f}, 95 % from {low:.3f} to {high:.3f}")


if __name__ == "__main__":
    main()
