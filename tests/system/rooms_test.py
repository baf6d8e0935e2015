#!/usr/bin/env python3
"""The pages of the checkout are in order, without a build: every relative link leads to a file of the repository; every room has
a README of one page with the five headings, whose "May use" is the line of toolchain/arrows.py; README.md is short, leads to every
room, and quotes docs/evidence.md; the five answers of docs/architecture.md are found in three steps; the reader of
docs/image-format.md reads an image.

    rooms_test.py SOURCE_FOLDER   the checkout
    rooms_test.py --self-test     proves that planted faults are found
"""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HEADINGS = ["For", "In and out", "Read in this order", "May use", "Costs"]
LONGEST_ROOM, LONGEST_README, MOST_TO_READ = 40, 130, 5
HOST = "host_sim/host"
ROOMS = ["comp", "comp/core", "comp/machine", "comp/tables", "comp/tick", "comp/probe", "comp/strokes", "comp/metrology", "hal",
         "firmware/canopen", "firmware/node", "firmware/embed", "firmware/boards", "firmware/posix", "host_sim", HOST, f"{HOST}/io",
         f"{HOST}/report", f"{HOST}/machine", f"{HOST}/bus", f"{HOST}/tables", f"{HOST}/measure", "host_sim/sim",
         "host_sim/experiments", "host_sim/cli", "tests", "toolchain"]
WITHOUT_RULE = {"tests", "toolchain"}
# What README.md quotes: row of its table, rows of docs/evidence.md and what stands in their column for the Cortex-M7.
QUOTED = [("instructions of a tick", {"XYFZ, compiled in: everyday, nothing limited": r"^[\d ]+ … (?P<everyday>[\d ]+)$",
                                      "XYFZ, compiled in: anything": r"^[\d ]+ … (?P<largest>[\d ]+)$"},
           "everyday {everyday} at most, {largest} in the worst case"),
          ("stack of a tick", {"stack, bytes: proven / seen": r"^(?P<proven>\d+) /"}, "{proven} bytes"),
          ("flash of the CANopen node", {"node: flash, bytes": r"^(?P<flash>[\d ]+)$"}, "{flash} bytes")]
LINK = re.compile(r"\]\(([^)\s]+)\)")


class Checkout:
    def __init__(self, root, rule):
        self.root, self.rule, self.failures = root, rule, []

    def check(self, good, text):
        if not good:
            self.failures.append(text)

    def text(self, name):
        path = self.root / name
        if not path.is_file():
            self.check(False, f"{name} is missing")
            return ""
        return path.read_text(encoding="utf-8")

    # --- links

    def pages(self):
        for folder, folders, files in os.walk(self.root):
            folders[:] = [name for name in folders if name not in {"build", "node_modules", ".git"}]
            yield from (pathlib.Path(folder, name) for name in files if name.endswith(".md"))

    def links(self, page):
        """(target as written, path in the repository) of every relative link of a page."""
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for target in LINK.findall(text):
            if "://" not in target and not target.startswith(("#", "mailto:")):
                yield target, (page.parent / target.partition("#")[0]).resolve()

    def links_exist(self):
        for page in self.pages():
            for target, file in self.links(page):
                name = page.relative_to(self.root)
                self.check(file.exists(), f"{name}: {target} leads nowhere")
                self.check(self.root in [file, *file.parents], f"{name}: {target} leads out of the repository")

    # --- rooms

    def may_use(self, room):
        """What the lines of `room`, or of the rooms in it, name outside of it."""
        found = set()
        for line in self.rule.strip().splitlines():
            rooms, _, named = line.partition(":")
            if any(f"{name}/".startswith(f"{room}/") for name in rooms.split()):
                found.update(name for name in named.split() if not f"{name}/".startswith(f"{room}/"))
        return found

    def room(self, room):
        name = f"{room}/README.md"
        page = self.text(name)
        lines = page.splitlines()
        self.check(len(lines) <= LONGEST_ROOM, f"{name} has {len(lines)} lines; a room has at most {LONGEST_ROOM}")
        headings = re.findall(r"^#{1,6} (.*)$", page, re.M)
        self.check(headings == [room, *HEADINGS], f"{name}: the headings are {headings}")
        sections = {part.partition("\n")[0]: part.partition("\n")[2].strip() for part in page.split("\n## ")[1:]}
        for heading in HEADINGS:
            self.check(sections.get(heading), f"{name}: nothing below \"{heading}\"")
        order = LINK.findall(sections.get("Read in this order", ""))
        self.check(1 <= len(order) <= MOST_TO_READ, f"{name}: {len(order)} files to read; at most {MOST_TO_READ}")
        if room not in WITHOUT_RULE:
            told = set(re.findall(r"`((?:comp|hal|firmware|host_sim)(?:/[\w/]+)?)`", sections.get("May use", "")))
            wanted = self.may_use(room)
            self.check(told == wanted, f"{name}: may use {sorted(told)}; toolchain/arrows.py says {sorted(wanted)}")
        evidence = self.text("docs/evidence.md")
        for figure in re.findall(r"(?<![\w.])(?:\d{1,3}(?: \d{3})+|\d{3,})(?![\w.])", sections.get("Costs", "")):
            self.check(re.search(rf"(?<!\d){figure}(?!\d)", evidence), f"{name}: docs/evidence.md has no {figure}")

    def rooms(self):
        for room in ROOMS:
            self.room(room)
        known = {folder for line in self.rule.strip().splitlines() for folder in line.partition(":")[0].split()}
        for room in known:
            self.check(any(f"{room}/".startswith(f"{own}/") for own in ROOMS), f"{room} belongs to no README")

    # --- README.md

    def readme(self):
        page = self.text("README.md")
        self.check(len(page.splitlines()) <= LONGEST_README, f"README.md has {len(page.splitlines())} lines; at most {LONGEST_README}")
        for room in ROOMS:
            self.check(f"]({room}/README.md)" in page, f"README.md does not lead to {room}/README.md")
        evidence = self.text("docs/evidence.md")
        for quoted, sources, form in QUOTED:
            figures = {}
            for row, pattern in sources.items():
                cells = re.search(rf"^\| {re.escape(row)} \| \**([^|*]+?)\** \|", evidence, re.M)
                value = cells and re.match(pattern, cells.group(1))
                self.check(value, f"docs/evidence.md has no row \"{row}\" that README.md could quote")
                figures |= value.groupdict() if value else {}
            if len(figures) < len(sources):
                continue
            wanted = form.format(**figures)
            self.check(re.search(rf"^\| {quoted}[^|]*\| {re.escape(wanted)} \|", page, re.M),
                       f"README.md does not say \"{wanted}\" in its row \"{quoted} …\", as docs/evidence.md does")

    def answers(self):
        """README.md → README of the room → file."""
        section = self.text("docs/architecture.md").partition("## Five answers")[2].partition("\n## ")[0]
        rows = [row.split("|") for row in section.splitlines() if row.startswith("| ") and "](" in row]
        self.check(len(rows) == 5, f"docs/architecture.md gives {len(rows)} answers instead of five")
        for row in rows:
            room, file = ((self.root / "docs" / LINK.search(cell).group(1)).resolve() for cell in row[2:4])
            self.check(room in [path for _, path in self.links(self.root / "README.md")], f"README.md does not lead to {room}")
            self.check(room.is_file() and file in [path for _, path in self.links(room)], f"{room} does not lead to {file}")

    def image_reader(self):
        """The program of docs/image-format.md reads an image."""
        sample = re.search(r"^```python\n(.*?)^```", self.text("docs/image-format.md"), re.M | re.S)
        image = self.root / "firmware/embed/cpp/xyfz.vct"
        run = subprocess.run([sys.executable, "-c", sample.group(1) if sample else "", image], capture_output=True, text=True, check=False)
        axes = [line.split()[0] for line in run.stdout.splitlines()]
        self.check(axes == ["X", "Y", "Z"], f"docs/image-format.md: its reader finds the axes {axes} {run.stderr.strip()[-200:]}")

    def judge(self):
        self.links_exist()
        self.image_reader()
        self.rooms()
        self.readme()
        self.answers()
        return self.failures


