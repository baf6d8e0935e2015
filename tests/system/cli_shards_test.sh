#!/usr/bin/env bash
# Parts of runs over machines, grinders and self-calibrations: all of them together make the very file of the whole run, and
# wrong ones are refused. Those of xyfz, l300g and face-gear: cli_spread_test.sh, cli_face_gear_test.sh.
#
#   cli_shards_test.sh VOLCOMP
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1

# parts_make_whole NAME SENTENCE COMMAND…: the verdict of the whole and of the parts alike.
parts_make_whole() {
  local name=$1 sentence=$2 verdict
  shift 2
  "$@" --json "$work/$name.json" > /dev/null
  verdict=$?
  [ "$verdict" -le 1 ] || { echo "FAILED: $name: exit code $verdict"; failed=1; }
  # The second part on one processor: another number of threads.
  taskset -c "$(taskset -cp $$ | sed 's/.*: //; s/[-,].*//')" "$@" --shard 2/2 --json "$work/$name-2.json" > /dev/null ||
    { echo "FAILED: $name: part 2"; failed=1; }
  expect 0 'part 1 of 2: 2 of 3 draws' "$@" --shard 1/2 --json "$work/$name-1.json"
  expect "$verdict" "$sentence" "$volcomp" collect "$work/$name-2.json" "$work/$name-1.json" --json "$work/$name-collected.json"
  cmp "$work/$name.json" "$work/$name-collected.json" ||
    { echo "FAILED: $name: the parts make another file than the whole"; failed=1; }
  expect 2 'draw 1 is the first' "$volcomp" collect "$work/$name-2.json"
  expect 2 'draw 1 is in another file, too' "$volcomp" collect "$work/$name-1.json" "$work/$name-1.json"
  expect 2 'give K/N' "$@" --shard 0/2 --json "$work/none.json"
  expect 2 'give --json FILE' "$@" --shard 1/2
  expect 2 'a report needs the whole run' "$@" --shard 1/2 --json "$work/none.json" --report "$work/report"
  [ ! -e "$work/none.json" ] || { echo "FAILED: $name: a refused part was written"; failed=1; }
}

machine=("$volcomp" run machine --places 10)
calibration=("$volcomp" run self-calibration --instrument tracer --places 10)
grinder=("$volcomp" run internal-helical)
parts_make_whole machine 'of 3 machines are good' "${machine[@]}" --seeds 3
parts_make_whole calibration 'of 3 machines are good' "${calibration[@]}" --draws 3
parts_make_whole grinder 'medians are judged from 16 seeds on' "${grinder[@]}" --seeds 3

# What the parts differ in.
"${machine[@]}" --seeds 3 --noise-free --shard 2/2 --json "$work/other.json" > /dev/null || failed=1
expect 2 'of another run' "$volcomp" collect "$work/machine-1.json" "$work/other.json"
expect 2 'of another run' "$volcomp" collect "$work/machine-1.json" "$work/calibration-2.json"
expect 2 '--shard requires --seeds' "${machine[@]}" --shard 1/2 --json "$work/none.json"
expect 2 '--shard requires --draws' "${calibration[@]}" --shard 1/2 --json "$work/none.json"
expect 2 'excludes' "${grinder[@]}" --shard 1/2 --tables "$work/tables" --json "$work/none.json"

# changed NAME PYTHON: a part that somebody has changed, refused without a word of what stands in it.
changed() {
  /usr/bin/python3 - "$work/$1-1.json" "$2" > "$work/changed.json" <<'PY'
import json, sys
part = json.load(open(sys.argv[1]))
exec(sys.argv[2])
json.dump(part, sys.stdout)
PY
}
first='part["draws"][0]["result"]'
changed machine "${first}['figures'][0]['figure'] = 'diagonal \x1b[31m'"
expect 2 '"figure" is unusable' "$volcomp" collect "$work/changed.json" "$work/machine-2.json"
changed machine "${first}['figures'][0]['figure'] = 'another'"
expect 2 'have different figures' "$volcomp" collect "$work/changed.json" "$work/machine-2.json"
changed calibration "${first}['after_um'][1] = None"
expect 2 '"after_um" is unusable' "$volcomp" collect "$work/changed.json" "$work/calibration-2.json"
changed grinder "${first}['learning_um'].pop()"
expect 2 '"learning_um" is unusable' "$volcomp" collect "$work/changed.json" "$work/grinder-2.json"
changed grinder "del ${first}['signals']"
expect 2 'is missing or of another kind' "$volcomp" collect "$work/changed.json" "$work/grinder-2.json"
exit "$failed"
