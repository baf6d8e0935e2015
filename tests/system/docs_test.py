#!/usr/bin/env python3
"""The documentation agrees with the program: the pages it writes are those of this folder, links lead somewhere, every
page is listed and every drawing shown, every command shown exists with the options it is shown with, and wiring is that
of the example.

    docs_test.py VOLCOMP SOURCE_FOLDER
"""
import configparser
import os
import pathlib
import re
import shlex
import subprocess
import sys
from xml.etree import ElementTree

VOLCOMP, ROOT = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
SKIPPED = {"build", "node_modules", ".git"}
failures = []


def check(good, text):
    if not good:
        failures.append(text)


def pages():
    for folder, folders, files in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in SKIPPED]
        yield from (pathlib.Path(folder) / name for name in files if name.endswith(".md"))


def said(*arguments):
    return subprocess.run([VOLCOMP, *arguments], capture_output=True, text=True, check=True).stdout


# --- pages that the program writes

def written_pages():
    for option, name in (("--objects", "object-dictionary.md"), ("--reasons", "reason-codes.md")):
        page = ROOT / "docs" / name
        check(page.read_text(encoding="utf-8") == said("device-files", option, "-"),
              f"{page}: not what the program writes; volcomp device-files {option} docs/{name}")


def covered_indices(page):
    for first, last in re.findall(r"^## ([0-9A-F]{4})h(?: … ([0-9A-F]{4})h)?", page, re.M):
        yield from range(int(first, 16), int(last or first, 16) + 1)


def every_object_is_explained():
    eds = configparser.ConfigParser(strict=False, interpolation=None)
    eds.read(ROOT / "firmware/volcomp.eds")
    wanted = {int(name, 16) for name in eds.sections() if re.fullmatch("[0-9A-F]{4}", name)}
    page = (ROOT / "docs/object-dictionary.md").read_text(encoding="utf-8")
    check(len(wanted) > 100 and wanted <= set(covered_indices(page)),
          f"object-dictionary.md lacks {[f'{i:04X}h' for i in wanted - set(covered_indices(page))]}")
    for section in page.split("\n## ")[1:]:
        heading, _, rest = section.partition("\n\n")
        check(len(rest.split("\n\n|")[0].strip()) > 20, f"object-dictionary.md: no word about {heading}")


def every_code_is_explained():
    page = (ROOT / "docs/reason-codes.md").read_text(encoding="utf-8")
    for kind in page.split("\n## ")[1:]:
        heading, _, rest = kind.partition("\n")
        for entry in re.split(r"\n\n(?=\*\*)", rest)[1:]:
            explained = "*Why:*" in entry and "*What to do:*" in entry
            check(explained or heading == "SDO abort codes", f"reason-codes.md: unexplained: {entry[:60]}")
    reasons = re.findall(r"^(?:REASON|LOADING)\((\d+), ([a-z_]+),", (ROOT / "comp/core/reasons.def").read_text(), re.M)
    for number, reason in reasons:
        check(f"**`{reason}`** ({number}) " in page, f"reason-codes.md lacks {reason}")
    check(len(reasons) > 70, "comp/core/reasons.def was not understood")
    faults = (ROOT / "firmware/README.md").read_text(encoding="utf-8").partition("| EMCY | way back |")[2].partition("\n\n")[0]
    emergencies = [code for row in faults.splitlines()[2:] for code in re.findall("([4-9A-F][0-9A-F]{3})h", row.split("|")[3])]
    for code in emergencies:
        check(f"**{code}h**" in page, f"reason-codes.md lacks {code}h")
    check(len(emergencies) > 15, "the table of faults in firmware/README.md was not understood")


# --- links

def anchors(page):
    for heading in re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.M):
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def links_lead_somewhere():
    for page in pages():
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if "://" in target:
                continue
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            check(file.exists(), f"{page}: {target} leads nowhere")
            if anchor and file.suffix == ".md" and file.exists():
                check(anchor in anchors(file), f"{page}: {target}: there is no such heading")


def everything_is_linked():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for page in (ROOT / "docs").rglob("*.md"):
        name = page.relative_to(ROOT).as_posix()
        check(f"]({name})" in readme, f"README.md does not list {name}")
    shown = "".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs").rglob("*.md"))
    drawings = list((ROOT / "docs/drawings").glob("*.svg"))
    for drawing in drawings:
        try:
            ElementTree.parse(drawing)
        except ElementTree.ParseError as error:
            check(False, f"{drawing}: {error}")
        check(f"drawings/{drawing.name})" in shown, f"{drawing}: no page shows it")
    check(len(drawings) > 10, "the drawings were not found")


# --- commands

def shown_commands():
    for page in pages():
        for block in re.findall(r"^```sh\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S):
            for line in block.replace("\\\n", " ").splitlines():
                for command in re.split(r"&&|\|\|?|;|&", line):
                    yield page, command


def options_of(words, known={}):
    """The options of the longest run of subcommands at the beginning of `words`, and its name."""
    name = []
    for word in words:
        if not re.fullmatch("[a-z0-9-]+", word):
            break
        if tuple(name) not in known:
            known[tuple(name)] = said(*name, "--help")
        listed = known[tuple(name)].partition("Subcommands:")[2]
        if not re.search(rf"^  {re.escape(word)}\s", listed, re.M):
            break
        name.append(word)
    if tuple(name) not in known:
        known[tuple(name)] = said(*name, "--help")
    return name, set(re.findall(r"(?<![\w-])(--[a-z0-9-]+|-[a-zA-Z])(?![\w-])", known[tuple(name)]))


def commands_exist():
    count = 0
    for page, command in shown_commands():
        words = shlex.split(command, comments=True)
        while words and re.fullmatch(r"\w+=\S*", words[0]):
            words.pop(0)
        if not words or pathlib.Path(words[0]).name != "volcomp":
            continue
        count += 1
        name, options = options_of(words[1:])
        check(name, f"{page}: no such subcommand: {command.strip()}")
        for word in words[1:]:
            option = word.partition("=")[0]
            if re.fullmatch(r"--[a-z].*", option):
                check(option in options, f"{page}: volcomp {' '.join(name)} has no {option}: {command.strip()}")
    check(count > 15, f"only {count} commands were found in the pages")


# --- wiring

def wiring_is_that_of_the_example():
    example = (ROOT / "firmware/embed/linuxcnc/volcomp.hal").read_text(encoding="utf-8").splitlines()
    page = (ROOT / "docs/packages.md").read_text(encoding="utf-8")
    shown = re.search(r"^```\n(loadrt volcomp .*?)^```", page, re.M | re.S)
    check(shown, "docs/packages.md: the wiring of LinuxCNC was not found")
    for line in shown.group(1).splitlines() if shown else []:
        check(line in example, f"docs/packages.md: firmware/embed/linuxcnc/volcomp.hal lacks: {line}")
    positions = [line.split()[2] for line in example if "=> volcomp." in line and ".position" in line]
    check(positions == [f"joint.{n}.pos-cmd" for n in range(3)], f"volcomp.hal: compensated at {positions}")


written_pages()
every_object_is_explained()
every_code_is_explained()
links_lead_somewhere()
everything_is_linked()
commands_exist()
wiring_is_that_of_the_example()
for failure in failures:
    print(f"FAILED: {failure}")
sys.exit(1 if failures else 0)
