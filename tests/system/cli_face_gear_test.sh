#!/usr/bin/env bash
# volcomp run face-gear with scatter: the same bytes for any number of threads and in parts, the programs, the patch of the
# paper, and what is refused.
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

# The patch and the searches of the paper: no machine, no bus, the figures of docs/papers/face-gear.md.
expect 0 'PASS' "$volcomp" run face-gear --patch --json "$work/patch.json"
expect 0 'PASS' "$volcomp" run face-gear --patch --gear table1 --json "$work/patch-1.json"
printf 'shaper_teeth = 20\nteeth = 60\nmodule_mm = 2.5\npressure_angle = 20\n' > "$work/bad.toml"
expect 2 'bad.toml' "$volcomp" run face-gear --patch --gear "$work/bad.toml"
sed 's/pressure_angle/pressure_angle_deg/' "$work/bad.toml" > "$work/small.toml"
expect 0 'PASS' "$volcomp" run face-gear --patch --gear "$work/small.toml"
/usr/bin/python3 - "$work" <<'PY' || failed=1
import json, pathlib, sys
first, other = (json.loads((pathlib.Path(sys.argv[1]) / name).read_text()) for name in ("patch.json", "patch-1.json"))
keys = {"version", "gear", "ok", "patch", "searches", "convergence", "angle", "promises"}
assert first.keys() == keys | {"control_points"} and other.keys() == keys, (first.keys(), other.keys())
assert first["ok"] and all(p["holds"] for p in first["promises"])
off = {c["parameters"]: c["largest_um"] for c in first["control_points"]}
assert off["uniform"] < 1.0 and round(off["chord"]) == 237 and round(off["centripetal"]) == 125, off
plain, relieved = first["patch"]
assert plain["largest_um"] < 0.13 and 1.2 < relieved["largest_um"] < 1.25 and plain["nodes_mm"] < 1e-12, first["patch"]
ten, four, newton, closed = first["searches"]
assert [(s["levels"], s["points"], s["wrong_signs"]) for s in (ten, four)] == [(10, 1210, None), (23, 575, None)], first["searches"]
assert 0.12 < ten["nodes_um"] < 0.15 and 19 < four["nodes_um"] < 21 and newton["levels"] == 6
assert newton["wrong_signs"] == closed["wrong_signs"] == 0 and closed["points"] is None
assert len(first["convergence"]) == 23 and first["convergence"][9]["subdivision_10"]["points"] == 1210
assert first["convergence"][10]["newton"]["points"] is None and first["convergence"][0]["newton"]["step"] is None
assert [a["ends"] for a in first["angle"]] == [False] * 4 + [True] * 4
assert [a["distances"] for a in first["angle"]] == [60000] * 4 + [27260, 3704, 1, 4], first["angle"]
PY
expect 2 '--seeds is for measurements' "$volcomp" run face-gear --patch --seeds 2
expect 2 '--repeatability is for measurements' "$volcomp" run face-gear --patch --repeatability
expect 2 '--machine is for measurements' "$volcomp" run face-gear --patch --machine yk7280
expect 2 '--noise-free is for measurements' "$volcomp" run face-gear --patch --noise-free
expect 2 '--maps is for measurements' "$volcomp" run face-gear --patch --maps "$work/g"
expect 2 '--can is for measurements' "$volcomp" run face-gear --patch --can loopback
expect 2 '--serve is for measurements' "$volcomp" run face-gear --patch --serve 0
exit "$failed"
