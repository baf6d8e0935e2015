"""Where the sections of firmware/boards/mps2/tightly_coupled.ld land: every function that a tick reaches, its slow path included, lies in
.itcm and refers to nothing outside .itcm and .dtcm; the compensator lies in .dtcm; both lie in their regions. The default image has neither.

    tightly_coupled_test.py IMAGE DEFAULT_IMAGE   IMAGE linked with --emit-relocs
"""
import pathlib
import re
import sys

from elftools.elf.elffile import ELFFile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "toolchain/evidence"))
import call_graph  # noqa: E402
import elf  # noqa: E402

TICK = re.compile(r"volcomp::Compensator<.*>::tick\(.*")
OBJECT = re.compile(r"^_ZZ.*(the_example|the_task)$")  # that the compensator is part of
SCRIPT = ROOT / "firmware/boards/mps2/m7_tightly_coupled.ld"
REGION = re.compile(r"^  (\w+) +\(\w+\) *: ORIGIN = (\w+), LENGTH = (\d+)K", re.M)
# Sizes as docs/porting.md states them: a loaded machine takes more code, five axes of 128 knots more data.
MOST_CODE, LEAST_DATA = 20 * 1024, 16 * 1024


def regions():
    return {name: range(int(begin, 0), int(begin, 0) + 1024 * int(size)) for name, begin, size in REGION.findall(SCRIPT.read_text())}


def within(inner, outer):
    return inner.start >= outer.start and inner.stop <= outer.stop


def extent(image, name):
    """Addresses of a section; empty where the image has none."""
    section = next((s for s in image.sections if s.name == name), None)
    return range(section.address, section.address + section.size) if section else range(0)


def reached(image):
    """Functions that a tick may call, directly or not, and those of them that call through a pointer."""
    graph = call_graph.CallGraph(image)
    functions = graph.reached(image.find(TICK), lambda function: False)
    return functions, functions & graph.through_pointers


def referred_outside(image, functions, allowed):
    """(function, symbol) of every relocation within the functions that leads to another section. None: there are no relocations."""
    found = set()
    with image.path.open("rb") as stream:
        file = ELFFile(stream)
        table = file.get_section_by_name(".rel.itcm")
        if table is None:
            return None
        symbols = file.get_section(table["sh_link"])
        for relocation in table.iter_relocations():
            function = image.function_at(relocation["r_offset"])
            symbol = symbols.get_symbol(relocation["r_info_sym"])
            index = symbol["st_shndx"]
            section = file.get_section(index).name if isinstance(index, int) else str(index)
            if function in functions and section not in allowed:
                found.add((image.plain(function), f"{symbol.name} in {section}"))
    return sorted(found)


def place_of_load(path, code):
    """Where the start finds what it copies to .itcm; −1: nowhere."""
    with path.open("rb") as stream:
        segments = [s for s in ELFFile(stream).iter_segments("PT_LOAD") if len(code) and s["p_vaddr"] == code.start]
        return segments[0]["p_paddr"] if segments else -1


def problems_of(path, region):
    image = elf.Image(path)
    code, data = extent(image, ".itcm"), extent(image, ".dtcm")
    found = []
    for name, place, memory in ((".itcm", code, "ITCM"), (".dtcm", data, "DTCM")):
        if not place or not within(place, region[memory]):
            found.append(f"{name} does not lie in {memory}")
    functions, pointers = reached(image)
    found += [] if functions else ["there is no tick"]
    found += [f"the tick reaches outside of .itcm: {image.plain(f)}" for f in functions if f.address not in code]
    found += [f"the tick calls through a pointer: {image.plain(f)}" for f in pointers]
    compensator = [s for s in image.symbols if OBJECT.search(s.name) and s.kind == "STT_OBJECT"]
    found += [] if compensator and all(s.address in data for s in compensator) else ["the compensator does not lie in .dtcm"]
    if place_of_load(path, code) not in region["FLASH"]:
        found.append(".itcm is not loaded from FLASH")
    if len(code) > MOST_CODE or len(data) < LEAST_DATA:
        found.append(f".itcm has {len(code)} bytes, .dtcm {len(data)}")
    return found


def main(path, default):
    region = regions()
    failures = problems_of(path, region)
    image = elf.Image(path)
    foreign = referred_outside(image, reached(image)[0], {".itcm", ".dtcm"})
    failures += ["there are no relocations of .itcm"] if foreign is None else [f"{function} refers to {what}" for function, what in foreign]
    # The same check finds that a default image has nothing there.
    refused = problems_of(default, region)
    for wanted in (".itcm does not lie in ITCM", "the compensator does not lie in .dtcm", "the tick reaches outside of .itcm"):
        if not any(problem.startswith(wanted) for problem in refused):
            failures.append(f"the check does not see in {default.name} that {wanted}")
    for failure in failures:
        print(f"FAILED: {failure}")
    print(f".itcm {len(extent(image, '.itcm'))} bytes, .dtcm {len(extent(image, '.dtcm'))} bytes")
    return 1 if failures else 0


sys.exit(main(*map(pathlib.Path, sys.argv[1:])))
