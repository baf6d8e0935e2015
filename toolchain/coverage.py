#!/usr/bin/env python3
"""Line and branch coverage of the target code (comp, hal, firmware) after the tests of the preset "cov" have run.

    toolchain/coverage.py [BUILD_FOLDER]   default build/cov

Prints a table and keeps it as BUILD_FOLDER/coverage.txt, with the annotated sources in coverage.html.
Branches that only an exception could take, and branches no code can reach, are not counted.
"""
import collections
import json
import pathlib
import shutil
import subprocess
import sys


class Failure(Exception):
    """One plain sentence for the user."""


def run_gcovr(build):
    summary = build / "coverage.json"
    run = subprocess.run(
        ["gcovr", "--root", ".", "--filter", "comp/", "--filter", "hal/", "--filter", "firmware/",
         "--exclude-throw-branches", "--exclude-unreachable-branches",
         "--json-summary", str(summary), "--html-details", str(build / "coverage.html"), str(build)],
        capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise Failure(f"gcovr failed:\n{run.stdout}{run.stderr}")
    return json.loads(summary.read_text())["files"]


def percent(covered, total):
    return f"{100.0 * covered / total:5.1f} %" if total else "      -"


def row(name, file):
    return (f"{name:<52} {percent(file['line_covered'], file['line_total'])} "
            f"{file['line_covered']:>5}/{file['line_total']:<5} "
            f"{percent(file['branch_covered'], file['branch_total'])} "
            f"{file['branch_covered']:>5}/{file['branch_total']}")


def table(files):
    total = collections.Counter()
    for file in files:
        total.update({key: value for key, value in file.items() if key.endswith(("_covered", "_total"))})
    head = f"{'file':<52} {'lines':>7} {'covered':>11} {'branches':>7} {'covered':>10}"
    body = [row(file["filename"], file) for file in sorted(files, key=lambda f: f["filename"])]
    return "\n".join([head, *body, row("total", total)])


def main():
    if len(sys.argv) > 1 and sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return
    if shutil.which("gcovr") is None:
        raise Failure('the command "gcovr" is missing: run toolchain/setup.sh first.')
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/cov")
    if not build.is_dir():
        raise Failure(f'there is no folder {build}: build and test the preset "cov" first.')
    files = run_gcovr(build)
    if not files:
        raise Failure("no file of the target code was run by the tests.")
    text = table(files)
    (build / "coverage.txt").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    try:
        main()
    except Failure as failure:
        sys.exit(f"coverage.py: {failure}")
