"""Proves what is promised of every target, measures the firmware of the Cortex-M boards and judges it; called by
toolchain/evidence.sh, which builds the images first.

    python3 toolchain/evidence [--self-test | --proofs | --write]

Exit codes: 0 every promise holds, every budget is kept or known not to be (budgets.py), and docs/evidence.md says what was measured;
1 not so; 2 something is missing.
"""
import dataclasses
import json
import pathlib
import subprocess
import sys

import board_evidence
import budgets
import elf
import kernel_estimate
import promises
import promises_test
import self_test
import sizes
import table
import traced_tick
from failure import Failure

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OUT = ROOT / "build/evidence"
PAGE = "docs/evidence.md"
SHOWN_FLAGS = ("-mfloat-abi", "-O", "-ffp-contract", "-fno-tree", "-fno-schedule", "-frename")


def compiler_and_flags(build):
    command = kernel_estimate.compile_command(build, "comp/tick/instances.cpp")
    version = subprocess.run([command[0], "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
    flags = [w for w in command if w.startswith(SHOWN_FLAGS)]
    return version, " ".join(dict.fromkeys(flags))


def measure():
    parts = {board: board_evidence.BoardEvidence(ROOT, board) for board in table.BOARDS}
    compiler, flags = compiler_and_flags(ROOT / "build/m7")
    evidence = {"compiler": compiler, "flags": flags, "tables": "Tables of 81 knots (rotary 73)",
                "boards": {board: part.measure() for board, part in parts.items()},
                "a53": dataclasses.asdict(sizes.measure(elf.Image(ROOT / "build/a53/firmware/volcomp-node-a53.elf"))),
                "kernel_estimate": kernel_estimate.estimate(ROOT / "build/m7"),
                "traced": traced_tick.measure(ROOT / "build/m7/firmware/volcomp-trace-m7.elf")}
    checks = [check for part in parts.values() for check in part.checks] + budgets.of_traced(evidence["traced"])
    checks += budgets.of_ratio(*[evidence["boards"][board]["worst"] for board in ("m7", "m4")])
    offences = [offence for part in parts.values() for offence in part.offences]
    return evidence, checks, offences


def prove():
    offences = [offence for target in promises.IMAGES for offence in promises.prove(ROOT, target)]
    for offence in offences:
        print("  FOUND " + offence)
    return not offences


def judge(checks, offences):
    for check in checks:
        print("  " + check.line())
    for offence in offences:
        print("  FOUND " + offence)
    broken = sum(not check.kept() for check in checks)
    print(f"{len(checks)} budgets, {broken} broken; {len(offences)} offences")
    return broken == 0 and not offences


def page_agrees(text, write):
    path = ROOT / PAGE
    page = path.read_text()
    wanted = table.in_page(page, text)
    if wanted is None:
        raise Failure(f"{PAGE} has no place for the evidence: {table.BEGIN} … {table.END}")
    if page == wanted:
        return True
    if write:
        path.write_text(wanted)
        print(f"{PAGE}: written")
        return True
    print(f"{PAGE} shows other figures than these: toolchain/evidence.sh --write renews them.")
    return False


def main(arguments):
    if arguments not in ([], ["--self-test"], ["--proofs"], ["--write"]):
        raise Failure(f'unknown argument "{" ".join(arguments)}" (try toolchain/evidence.sh --help).')
    if arguments == ["--self-test"]:
        self_test.main()
        promises_test.main()
        return True
    if arguments == ["--proofs"]:
        return prove()
    evidence, checks, offences = measure()
    text = table.markdown(evidence)
    OUT.mkdir(parents=True, exist_ok=True)
    evidence["budgets"] = [check.line() for check in checks]
    evidence["offences"] = offences
    (OUT / "evidence.json").write_text(json.dumps(evidence, indent=1, ensure_ascii=False) + "\n")
    (OUT / "evidence.md").write_text(text)
    kept = judge(checks, offences)
    print(f"{OUT.relative_to(ROOT)}/evidence.json, evidence.md")
    return page_agrees(text, arguments == ["--write"]) and kept


try:
    sys.exit(0 if main(sys.argv[1:]) else 1)
except Failure as failure:
    print(f"evidence: {failure}", file=sys.stderr)
    sys.exit(2)
