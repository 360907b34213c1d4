#!/usr/bin/env python3
"""Tests of the window: tests/window/run_tests.py --view PATH --midway PATH [--slow FACTOR] [-k PATTERN]

Offscreen with scripts, and in a display in memory (Xvfb) with real mouse and key events (xdotool);
the latter skip where these are missing. Needs nothing but Python's standard library. The last line
printed counts the cases.
"""

import argparse
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent / "cli")]

import window_test  # noqa: E402
from support import counted  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--view", required=True, type=Path, help="midway-view")
    parser.add_argument("--midway", required=True, type=Path, help="midway")
    parser.add_argument("--slow", type=float, default=1.0, help="factor on every time limit")
    parser.add_argument("--keep", type=Path, help="folder for the screenshots of each step")
    parser.add_argument("-k", dest="pattern", action="append", help="only cases that match")
    parser.add_argument("-v", dest="verbosity", action="store_const", const=2, default=1)
    arguments = parser.parse_args()
    window_test.view = arguments.view.resolve()
    window_test.midway = arguments.midway.resolve()
    window_test.slow = arguments.slow
    window_test.pictures = arguments.keep
    if not window_test.view.is_file():
        print(f"skipped: this build has no window ({window_test.view})")
        print("0 passed, 0 failed, 1 skipped")
        return 0
    loader = unittest.TestLoader()
    if arguments.pattern:
        loader.testNamePatterns = [f"*{pattern}*" for pattern in arguments.pattern]
    return counted.run(loader.discover(str(HERE), "test_*.py"), arguments.verbosity)


if __name__ == "__main__":
    sys.exit(main())
