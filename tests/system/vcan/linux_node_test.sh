#!/usr/bin/env bash
# The node as a service of Linux: which frames wake it, what it does when it was too slow, its priority, its service
# manager.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
bus_begins

readonly volcomp=$build/host_sim/volcomp node=$build/firmware/volcomp-node

# matches: frames that the kernel has let through to the node so far.
matches() {
  awk '$1 == "vcan0" && $NF == "raw" { sum += $(NF - 1) } END { print sum + 0 }' /proc/net/can/rcvlist_sff
}

# stop_node: and wait until it has ended.
stop_node() {
  kill -TERM "$node_process"
  wait "$node_process" 2> /dev/null || true
}

# --- filters: no other frame reaches it
start node "$node" --can vcan0
node_process=$!
wait_for 'the node listens' node_listens
expect 'no frame of all kinds reaches it' listeners_are 0
before=$(matches)
cangen vcan0 -g 0 -I 123 -L 8 -n 500
expect 'frames of others do not wake it' test "$(matches)" = "$before"
cangen vcan0 -g 0 -I 100 -L 8 -n 500  # TIME has six bytes: these do nothing
expect 'its own frames do' test "$(matches)" -ge $((before + 500))

# --- stalled: what the kernel had to drop is counted
kill -STOP "$node_process"
cangen vcan0 -g 0 -I 100 -L 8 -n 20000
kill -CONT "$node_process"
frames_lost() {
  cangen vcan0 -g 0 -I 100 -L 8 -n 1  # the counter comes with a frame
  "$volcomp" diagnose --can vcan0 --json - 2> /dev/null |
    "$python" -c 'import json, sys; sys.exit(not json.load(sys.stdin)["frames_lost"] > 1000)'
}
wait_for 'lost frames are told' frames_lost
stop_node

# --- priority: as the system allows
if chrt -f 45 true 2> /dev/null; then
  start node "$node" --can vcan0 --priority 45 --cpu 0
  node_process=$!
  wait_for 'the node listens' node_listens
  expect 'the node has its priority' grep -q 'priority: 45' <(chrt -p "$node_process")
  expect 'the node has its policy' grep -q 'SCHED_FIFO' <(chrt -p "$node_process")
  expect 'the node stays on its processor' grep -q ': 0$' <(taskset -pc "$node_process")
  expect 'its memory is locked' grep -qE '^VmLck:[[:space:]]*[1-9][0-9]{3,} kB' "/proc/$node_process/status"
  stop_node
else
  echo 'skipped: this system grants no real-time priority'
fi
# refused OPTION...: in one sentence, with 2.
refused() {
  local status=0
  "${unprivileged[@]}" "$node" --can vcan0 "$@" > "$work/said.txt" 2>&1 || status=$?
  [ "$status" = 2 ] || fail "$* ended with $status instead of 2"
}
unprivileged=()
refused --cpu 1000
expect 'a missing processor is named' grep -q -- '--cpu 1000: there is no such processor' "$work/said.txt"
refused --priority 100
unprivileged=(prlimit --rtprio=0 --memlock=65536 setpriv --bounding-set=-all --inh-caps=-all --reuid=65534 --regid=65534 --clear-groups)
if "${unprivileged[@]}" true; then
  refused --priority 45
  expect 'what is missing is named' grep -qE 'CAP_IPC_LOCK|CAP_SYS_NICE' "$work/said.txt"
else
  echo 'skipped: no process here may have fewer rights'
fi

# --- a service manager: ready, alive, not alive while it hangs, ending
cat > "$work/manager.py" << 'END'
import os
import signal
import socket
import subprocess
import sys

manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
manager.bind(sys.argv[1])
manager.settimeout(30)
node = subprocess.Popen(sys.argv[2:], env=dict(os.environ, NOTIFY_SOCKET=sys.argv[1], WATCHDOG_USEC="300000"))


def hears(text):
    while text not in manager.recv(1000).decode():
        pass


hears("READY=1\nSTATUS=node 32 on vcan0")
hears("WATCHDOG=1")
hears("WATCHDOG=1")
node.send_signal(signal.SIGSTOP)
os.waitpid(node.pid, os.WUNTRACED)
manager.settimeout(2)
try:
    while True:
        manager.recv(1000)  # sent before
except TimeoutError:
    print("silent while it hangs")
manager.settimeout(30)
node.send_signal(signal.SIGCONT)
hears("WATCHDOG=1")
node.send_signal(signal.SIGTERM)
hears("STOPPING=1")
sys.exit(node.wait())
END
expect 'the manager is told' "$python" "$work/manager.py" "$work/manager" "$node" --can vcan0
