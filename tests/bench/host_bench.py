#!/usr/bin/env python3
"""Our ticks on a computer beside what others compute, in one run.

    tests/bench/host_bench.py build/host/tests/bench/volcomp_host_bench

Prints instructions per call, which callgrind counts exactly, and nanoseconds of a call that finds its memory cold.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

# What is printed, and callgrind's names of it: positions that walk, positions that jump. One name: no difference.
ROWS = [
    ("**tick of XYFZ**, compiled in", "xyfz smooth", "xyfz jumping"),
    ("tick of XYFZ, loaded", "xyfz loaded smooth", "xyfz loaded jumping"),
    ("tick of five axes, compiled in", "five smooth", "five jumping"),
    ("tick of five axes, loaded", "five loaded smooth", "five loaded jumping"),
    ("18 lookups, formula of CMSIS-DSP's arm_linear_interp_f32", "dsp smooth", "dsp jumping"),
    ("18 lookups, textbook", "textbook smooth", "textbook jumping"),
    ("3 axes of one table each, as LinuxCNC's screw compensation", "screw smooth", "screw jumping"),
    ("6 frames of KDL on a point, no lookup", "kdl frames", None),
    ("chain of 6 joints by KDL's ChainFkSolverPos_recursive, no lookup", "kdl chain", None),
    ("6 products 4x4 by Eigen, float, no lookup", "eigen float", None),
    ("6 products 4x4 by Eigen, double, no lookup", "eigen double", None),
]


def dumped(folder):
    """Instructions by name, from the files that callgrind has dumped."""
    counts = {}
    for path in folder.glob("counts.*"):
        text = path.read_text(errors="replace")
        name = re.search(r"^desc: Trigger: Client Request: (.*)$", text, re.M)
        total = re.search(r"^(?:totals|summary): (\d+)", text, re.M)
        if name and total:
            counts[name.group(1).strip()] = int(total.group(1))
    return counts


def count(program):
    """Instructions per call by name, those of the call itself taken off."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "counts"
        run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program, "counts"],
                             capture_output=True, text=True, check=False)
        if run.returncode != 0:
            sys.exit(run.stderr)
        calls = int(re.search(r"calls (\d+)", run.stdout).group(1))
        counts = dumped(pathlib.Path(folder))
    call = counts.pop("call")
    return {name: (total - call) / calls for name, total in counts.items()}


def print_counts(counts):
    print("| instructions per call, mean | positions walk | positions jump |\n|---|---:|---:|")
    for title, walk, jump in ROWS:
        if walk not in counts:
            print(f"| {title} | not installed | |")
            continue
        jumping = f"{counts[jump]:.0f}" if jump else ""
        print(f"| {title} | {counts[walk]:.0f} | {jumping} |")


def print_cold(program):
    lines = subprocess.run([program, "cold"], capture_output=True, text=True, check=True).stdout.splitlines()
    print("\n| a call after 8 MB of other memory, ns | median | quarters |\n|---|---:|---:|")
    for line in lines:
        name, median, lower, upper = line.split("\t")
        print(f"| {name} | {median} | {lower} ... {upper} |")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print_counts(count(sys.argv[1]))
    print_cold(sys.argv[1])


if __name__ == "__main__":
    main()
