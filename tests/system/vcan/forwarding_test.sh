#!/usr/bin/env bash
# A node that forwards targets stands still for 50 ms, and its interface is removed: in motion, nothing old is sent and
# nothing more until all drives are disabled, or until a new start. It makes and removes an interface of its own, vcan2.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
bus_begins

readonly interface=vcan2
remove_interface() {
  ip link del dev "$interface" 2> /dev/null || true # the test may have removed it, or never made it
  end_test
}
trap remove_interface EXIT
{ ip link add dev "$interface" type vcan && ip link set dev "$interface" up; } || fail 'this user cannot make an interface'

start node "$build/firmware/volcomp-node" --can "$interface"
node_process=$!
wait_for 'the node has started' grep -q "node 32 on $interface" "$work/node.txt"
expect 'only what may be forwarded is' \
  "$python" tests/system/vcan/forwarding_bus.py "$interface" "$node_process" "$work/node.txt"
if grep -q 'does not tell' "$work/node.txt"; then
  fail 'the kernel gives back what the node has sent'
fi