def rule_of(root):
    spec = importlib.util.spec_from_file_location("arrows", root / "toolchain/arrows.py")
    arrows = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(arrows)
    return arrows.RULE


def self_test(root):
    """The pages of this checkout, each fault planted in a copy of them."""
    planted = [
        ("README.md", "(docs/porting.md)", "(docs/sporting.md)", "leads nowhere"),
        ("docs/evidence.md", "\n", "\n[up](../../x)\n", "leads out of the repository"),
        ("README.md", "# volcomp\n", "# volcomp\n" + "\n" * 130, "lines; at most 130"),
        ("README.md", "(hal/README.md)", "(hal)", "does not lead to hal/README.md"),
        ("README.md", " at most, ", "0 at most, ", "does not say"),
        ("docs/evidence.md", "| node: flash, bytes | ", "| node: flash, bytes | 9", "does not say"),
        ("hal/README.md", "## Costs", "## Prices", "the headings are"),
        ("hal/README.md", "`comp/core`", "`comp/core` `comp/tick`", "toolchain/arrows.py says"),
        ("hal/README.md", "\n## Costs", "\n" * 40 + "## Costs", "a room has at most 40"),
        ("comp/tick/README.md", "## Costs\n", "## Costs\n\n98 765 instructions\n", "has no 98 765"),
        ("comp/tick/README.md", "(compensator_tick.inl)", "(limiter.hpp)", "does not lead to"),
        ("docs/image-format.md", "at += 54 ", "at += 52 ", "its reader finds"),
    ]
    names = [file.relative_to(root) for top in os.scandir(root) if top.name not in {"build", ".git"}
             for file in ([pathlib.Path(top)] if top.is_file() else pathlib.Path(top).rglob("*"))
             if file.is_file() and "node_modules" not in file.parts]
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder).resolve() / "checkout"
        for name in names:
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            (copy / name).write_bytes((root / name).read_bytes() if name.suffix in {".md", ".vct"} else b"")
        for name, old, new, wanted in planted:
            page = copy / name
            text = page.read_text(encoding="utf-8")
            page.write_text(text.replace(old, new, 1), encoding="utf-8")
            found = Checkout(copy, rule_of(root)).judge()
            page.write_text(text, encoding="utf-8")
            if old not in text or not any(wanted in failure for failure in found):
                wrong.append(f"planted in {name}: \"{wanted}\" was not found, but {found}")
        wrong += Checkout(copy, rule_of(root)).judge()
    print(f"self-test: {len(planted)} planted faults")
    return wrong


def main(arguments):
    if len(arguments) != 1:
        print(__doc__)
        return 2
    here = pathlib.Path(__file__).resolve().parent.parent.parent
    root = here if arguments[0] == "--self-test" else pathlib.Path(arguments[0]).resolve()
    failures = self_test(root) if arguments[0] == "--self-test" else Checkout(root, rule_of(root)).judge()
    for failure in failures:
        print(f"FAILED: {failure}")
    return 1 if failures else 0


sys.exit(main(sys.argv[1:]))
