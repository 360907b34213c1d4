#!/usr/bin/env python3
"""House rules that a program can see; fails on a violation. Usage: tests/check_style.py [ROOT]

Files of at most 400 lines, functions of at most 60 in renderer/ and app/, no inheritance and no
printing in renderer/, no promises for later in comments, no small absolute numbers in geometry
(absolute_literals.py).
"""

import re
import sys
from pathlib import Path

from absolute_literals import absolute_literals, stale_reasons
from support import whole_tree

MAX_FILE_LINES = 400
MAX_FUNCTION_LINES = 60  # between its braces
SOURCES = {".h", ".cpp", ".glsl", ".vert", ".frag", ".py", ".sh"}
CPP = {".h", ".cpp"}
PROMISE = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b|not (yet )?implem" r"ented")
PRINTING = re.compile(r"\bstd::(cout|cerr|clog)\b|(?<![\w.])(std::)?(f?printf|puts)\s*\(|fmt::print\b")
# A class with bases; OpenEXR's streams can only be had by inheriting from them.
BASES = re.compile(r"(?<!enum )\b(?:class|struct)\s+\w+(?:\s+final)?\s*:(?!:)\s*([^{;]*)\{")
LIBRARY_BASE = re.compile(r"\s*public\s+(Imf|OPENEXR_IMF_NAMESPACE)::\w+\s*$")
NOT_A_FUNCTION = re.compile(r"(^|[\s;])(namespace|struct|class|union|enum|extern)\b[^()]*$|=\s*$")
TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<d>[^\s()\\]{0,16})\(.*?\)(?P=d)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'", re.S)


def blank(text):
    """The text with comments and literals blanked, every line kept where it was."""
    return TOKEN.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)


def long_functions(code):
    """(line, length) of each outermost function whose body is too long. `code` is blanked."""
    code = re.sub(r"(?m)^\s*#.*?(?<!\\)$", lambda m: " " * len(m[0]), code)
    stack = []  # one entry per open brace: line of the brace where it opens a function, else 0
    start = 0   # where the text that leads up to the next brace begins
    for match in re.finditer(r"[{};]", code):
        lead = code[start:match.start()]
        start = match.end()
        line = code.count("\n", 0, match.start()) + 1
        if match[0] == "{":
            inside = any(stack)
            function = ")" in lead and not NOT_A_FUNCTION.search(lead.rstrip())
            stack.append(line if function and not inside else 0)
        elif match[0] == "}" and stack:
            opened = stack.pop()
            if opened and line - opened - 1 > MAX_FUNCTION_LINES:
                yield opened, line - opened - 1


def check_renderer(path, code):
    for match in BASES.finditer(code):
        if not LIBRARY_BASE.match(match[1]):
            line = code.count("\n", 0, match.start()) + 1
            yield f"{path}:{line}: inheritance in renderer/; use std::variant or a tagged struct"
    for number, line in enumerate(code.splitlines(), 1):
        if PRINTING.search(line):
            yield f"{path}:{number}: printing in renderer/; return the text or throw"


def check_file(root, path):
    text = (root / path).read_text(encoding="utf-8", errors="replace")
    lines = text.splitlines()
    if len(lines) > MAX_FILE_LINES:
        yield f"{path}: {len(lines)} lines (at most {MAX_FILE_LINES}); part it by idea"
    for number, line in enumerate(lines, 1):
        if PROMISE.search(line):
            yield f"{path}:{number}: promises something for later; do it or leave it out"
    if Path(path).suffix not in CPP:
        return
    code = blank(text)
    if not path.startswith("tests/"):
        for line, length in long_functions(code):
            yield f"{path}:{line}: a function of {length} lines (at most {MAX_FUNCTION_LINES})"
    if path.startswith("renderer/"):
        yield from check_renderer(path, code)
        yield from absolute_literals(path, code)


def violations(root):
    """All violations under `root`, one line each."""
    found = []
    for _, path in whole_tree.files(root, ("renderer", "app", "shaders", "assets", "tests"), SOURCES):
        found += check_file(root, path)
    return found + list(stale_reasons(root))


if __name__ == "__main__":
    sys.exit(whole_tree.main(__file__, violations, "style: nothing to say"))
