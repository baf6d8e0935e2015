#!/usr/bin/env bash
# The node as firmware without an operating system, behind a CAN controller: QEMU emulates a processor and an
# SJA1000 and joins that to vcan0. One diagonal gives the figures of the node in this process, and every frame the
# firmware sent is the one that node sends.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly volcomp=$build/host_sim/volcomp same_figures=tests/system/vcan/same_figures.py
# Few cycles and small tables: what is compared depends on neither.
diagonal=("$volcomp" run xyfz --one-diagonal --cycle-hz 50 --knots 11)

without_bus loopback.json "${diagonal[@]}" --can loopback --json "$work/loopback.json"
bus_begins

diagonal_with_firmware() {
  start candump candump -r 100000000 -L vcan0
  local candump=$! status=0
  wait_for 'candump listens' listeners_are 1
  "${diagonal[@]}" --firmware a53 --can vcan0 --json "$work/a53.json" > "$work/a53_run.txt" 2>&1 || status=$?
  kill -INT "$candump"
  wait "$candump" 2> /dev/null || true
  return "$status"
}
# EMCY 8110h, CAN overrun (CiA 301, 7.2.7.1), or the last words of the firmware.
frames_were_lost() {
  grep -q ' 0A0#1081' "$work/candump.txt" || grep -q 'frames were lost' "$work/a53_run.txt"
}

# Frames that the emulator takes in late, so that two bursts meet in the controller, say nothing about the node: the
# diagonal begins anew, twice at most, and says so.
for attempt in 1 2 3; do
  status=0
  diagonal_with_firmware || status=$?
  frames_were_lost || break
  [ "$attempt" -lt 3 ] || fail 'frames were lost before the node saw them'
  printf 'again: frames were lost before the node saw them\n'
done
[ "$status" = 0 ] || fail 'the diagonal with the firmware'

expect 'firmware and loopback give the same figures' \
  "$python" "$same_figures" "$work/a53.json" "$work/loopback.json" 0
expect 'every frame of the firmware is that of the node in this process' "$volcomp" replay "$work/candump.txt"
