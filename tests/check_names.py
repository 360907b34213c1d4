#!/usr/bin/env python3
"""No type of the program is defined twice under one name: linked together, the linker would keep the
templates of only one of the two, and say nothing. Usage: tests/check_names.py [ROOT]

Looks at types in namespaces that have names, in all of renderer/ and app/: what stands in an unnamed
namespace, in a function or in another type is nobody else's.
"""

import re
import sys

from check_style import CPP, blank
from support import whole_tree

TYPE = re.compile(r"\b(?:struct|class|enum(?:\s+class)?|union)\s+(\w+)(?:\s+final)?\s*(?::(?!:)[^;(){}]*)?$")
NAMESPACE = re.compile(r"\bnamespace(?:\s+([\w:]+))?\s*$")


def types_of(code):
    """(line, name with its namespaces) of each type that other files could see. `code` is blanked."""
    stack = []  # one entry per open brace: the namespace's name, or None for all else
    start = 0
    for match in re.finditer(r"[{};]", code):
        lead = code[start:match.start()].rstrip()
        start = match.end()
        if match[0] == "}" and stack:
            stack.pop()
        elif match[0] == "{":
            found = TYPE.search(lead)
            if found and None not in stack:
                line = code.count("\n", 0, match.start()) + 1
                yield line, "::".join([*stack, found[1]])
            named = NAMESPACE.search(lead)
            stack.append(named[1] if named else None)


def violations(root):
    found, first = [], {}
    for file, path in whole_tree.files(root, ("renderer", "app"), CPP):
        for line, name in types_of(blank(file.read_text(encoding="utf-8"))):
            place = first.setdefault(name, path)
            if place != path:
                found.append(f"{path}:{line}: {name} is defined in {place} too; rename one")
    return found


if __name__ == "__main__":
    sys.exit(whole_tree.main(__file__, violations, "names: nothing to say"))
