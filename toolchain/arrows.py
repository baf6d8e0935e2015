#!/usr/bin/env python3
"""Checks over the includes that each room uses only the rooms below it and that no rooms include each other in a circle.

    toolchain/arrows.py              the checkout
    toolchain/arrows.py --self-test  proves that an include against the order and a circle are found

A room is a folder of RULE together with the folders inside it that have no line of their own. It may include the rooms its
line names, all rooms inside a named folder, and what those may include. A test may also include what simulates its other
end, but nothing that stands above it: OF_TESTS. Prints each include against the order and the first
circle; exit code 1 if there is one, 2 if the rule itself is wrong. The check reads includes only: that a library links
without the others is proven by linking it (tests/host_sim/host/alone).
"""
import pathlib
import re
import sys
import tempfile

RULE = """
comp/core:
comp/machine:              comp/core
comp/tables:               comp/machine
comp/tick:                 comp/tables
comp/probe comp/strokes:   comp/tick
comp/metrology/statistics comp/metrology/tables: comp/probe comp/strokes
comp/metrology/fits:       comp/metrology/tables
comp/metrology/circles comp/metrology/gears comp/metrology/faces: comp/metrology/fits
hal:                       comp/core
firmware/canopen:          hal
firmware/node:             firmware/canopen comp/probe comp/strokes
firmware/embed:            hal comp/probe comp/strokes
firmware/boards firmware/posix: firmware/node firmware/embed
host_sim/host/io:          comp/metrology
host_sim/host/report:      host_sim/host/io
host_sim/host/machine:     host_sim/host/report firmware/node
host_sim/host/bus:         host_sim/host/machine
host_sim/host/tables:      host_sim/host/bus
host_sim/host/measure:     host_sim/host/tables
host_sim/sim/truth host_sim/sim/artefacts host_sim/sim/drives host_sim/sim/boards: host_sim/host
host_sim/sim/instruments:  host_sim/sim/artefacts host_sim/sim/truth
host_sim/sim/controller:   host_sim/sim/drives host_sim/sim/instruments firmware/embed
host_sim/sim/campaign host_sim/sim/live: host_sim/sim/controller
host_sim/experiments/any_machine host_sim/experiments/xyfz host_sim/experiments/l300g: host_sim/sim/campaign
host_sim/experiments/face_gear host_sim/experiments/internal_helical: host_sim/sim/campaign
host_sim/experiments/reversal: host_sim/sim/campaign
host_sim/experiments/self_calibration: host_sim/experiments/any_machine
host_sim/cli:              host_sim/experiments host_sim/sim
"""
# Folder of tests -> what its files must not include.
OF_TESTS = {
    "tests/comp": ("hal", "firmware/node", "firmware/boards", "host_sim"),
    "tests/hal": ("firmware/node", "host_sim"),
    "tests/firmware": ("host_sim",),
    "tests/host_sim/host": ("host_sim/experiments", "host_sim/cli"),
    "tests/host_sim/sim": ("host_sim/experiments", "host_sim/cli"),
}
WINGS = ("comp", "hal", "firmware", "host_sim")
SUFFIXES = (".cpp", ".hpp", ".inl", ".h", ".c")
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]((?:comp|hal|firmware|host_sim|tests)/[^">]+)[">]')


class WrongRule(Exception):
    """One sentence about RULE."""


def read_rule(text):
    """Room -> all rooms it may include, itself among them."""
    named = {}
    for line in text.strip().splitlines():
        rooms, _, below = line.partition(":")
        named.update({room: below.split() for room in rooms.split()})

    def rooms_in(folder):
        found = [room for room in named if f"{room}/".startswith(f"{folder}/")]
        if not found:
            raise WrongRule(f'the rule names "{folder}", which is no room.')
        return found

    reach = {}
    for room in named:  # a line names only rooms of the lines before it
        below = [other for folder in named[room] for other in rooms_in(folder)]
        for other in below:
            if other not in reach:
                raise WrongRule(f'the line of "{room}" names "{other}", whose own line does not stand above it.')
        reach[room] = {room}.union(*(reach[other] for other in below))
    return reach


def find_circle(uses):
    """Rooms that include each other, the first one again at the end; None without a circle."""
    open_rooms = {room: set(others) for room, others in uses.items()}
    while True:
        done = [room for room, others in open_rooms.items() if not others & open_rooms.keys()]
        if not done:
            break
        for room in done:
            del open_rooms[room]
    if not open_rooms:
        return None
    way = [min(open_rooms)]
    while True:
        following = min(open_rooms[way[-1]] & open_rooms.keys())
        if following in way:
            return [*way[way.index(following):], following]
        way.append(following)


def check(root, allowed):
    """(sentences about includes against the order, circle or None, number of files)."""
    uses, offences, files = {}, [], 0

    def room_of(path):
        return max((room for room in allowed if path.startswith(room + "/")), key=len, default=path.split("/")[0])

    for file in sorted(file for wing in WINGS for file in (root / wing).rglob("*.*") if file.suffix in SUFFIXES):
        name = str(file.relative_to(root))
        if "/node_modules/" in name:
            continue
        files += 1
        room = room_of(name)
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match or (target := room_of(match[1])) == room:
                continue
            uses.setdefault(room, set()).add(target)
            if target not in allowed.get(room, ()):
                offences.append(f"{name}:{number}: {room} must not include {target}: {match[1]}")
    return offences, find_circle(uses), files


def check_tests(root):
    """Sentences about includes of tests."""
    offences = []
    for folder, above in OF_TESTS.items():
        for file in sorted(file for file in (root / folder).rglob("*.*") if file.suffix in SUFFIXES):
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                match = INCLUDE.match(line)
                if match and match[1].startswith(tuple(f"{other}/" for other in above)):
                    offences.append(f"{file.relative_to(root)}:{number}: {folder} must not include {match[1]}")
    return offences


def self_test():
    allowed = read_rule("comp/core:\ncomp/tick: comp/core\ncomp/metrology: comp/tick\n")
    tree = {"comp/core/units.hpp": "", "comp/tick/tick.cpp": '#include "comp/core/units.hpp"\n',
            "comp/metrology/fit.hpp": "#include <comp/tick/tick.cpp>\n"}
    planted = [
        ({}, False, False),
        ({"comp/tick/tick.hpp": '#pragma once\n#include "comp/metrology/fit.hpp"\n'}, True, True),
        ({"comp/tick/tick.hpp": '# include "tests/oracle/oracle.hpp"\n'}, True, False),
        ({"comp/attic/old.cpp": '#include "comp/core/units.hpp"\n'}, True, False),
        ({"comp/core/units.hpp": '#include "comp/tick/tick.cpp"\n'}, True, True),
        ({"tests/host_sim/host/io/test.cpp": '#include "host_sim/experiments/xyfz/truth.hpp"\n'}, True, False),
        ({"tests/host_sim/host/io/test.cpp": '#include "host_sim/sim/truth/noise.hpp"\n'}, False, False),
    ]
    for files, wants_offence, wants_circle in planted:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {**tree, **files}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            offences, circle, _ = check(root, allowed)
            offences += check_tests(root)
            if bool(offences) != wants_offence or bool(circle) != wants_circle:
                raise WrongRule(f"self-test: {files or 'a tree in order'} was judged wrongly: {offences}, {circle}.")
    for rule in ("comp/tick: comp/cellar", "comp/tick: comp/core\ncomp/core:"):
        try:
            read_rule(rule)
        except WrongRule:
            continue
        raise WrongRule(f"self-test: the rule {rule!r} was accepted.")
    print(f"self-test: {len(planted)} small trees judged rightly")


def main(arguments):
    if arguments == ["--self-test"]:
        self_test()
        return 0
    if arguments:
        print(__doc__)
        return 0 if arguments in (["-h"], ["--help"]) else 2
    root = pathlib.Path(__file__).resolve().parent.parent
    offences, circle, files = check(root, read_rule(RULE))
    offences += check_tests(root)
    for offence in offences:
        print(offence)
    if circle:
        print("a circle: " + " includes ".join(circle))
    print(f"{files} files, {len(offences)} includes against the order of the rooms, {'a' if circle else 'no'} circle")
    return 1 if offences or circle else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except WrongRule as problem:
        print(f"arrows: {problem}", file=sys.stderr)
        sys.exit(2)
