#!/usr/bin/env bash
# The whole campaign with the node as firmware on M7 and M4F: the figures and every frame in motion are those of
# the Linux node with the same tables, bit for bit, and each node does again what the log of the other says.
# shellcheck source=tests/system/firmware/common.sh
. "$(dirname "$0")/common.sh"

# The slower the cycle, the fewer there are; what is compared does not depend on it.
campaign=("$volcomp" run xyfz --draws 0 --volume-points 10 --cycle-hz 50)

# run_on_linux KNOTS: the same campaign with volcomp-node behind the same kind of pipe.
run_on_linux() {
  mkdir "$work/pipe-$1"
  "$linux_node" --can "pipe:$work/pipe-$1" > "$work/pipe-$1/output.txt" &
  expect 0 'PASS' "${campaign[@]}" --knots "$1" --can "pipe:$work/pipe-$1" \
    --log "$work/linux-$1.log" --json "$work/linux-$1.json"
  wait "$!"
}

# run_on_board BOARD NAME
run_on_board() {
  expect 0 'PASS' "${campaign[@]}" --firmware "$1" --firmware-image "$(image_of "$1")" \
    --log "$work/$2.log" --json "$work/$2.json"
}

boards=(m7 m4)
for board in "${boards[@]}"; do
  knots=$(knots_of "$board")
  run_on_linux "$knots"
  run_on_board "$board" "$board"
  holds "the figures of $board are those of the Linux node" \
    diff <(grep -v '"transport"' "$work/$board.json") <(grep -v '"transport"' "$work/linux-$knots.json")
  holds "the frames of $board are those of the Linux node" \
    "$python" tests/system/firmware/compare_logs.py "$work/$board.log" "$work/linux-$knots.log"
  expect 0 'the node did the same again' "$volcomp" replay "$work/$board.log"
  expect 0 'the node did the same again' "$volcomp" replay "$work/linux-$knots.log" --firmware "$board" \
    --firmware-image "$(image_of "$board")"
done

# Twice the same run is the same file.
run_on_board m7 again
holds 'two runs on m7 are equal to the last byte' cmp "$work/m7.log" "$work/again.log"

# The comparison sees one bit of one offset.
line=$(grep -n ' 301#' "$work/m7.log" | sed -n '30000s/:.*//p')
sed -E "${line}s/(301#.)(.)/\1$(sed -nE "${line}s/.*301#.(.).*/\1/p" "$work/m7.log" | tr '0-9A-F' '1032547698BADCFE')/" \
  "$work/m7.log" > "$work/changed.log"
if "$python" tests/system/firmware/compare_logs.py "$work/m7.log" "$work/changed.log" > /dev/null 2>&1; then
  echo 'FAILED: a changed offset was not noticed'
  failed=1
fi
expect 1 "line $line: process data 301h differs" "$volcomp" replay "$work/changed.log" --firmware m7 \
  --firmware-image "$(image_of m7)"
exit "$failed"
