#!/usr/bin/env python3
"""Tests of the command line: tests/cli/run_tests.py --midway PATH [--slow FACTOR] [-k PATTERN]

Needs nothing but Python's standard library. Each test_*.py beside this file holds cases; the last
line printed counts them.
"""

import argparse
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import harness  # noqa: E402
from support import counted  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--midway", required=True, type=Path, help="the program to test")
    parser.add_argument("--slow", type=float, default=1.0, help="factor on every time limit")
    parser.add_argument("-k", dest="pattern", action="append", help="only cases that match")
    parser.add_argument("-v", dest="verbosity", action="store_const", const=2, default=1)
    arguments = parser.parse_args()
    harness.program = arguments.midway.resolve()
    harness.slow = arguments.slow
    if not harness.program.is_file():
        print(f"no program ({harness.program}); build it with app/run")
        print("0 passed, 1 failed, 0 skipped")
        return 1
    loader = unittest.TestLoader()
    if arguments.pattern:
        loader.testNamePatterns = [f"*{pattern}*" for pattern in arguments.pattern]
    return counted.run(loader.discover(str(HERE), "test_*.py"), arguments.verbosity)


if __name__ == "__main__":
    sys.exit(main())
