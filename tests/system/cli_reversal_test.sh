#!/usr/bin/env bash
# volcomp run reversal: the following error at a reversal, by how the offset is limited; figures, verdict, and bad input.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
cd "$work" || exit 1

expect 0 'PASS with 10 mm/s and 0.2 m/s² the offset adds' "$volcomp" run reversal --json figures.json
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: the figures'; failed=1; }
import json
f = json.load(open("figures.json"))
rows = {row["offset"]: row for row in f["effects"]}
assert len(rows) == 6 and f["ok"] and f["period_us"] == 125, f
judged = rows["rate and acceleration to spare"]
assert max(judged["along_um"], judged["against_um"]) <= 1.2, judged
assert abs(rows["in one period"]["along_um"] - 39.7) < 0.4, rows
assert abs(rows["no offset"]["along_um"] - 1.0) < 0.05, rows
PYTHON
"$volcomp" run reversal --json - 2>words.txt | grep -q '"added_um"' || { echo 'FAILED: figures in a pipe'; failed=1; }
grep -q 'PASS' words.txt || { echo 'FAILED: a pipe leaves no words for people'; failed=1; }
expect 0 'report.html' "$volcomp" run reversal --report page
[ -s page/report.html ] || { echo 'FAILED: there is no page'; failed=1; }

# Beyond the criterion the verdict is negative; at 1 ms the drive has time to follow.
expect 1 'FAIL' "$volcomp" run reversal --most-added-um 0.01
expect 0 'PASS' "$volcomp" run reversal --period-us 1000
# Less than a nanometre per period and period.
expect 2 'acceleration_too_small' "$volcomp" run reversal --period-us 62.5
expect 2 '10 % of 2 m/s2 to spare every 62.5 us' "$volcomp" run reversal --period-us 62.5
# A loop that is not stable follows nothing.
expect 2 'a position loop of 40 Hz needs a period of at most 2500 us' "$volcomp" run reversal --period-us 10000
one_line "$volcomp" run reversal --period-us 62.5
for option in --period-us --step-um --turning-m-per-s2 --spare-percent --loop-hz --most-added-um; do
  for value in nan -1 much; do
    expect 2 "$option" "$volcomp" run reversal "$option" "$value"
  done
done
expect 2 'no/figures.json' "$volcomp" run reversal --json no/figures.json
exit "$failed"
