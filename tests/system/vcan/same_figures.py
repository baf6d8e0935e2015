"""Compares two files of figures written by volcomp run --json.

    same_figures.py FIRST SECOND TOLERANCE

Ends with 1 unless both hold the same figures, each equal within the tolerance (in the unit of the figure: um, mm or
per cent). Text and whole numbers, which name the way and the files, are left out.
"""

import json
import sys


def figures(node, path=""):
    if isinstance(node, dict):
        for key, value in node.items():
            yield from figures(value, f"{path}/{key}")
    elif isinstance(node, list):
        for number, value in enumerate(node):
            yield from figures(value, f"{path}/{number}")
    elif isinstance(node, float):
        yield path, node


def main():
    tolerance = float(sys.argv[3])
    first, second = (dict(figures(json.load(open(name)))) for name in sys.argv[1:3])
    assert first and first.keys() == second.keys(), "other figures"
    worst = max(first, key=lambda key: abs(first[key] - second[key]))
    difference = abs(first[worst] - second[worst])
    print(f"{len(first)} figures, largest difference {difference} at {worst}")
    sys.exit(difference > tolerance)


main()
