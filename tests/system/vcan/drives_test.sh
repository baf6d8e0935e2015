#!/usr/bin/env bash
# Drives as their data sheets have them, two that take forwarded targets and one an offset that it does not report, with
# the node as a second process on a real SocketCAN interface: same figures as without any bus.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly volcomp=$build/host_sim/volcomp same_figures=tests/system/vcan/same_figures.py
# Few cycles: what is compared does not depend on them. An EPOS4 cannot count: SYNC has no counter.
readonly drives=eyou,nanotec_cl4e,epos4_0170
diagonal=("$volcomp" run xyfz --one-diagonal --cycle-hz 50 --knots 11 --drive-profile "$drives")

without_bus loopback.json "${diagonal[@]}" --can loopback --json "$work/loopback.json"
bus_begins

start node "$build/firmware/volcomp-node" --can vcan0 --node-id 32
wait_for 'the node listens' node_listens
"${diagonal[@]}" --can vcan0 --json "$work/vcan.json" > "$work/vcan_run.txt" 2>&1 || fail 'the diagonal over vcan0'
expect 'vcan0 and loopback give the same figures' "$python" "$same_figures" "$work/vcan.json" "$work/loopback.json" 0
