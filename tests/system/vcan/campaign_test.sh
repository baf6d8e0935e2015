#!/usr/bin/env bash
# The whole campaign with the node as a second process on a real SocketCAN interface: same figures as
# without any bus, and the log of it replays bit for bit.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly volcomp=$build/host_sim/volcomp same_figures=tests/system/vcan/same_figures.py
# The slower the cycle, the fewer there are; what is compared does not depend on it.
readonly cycle_hz=50
campaign=("$volcomp" run xyfz --draws 0 --volume-points 10)

sed "s/^tick_hz = .*/tick_hz = $cycle_hz.0/" host_sim/machines/xyfz.toml > "$work/machine.toml"
without_bus loopback.json "${campaign[@]}" --can loopback --cycle-hz "$cycle_hz" --json "$work/loopback.json"
without_bus integrated.json "${campaign[@]}" --machine "$work/machine.toml" --json "$work/integrated.json"
bus_begins

start candump candump -r 100000000 -L vcan0
candump=$!
wait_for 'candump listens' listeners_are 1
start node "$build/firmware/volcomp-node" --can vcan0 --node-id 32
wait_for 'the node listens' node_listens

"${campaign[@]}" --can vcan0 --cycle-hz "$cycle_hz" --json "$work/vcan.json" > "$work/vcan_run.txt" 2>&1 ||
  fail 'the campaign over vcan0'

expect 'vcan0 and loopback give the same figures' "$python" "$same_figures" "$work/vcan.json" "$work/loopback.json" 0
# µm and per cent; the wire counts nanometres.
expect 'vcan0 and the integrated form give the same figures' \
  "$python" "$same_figures" "$work/vcan.json" "$work/integrated.json" 0.001

kill -INT "$candump"
wait "$candump" 2> /dev/null || true
expect 'the log replays bit for bit' "$volcomp" replay "$work/candump.txt"
