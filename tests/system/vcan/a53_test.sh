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

start candump candump -r 100000000 -L vcan0
candump=$!
wait_for 'candump listens' listeners_are 1
"${diagonal[@]}" --firmware a53 --can vcan0 --json "$work/a53.json" > "$work/a53_run.txt" 2>&1 ||
  fail 'the diagonal with the firmware'
kill -INT "$candump"
wait "$candump" 2> /dev/null || true
# EMCY 8110h, CAN overrun (CiA 301, 7.2.7.1).
if grep -q ' 0A0#1081' "$work/candump.txt"; then
  fail 'frames were lost before the node saw them'
fi

expect 'firmware and loopback give the same figures' \
  "$python" "$same_figures" "$work/a53.json" "$work/loopback.json" 0
expect 'every frame of the firmware is that of the node in this process' "$volcomp" replay "$work/candump.txt"
