#!/usr/bin/env python3
"""Reads names of C++ files, one a line, and prints the sources among them and the headers that none of these includes, directly
or not: what a checker has to be given that looks at a source with all it includes.

    git ls-files 'comp/*.[ch]pp' | toolchain/not_included.py
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.MULTILINE)


def included_by(sources):
    """Files of ours, as paths from the root."""
    found, waiting = set(), list(sources)
    while waiting:
        text = (ROOT / waiting.pop()).read_text(encoding="utf-8")
        for name in INCLUDE.findall(text):
            if name not in found and (ROOT / name).is_file():
                found.add(name)
                waiting.append(name)
    return found


def main():
    names = [str(pathlib.Path(line.strip())) for line in sys.stdin if line.strip()]
    sources = [name for name in names if name.endswith(".cpp")]
    found = included_by(sources)
    print("\n".join(sources + [name for name in names if name not in found and name not in sources]))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(__doc__)
        sys.exit(0 if sys.argv[1] in ("-h", "--help") else 2)
    main()
