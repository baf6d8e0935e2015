#!/usr/bin/env bash
# volcomp run l300g with a probe that scatters, and run xyfz on many machines: the same bytes for any number of threads and
# parts, what it costs to measure less often, and what is refused.
#
#   cli_spread_test.sh VOLCOMP
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
spread=("$volcomp" run l300g --cycle-hz 50 --probe rmp600 --seeds 3 --json)

"${spread[@]}" "$work/all.json" > /dev/null || failed=1
taskset -c "$(taskset -cp $$ | sed 's/.*: //; s/[-,].*//')" "${spread[@]}" "$work/one.json" > /dev/null || failed=1
cmp "$work/all.json" "$work/one.json" || { echo 'FAILED: another number of threads, other figures'; failed=1; }

# In two parts, by two processes at a time: the very file of the whole.
"${spread[@]}" "$work/part-2.json" --shard 2/2 > /dev/null &
"${spread[@]}" "$work/part-1.json" --shard 1/2 > /dev/null || failed=1
wait $! || failed=1
expect 0 'profile and lead' "$volcomp" collect "$work/part-2.json" "$work/part-1.json" --json "$work/collected.json"
cmp "$work/all.json" "$work/collected.json" || { echo 'FAILED: the parts make another file than the whole'; failed=1; }
expect 2 'draw 1 is the first' "$volcomp" collect "$work/part-2.json"
expect 2 'no part of a run' "$volcomp" collect "$work/all.json"
expect 2 'give --json FILE' "$volcomp" run xyfz --shard 1/2
expect 2 'a page needs the whole run' "$volcomp" run xyfz --shard 1/2 --serve 0 --json "$work/none.json"
expect 0 'worst of 2 teeth' "$volcomp" run l300g --cycle-hz 50 --seeds 2 --teeth 2 --points 71
expect 2 'the gear has 31' "$volcomp" run l300g --teeth 32
expect 2 '--points' "$volcomp" run l300g --points 5
expect 2 'one measurement' "$volcomp" run l300g --seeds 2 --gcode "$work/g"
expect 2 'give K/N' "$volcomp" run xyfz --shard 3/2 --json "$work/none.json"

# Several machines: any number of threads, and parts.
machines=("$volcomp" run xyfz --machines 2 --draws 2 --squareness circles --json)
"${machines[@]}" "$work/machines.json" > /dev/null || failed=1
taskset -c "$(taskset -cp $$ | sed 's/.*: //; s/[-,].*//')" "${machines[@]}" "$work/machines-1.json" > /dev/null || failed=1
cmp "$work/machines.json" "$work/machines-1.json" || { echo 'FAILED: another number of threads, other machines'; failed=1; }
"${machines[@]}" "$work/half-1.json" --shard 1/2 > /dev/null || failed=1
"${machines[@]}" "$work/half-2.json" --shard 2/2 > /dev/null || failed=1
expect 0 'on 2 of 2 machines' "$volcomp" collect "$work/half-1.json" "$work/half-2.json" --json "$work/both.json"
cmp "$work/machines.json" "$work/both.json" || { echo 'FAILED: the parts make other machines than the whole'; failed=1; }
expect 2 'of another run' "$volcomp" collect "$work/half-1.json" "$work/part-2.json"

# Without noise by either name.
"$volcomp" run xyfz --noise-free --volume-points 20 --json "$work/free.json" > /dev/null || failed=1
"$volcomp" run xyfz --draws 0 --volume-points 20 --json "$work/none.json" > /dev/null || failed=1
cmp "$work/free.json" "$work/none.json" || { echo 'FAILED: --noise-free is not --draws 0'; failed=1; }
expect 2 'excludes' "$volcomp" run xyfz --noise-free --draws 3
expect 2 'excludes' "$volcomp" run xyfz --machines 2 --one-diagonal
expect 2 'excludes' "$volcomp" run xyfz --paper-figures --shard 1/2 --json "$work/x.json"

# Three measurements differ, and none is smaller than the gear by more than the filter takes; one with single touches of a
# coarser probe shows more.
/usr/bin/python3 - "$work/all.json" <<'PY' || failed=1
import json, sys
r = json.load(open(sys.argv[1]))
assert r["measurements"] == 3 and r["probe"] == "rmp600" and r["filter"] is True, r
assert r["tracer_um"] == 0.1 and r["touches"] == 1, r
for row in r["spread"]:
    assert row["least_um"] < row["median_um"] < row["most_um"], row
    if row["figure"] != "F_p":
        assert row["own_um"] - 0.2 < row["least_um"] and row["most_um"] < row["own_um"] + 1.2, row
PY
expect 1 'profile and lead' "$volcomp" run l300g --cycle-hz 50 --touches 1 --no-filter --tracer-um 0 --seeds 2
expect 2 'that scatters all measurements are alike' "$volcomp" run l300g --probe none --tracer-um 0 --seeds 2
expect 2 '--seeds excludes --noise-free' "$volcomp" run l300g --noise-free --seeds 2
expect 2 'a bus each' "$volcomp" run l300g --seeds 2 --can vcan7

# A gear of one's own: where nothing scatters it is found as it is. And one that no touch of this machine finds.
gear() {
  printf 'teeth = %s\nmodule_mm = %s\npressure_angle_deg = 20.0\ntip_diameter_mm = %s\nwidth_mm = 24.0\n%s\n' "$@" >"$work/gear.toml"
}
gear 25 5.0 135.0 ''
expect 0 'PASS Profile grade' "$volcomp" run l300g --cycle-hz 50 --noise-free --gear "$work/gear.toml"
gear 25 5.0 135.0 'helix_angle_deg = 10.0'
expect 2 'gear.toml: helix_angle_deg: the grinder measures spur gears only' "$volcomp" run l300g --gear "$work/gear.toml"
gear 80 1.5 123.0 ''
expect 2 'gear.toml: a ball of radius 1.4935 mm does not fit between the teeth' "$volcomp" run l300g --gear "$work/gear.toml"
exit "$failed"
