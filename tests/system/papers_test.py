#!/usr/bin/env python3
"""The pages about the papers say what happens: every command ends as its comment says (0, or 1 where it says "ends with 1"),
and every figure with decimals that a page gives as ours is in what its commands print.

    papers_test.py VOLCOMP SOURCE_FOLDER [PAGE…]
"""
import pathlib
import re
import subprocess
import sys
import tempfile

VOLCOMP, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
AS_SHOWN = "build/host/host_sim/volcomp"
failures = []


def check(good, text):
    if not good:
        failures.append(text)


def commands_of(page):
    for block in re.findall(r"^```sh\n(.*?)^```", page, re.M | re.S):
        for line in block.replace("\\\n", " ").splitlines():
            command, _, comment = line.partition(" #")
            yield command.strip(), 1 if "ends with 1" in comment else 0


# Only the section with the commands quotes figures of ours; what the paper says is in columns that name it.
def our_figures(page):
    section = page.partition("## How to reproduce")[2].partition("\n## ")[0]
    for table in re.findall(r"(?:^\|.*\n)+", section, re.M):
        rows = [row.strip()[1:-1].split("|") for row in table.splitlines()]
        ours = [i for i, heading in enumerate(rows[0]) if i > 0 and "paper" not in heading]
        for row in rows[2:]:
            for i in ours:
                yield from re.findall(r"\d+\.\d+", row[i]) if i < len(row) else ()


def try_page(path):
    page = path.read_text(encoding="utf-8")
    printed, count = "", 0
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "tests").symlink_to(ROOT / "tests")
        pathlib.Path(folder, "build").mkdir()
        for command, expected in commands_of(page):
            run = subprocess.run(["bash", "-c", command.replace(AS_SHOWN, f"'{VOLCOMP}'")], cwd=folder, capture_output=True,
                                 text=True, check=False)
            check(run.returncode == expected, f"{path.name}: ends with {run.returncode}: {command}\n{run.stderr}")
            printed, count = printed + run.stdout, count + 1
    figures = list(our_figures(page))
    for figure in figures:
        check(re.search(rf"(?<![\d.]){re.escape(figure)}", printed), f"{path.name}: no command prints {figure}")
    check(count > 2 and len(figures) > 8, f"{path.name}: {count} commands and {len(figures)} figures were found")
    print(f"{path.name}: {count} commands, {len(figures)} figures")


for name in sys.argv[3:] or sorted(path.name for path in (ROOT / "docs/papers").glob("*.md")):
    try_page(ROOT / "docs/papers" / name)
for failure in failures:
    print(f"FAILED: {failure}")
sys.exit(1 if failures else 0)
