"""What the checks of the whole tree (check_*.py) share."""

import sys
from pathlib import Path


def files(root, folders, suffixes):
    """(path, path from `root`) of all files of these kinds, in order."""
    for folder in folders:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in suffixes and file.is_file():
                yield file, file.relative_to(root).as_posix()


def main(script, violations, nothing):
    """The exit status of a check that is run by itself: [ROOT] is the tree, or the script's own."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(script).resolve().parent.parent
    found = violations(root)
    print("\n".join(found) if found else nothing)
    return 1 if found else 0
