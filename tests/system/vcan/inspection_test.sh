#!/usr/bin/env bash
# A master gear measured with the node as a second process on a real SocketCAN interface: every touch is the
# touch on the loopback, so every figure is.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly volcomp=$build/host_sim/volcomp same_figures=tests/system/vcan/same_figures.py
# The slower the cycle, the fewer there are; what is compared does not depend on it.
inspection=("$volcomp" run l300g --noise-free --cycle-hz 50)

without_bus loopback.json "${inspection[@]}" --can loopback --json "$work/loopback.json"
bus_begins

start node "$build/firmware/volcomp-node" --can vcan0 --node-id 32
wait_for 'the node listens' node_listens

"${inspection[@]}" --can vcan0 --json "$work/vcan.json" > "$work/vcan_run.txt" 2>&1 ||
  fail 'the inspection over vcan0'

# What is computed on another processor may differ in the last digits: glibc takes sine and logarithm with or without fused
# multiplication, by what the processor can.
expect 'vcan0 and loopback give the same figures' "$python" "$same_figures" "$work/vcan.json" "$work/loopback.json" 1e-9
