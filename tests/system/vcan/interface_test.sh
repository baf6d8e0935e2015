#!/usr/bin/env bash
# A node whose interface is taken away and comes back, whose controller reports errors, and whose store can only be
# read. It makes and removes an interface of its own, vcan1, for which it needs the rights of the test VM.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly node=$build/firmware/volcomp-node interface=vcan1
readonly log=$work/candump.txt said=$work/node.txt

make_interface() {
  ip link add dev "$interface" type vcan && ip link set dev "$interface" up
}

make_interface 2> /dev/null || {
  printf 'skipped: this user cannot make an interface\n'
  exit 0
}

# said_times NUMBER TEXT: what the node has printed contains the text in so many lines.
said_times() {
  [ "$(grep -cF -- "$2" "$said")" = "$1" ]
}

# heard TEXT: candump has seen a frame that begins so.
heard() {
  grep -qF -- " $1" "$log"
}

# listen: candump on the interface as it is now, beginning a new log. The frames wanted are those of the node.
listen() {
  start candump candump -L "$interface",0A0:7FF,5A0:7FF,720:7FF
  listener=$!
  wait_for 'the node is heard' heard 720#
}

stop() {
  kill "$1" 2> /dev/null || true
  wait "$1" 2> /dev/null || true
}

start node "$node" --can "$interface" --node-id 32
node_process=$!
wait_for 'the node has started' said_times 1 "node 32 on $interface"
listen

# --- the controller reports errors: the flags and bytes of linux/can/error.h
cansend "$interface" 20000004#0020000000000000 # error passive by errors while sending
wait_for 'EMCY 8120h' heard 0A0#208111
cansend "$interface" 20000004#0040000000000000 # error active again
wait_for 'EMCY 0000h for 8120h' heard 0A0#000000002081
cansend "$interface" 20000040#0000000000000000 # bus-off
sleep 1
cansend "$interface" 20000100#0000000000000000 # restarted
wait_for 'EMCY 8140h' heard 0A0#408111
cansend "$interface" 620#4005260000000000
wait_for '2605h has counted passive and bus-off' heard 5A0#4305260002000000

# --- the interface is removed and comes back
stop "$listener"
for time in 1 2; do
  ip link del dev "$interface"
  wait_for 'the node says that its interface is gone' said_times "$time" 'the interface is down or gone'
  expect 'the node is still there' kill -0 "$node_process"
  make_interface
  wait_for 'the node says that its interface is back' said_times "$time" 'the interface is back'
  listen
  stop "$listener"
done
ip link set dev "$interface" down
wait_for 'the node says that its interface is down' said_times 3 'the interface is down or gone'
ip link set dev "$interface" up
wait_for 'the node says that its interface is up' said_times 3 'the interface is back'
listen
stop "$listener"
stop "$node_process"

start node "$node" --can "$interface" --node-id 32 --exit-on-lost-interface
node_process=$!
wait_for 'the node has started' said_times 1 "node 32 on $interface"
ip link del dev "$interface"
status=0
wait "$node_process" || status=$?
expect 'the exit code is 3' [ "$status" = 3 ]
expect 'the node says why' said_times 1 "$interface: the interface is down or gone"
make_interface

# --- a store on a read-only file system
mkdir "$work/medium"
mount -t tmpfs tmpfs "$work/medium" 2> /dev/null || {
  printf 'skipped from here: this user cannot mount\n'
  exit 0
}
unmount() {
  umount "$work/medium"
  end_test
}
trap unmount EXIT

start node "$node" --can "$interface" --node-id 32 --store "$work/medium/node.store"
node_process=$!
wait_for 'the node has started' said_times 1 "node 32 on $interface"
listen
cansend "$interface" 620#4010100100000000
wait_for '1010h:01 is 1: it saves' heard 5A0#4310100101000000
cansend "$interface" 620#2306100088130000
wait_for '1006h is written' heard 5A0#60061000
cansend "$interface" 620#2310100173617665
wait_for '1010h:01 = save is done' heard 5A0#60101001
stop "$listener"
stop "$node_process"

mount -o remount,ro "$work/medium"
start node "$node" --can "$interface" --node-id 32 --store "$work/medium/node.store"
node_process=$!
wait_for 'the node has started' said_times 1 "node 32 on $interface"
expect 'the node says that its store can only be read' said_times 1 'node.store: can only be read'
listen
cansend "$interface" 620#4006100000000000
wait_for '1006h is what was stored' heard 5A0#4306100088130000
cansend "$interface" 620#4010100100000000
wait_for '1010h:01 is 0: nothing can be saved' heard 5A0#4310100100000000
cansend "$interface" 620#2310100173617665
wait_for 'saving is refused, 0606 0000h' heard 5A0#8010100100000606
wait_for 'EMCY 5530h, reason 11' heard 0A0#3055010B
stop "$node_process"

status=0
"$node" --can "$interface" --store "$work/medium/none.store" > "$said" 2>&1 || status=$?
expect 'a store that cannot be made ends with 2' [ "$status" = 2 ]
expect 'and with the reason of the system' said_times 1 'none.store: the operating system refused: Read-only file system'
