#!/usr/bin/env python3
"""Line and branch coverage of the target code (comp, hal, firmware) after the tests of the preset "host-asan" have run.

    toolchain/coverage.py [BUILD_FOLDER]   default build/host-asan

Prints a table and keeps it as BUILD_FOLDER/coverage.txt, with the annotated sources in BUILD_FOLDER/coverage.
A line or branch of a template counts as run when one of its instances has run it. Fails when fewer than 95 % of the
branches have run, and says which files lack most.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

FOLDERS = ("comp", "hal", "firmware")
LEAST_BRANCHES = 95.0  # percent
ROOT = pathlib.Path(__file__).resolve().parent.parent


class Failure(Exception):
    """One plain sentence for the user."""


def run(*command):
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise Failure(f"{command[0]} failed:\n{result.stderr.strip()}")
    return result.stdout


def is_program(path):
    if not path.is_file() or not os.access(path, os.X_OK):
        return False
    with path.open("rb") as file:
        return file.read(4) == b"\x7fELF"


def merge_profiles(build):
    profiles = sorted((build / "profile").glob("*.profraw"))
    if not profiles:
        raise Failure(f'{build / "profile"} holds no profile: run the tests of the preset "host-asan" first.')
    merged = build / "coverage.profdata"
    run("llvm-profdata", "merge", "-sparse", *profiles, "-o", merged)
    return merged


def llvm_cov(action, programs, profile, *options):
    objects = [part for program in programs[1:] for part in ("-object", program)]
    sources = [ROOT / folder for folder in FOLDERS]
    return run("llvm-cov", action, programs[0], *objects, f"-instr-profile={profile}", *options, *sources)


def percent(part):
    return f"{100.0 * part['covered'] / part['count']:5.1f} %" if part["count"] else "      -"


def row(name, summary):
    cells = (f"{percent(summary[what])} {summary[what]['covered']:>5}/{summary[what]['count']:<5}"
             for what in ("lines", "branches"))
    return f"{name:<52} {' '.join(cells)}"


def table(report):
    files = sorted(report["files"], key=lambda file: file["filename"])
    body = [row(str(pathlib.Path(file["filename"]).relative_to(ROOT)), file["summary"]) for file in files]
    head = f"{'file':<52} {'lines':>7} {'covered':>11} {'branches':>7} {'covered':>10}"
    return "\n".join([head, *body, row("total", report["totals"])])


def uncovered(file):
    return file["summary"]["branches"]["notcovered"]


# Compared as counted, not as rounded for the table.
def check_branches(report):
    branches = report["totals"]["branches"]
    if 100.0 * branches["covered"] >= LEAST_BRANCHES * branches["count"]:
        return
    worst = sorted(report["files"], key=uncovered, reverse=True)[:10]
    names = "".join(f'\n  {uncovered(file):>4}  {pathlib.Path(file["filename"]).relative_to(ROOT)}' for file in worst)
    raise Failure(f'{branches["covered"]} of {branches["count"]} branches have run, '
                  f'{LEAST_BRANCHES:g} % are wanted; most are missing in{names}')


def main():
    if len(sys.argv) > 1 and sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return
    for command in ("llvm-cov", "llvm-profdata"):
        if shutil.which(command) is None:
            raise Failure(f'the command "{command}" is missing: run toolchain/setup.sh first.')
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/host-asan")
    programs = sorted(path for path in build.rglob("*") if "CMakeFiles" not in path.parts and is_program(path))
    if not programs:
        raise Failure(f'there is no program in {build}: build and test the preset "host-asan" first.')
    profile = merge_profiles(build)
    report = json.loads(llvm_cov("export", programs, profile, "-summary-only"))["data"][0]
    text = table(report)
    (build / "coverage.txt").write_text(text + "\n")
    llvm_cov("show", programs, profile, "-format=html", f"-output-dir={build / 'coverage'}")
    print(text)
    check_branches(report)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"coverage.py: {failure}")
