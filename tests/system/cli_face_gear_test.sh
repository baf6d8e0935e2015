#!/usr/bin/env bash
# volcomp run face-gear with scatter: the same bytes for any number of threads and in parts, the programs, and what is
# refused.
#
#   cli_face_gear_test.sh VOLCOMP
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
gear=("$volcomp" run face-gear --cycle-hz 50 --touches 1)

# In one process with several threads, and in two with one each: the very same file.
"${gear[@]}" --seeds 2 --json "$work/all.json" > /dev/null
"${gear[@]}" --seeds 2 --json "$work/part-2.json" --shard 2/2 > /dev/null &
"${gear[@]}" --seeds 2 --json "$work/part-1.json" --shard 1/2 > /dev/null || failed=1
wait $! || failed=1
"$volcomp" collect "$work/part-2.json" "$work/part-1.json" --json "$work/collected.json" > /dev/null
cmp "$work/all.json" "$work/collected.json" || { echo 'FAILED: the parts make another file than the whole'; failed=1; }
expect 2 'draw 1 is the first' "$volcomp" collect "$work/part-2.json"

# The second of two measurements is the one of the next seed, and another one than the first.
"${gear[@]}" --seed 2 --json "$work/second.json" --gcode "$work/nc" > /dev/null
/usr/bin/python3 - "$work" <<'PY' || failed=1
import json, pathlib, sys
work = pathlib.Path(sys.argv[1])
all_, part, second = (json.loads((work / name).read_text()) for name in ("all.json", "part-2.json", "second.json"))
rms = [stage["map"]["rms_um"] for stage in second["stages"]]
assert [stage["map_um"][0] for stage in part["draws"][0]["result"]["stage"]] == rms, (part, rms)
for row in all_["spread"]:
    assert row["least_um"] < row["median_um"] < row["most_um"], row
programs = [(work / "nc" / f"inspection_{when}.ngc").read_text() for when in ("before", "after")]
assert [p.count("G38.2 ") for p in programs] == [412, 412] and programs[0] != programs[1]
PY

expect 0 'ring, 0 to 350 deg' "$volcomp" run face-gear --cycle-hz 50 --repeatability
expect 2 'a bus each' "$volcomp" run face-gear --repeatability --can vcan7
expect 2 'a bus each' "$volcomp" run face-gear --seeds 2 --can vcan7
expect 2 'one measurement of a gear' "$volcomp" run face-gear --seeds 2 --gcode "$work/g"
expect 2 '--shard is for measurements' "$volcomp" run face-gear --repeatability --seeds 2 --shard 1/2 --json "$work/p.json"
expect 2 '--probe excludes --noise-free' "$volcomp" run face-gear --noise-free --probe lp2
expect 2 'excludes' "$volcomp" run face-gear --tracer-um 2 --noise-free
expect 2 'not a number from' "$volcomp" run face-gear --tracer-um nan
exit "$failed"
