#!/usr/bin/env python3
"""Cases of limited offsets as numbers, for programs without a reader of JSON: one operand and one wanted result after the
other. The unit test beside it (tests/comp/tick/offset_cases_test.cpp) runs them on every target.

    offset_cases_inc.py offset-limits.json > offset_cases.inc
"""

import json
import struct
import sys

KINDS = {"offset.bounds": 1, "offset.braking": 2, "offset.follow": 3, "offset.station": 4}
FIELDS = [None, "limit", "rate", "soft_rate", "acceleration"]
FOLLOW, FOLLOW_SOFTLY, FOLLOW_FLOAT, HOLD, CHANGE, START = range(6)


def limits(values):
    return [values[field] for field in FIELDS[1:]]


def float_bits(value):
    return struct.unpack("<i", struct.pack("<f", float(value)))[0]


def values(op, key):
    return op[key] if isinstance(op[key], list) else [op[key]] * op.get("n", 1)


def ticks(op):
    """What one operation does, tick by tick: (operation, operand)."""
    follow = FOLLOW_SOFTLY if op.get("soft", 0) else FOLLOW
    if "hold" in op:
        return [(HOLD, 0)] * op["hold"]
    if "x" in op:
        return [(FOLLOW_FLOAT, float_bits(x)) for x in values(op, "x")]
    if "ramp" in op:
        first, step, n = op["ramp"]
        return [(follow, first + step * i) for i in range(n)]
    if "line" in op:
        first, p, q, n = op["line"]
        return [(follow, first + p * i // q) for i in range(n)]
    return [(follow, t) for t in values(op, "t")]


def follow_case(given, wanted):
    numbers = []
    results = iter(zip(wanted["offset"], wanted["status"]))
    count = 0
    for op in given["ops"]:
        if "limits" in op:
            numbers += [CHANGE, *limits(op["limits"])]
            count += 1
        elif "start" in op:
            numbers += [START, op["start"]]
            count += 1
        else:
            for tick in ticks(op):
                numbers += [*tick, *next(results)]
                count += 1
    assert next(results, None) is None, "every result belongs to a tick"
    return [*limits(given["limits"]), given["held"], count, *numbers, wanted["largest"], wanted["largest_lag"]]


def numbers_of(case):
    given, wanted = case["in"], case["out"]
    if case["kind"] == "offset.bounds":
        if "refused" in wanted:
            return [*limits(given["limits"]), FIELDS.index(wanted["refused"])]
        used = [wanted[name] for name in ("rate", "soft_rate", "acceleration", "free", "none")]
        return [*limits(given["limits"]), 0, *used]
    if case["kind"] == "offset.braking":
        steps = list(zip(given["step"], wanted["stopping_way"]))
        ways = list(zip(given["way"], wanted["stopping_step"]))
        return [given["acceleration"], len(steps), len(ways), *(n for pair in steps + ways for n in pair)]
    if case["kind"] == "offset.follow":
        return follow_case(given, wanted)
    pairs = zip(given["wanted"], wanted["sent"])
    tripped_at = -1 if wanted["tripped_at"] is None else wanted["tripped_at"]
    return [*limits(given["limits"]), given["held"], len(given["wanted"]), tripped_at, *(n for pair in pairs for n in pair)]


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        cases = json.load(file)["cases"]
    print("// Made by tests/cases/offset_cases_inc.py: kind, numbers that follow, numbers.")
    print(f"constexpr int kCases = {len(cases)};")
    print("constexpr std::int32_t kCaseNumbers[] = {")
    for case in cases:
        numbers = [int(n) for n in numbers_of(case)]
        assert all(-2**31 <= n < 2**31 for n in numbers), case["id"]
        text = [str(n) if n > -2**31 else "INT32_MIN" for n in [KINDS[case["kind"]], len(numbers), *numbers]]
        print(f"    // {case['id']}")
        for i in range(0, len(text), 16):
            print("    " + ", ".join(text[i:i + 16]) + ",")
    print("};")


main()
