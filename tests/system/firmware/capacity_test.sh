#!/usr/bin/env bash
# Tables that do not fit the board are refused over SDO with the reason, and those it has stay as they are.
# shellcheck source=tests/system/firmware/common.sh
. "$(dirname "$0")/common.sh"

expect 0 'PASS' "$volcomp" run xyfz --draws 0 --volume-points 10 --report "$work/report"
runs=("$work"/report/campaign/noise_free/runs_*.csv)
room=$(knots_of m4)
for knots in "$room" 128; do
  expect 0 'knots' "$volcomp" build-tables --machine host_sim/machines/xyfz.toml --runs "${runs[@]}" \
    --knots "$knots" --out "$work/tables-$knots.vct"
done

# QEMU where the pipes are. To the node its pipe stays open between one command and the next.
folder=$work/m4
mkdir "$folder"
mkfifo "$folder/to_node" "$folder/from_node"
exec 9<> "$folder/to_node"
run_firmware=$PWD/toolchain/run-firmware
(cd "$folder" && exec "$run_firmware" m4 "$(image_of m4)" pipe > output.txt 2>&1 9>&-) &
board=$!

# come_back: what the node has is, byte for byte, what was built for it.
come_back() {
  rm -f "$work/back.vct"
  expect 0 'bytes, CRC-32' "$volcomp" upload "$work/back.vct" "${link[@]}"
  holds 'the tables come back byte for byte' cmp "$work/tables-$room.vct" "$work/back.vct"
}

link=(--can "pipe:$folder")
expect 0 'active: CRC-32' "$volcomp" download "$work/tables-$room.vct" "${link[@]}" --store
come_back
active=$("$volcomp" diagnose "${link[@]}" | grep 'CRC-32')
holds 'the node names its tables' test -n "$active"
expect 1 'The table has too many knots for this build.' "$volcomp" download "$work/tables-128.vct" "${link[@]}"
expect 0 'last refusal:' "$volcomp" diagnose "${link[@]}"
expect 0 "$active" "$volcomp" diagnose "${link[@]}"
expect 0 'active: CRC-32' "$volcomp" download "$work/tables-$room.vct" "${link[@]}"
come_back

# The record that tells a node to quit, hal/frame_pipe.hpp.
printf '\377\377\377\377\0\0\0\0\0\0\0\0\0\0\0\0' >&9
wait "$board" || {
  echo "FAILED: told to quit, the firmware ends with exit code $?"
  failed=1
}
exit "$failed"
