#!/usr/bin/env bash
# The node as a process of its own on a real SocketCAN interface, met by tools that know nothing of it
# (python-can) and by the commands of this project.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly volcomp=$build/host_sim/volcomp node=$build/firmware/volcomp-node
readonly store=$work/node.store

# says SENTENCE TEXT COMMAND...: the command succeeds and prints the text.
says() {
  local sentence=$1 text=$2
  shift 2
  "$@" > "$work/said.txt" 2>&1 || fail "$sentence (exit code $?)"
  grep -qF -- "$text" "$work/said.txt" || fail "$sentence: \"$text\" is not in the output"
}

# refuses CODE TEXT COMMAND...: ends with the code and prints the text in one line.
refuses() {
  local wanted=$1 text=$2 status=0
  shift 2
  "$@" > "$work/said.txt" 2>&1 || status=$?
  [ "$status" = "$wanted" ] || fail "$* ended with $status instead of $wanted"
  grep -qF -- "$text" "$work/said.txt" || fail "$* did not say \"$text\""
}

start_node() {
  start node "$node" --can vcan0 --node-id 32 --store "$store"
  node_process=$!
  wait_for 'the node listens' node_listens
}

stop_node() {
  kill "-$1" "$node_process"
  wait "$node_process" 2> /dev/null || true
}

make_tables() {
  "$volcomp" run xyfz --draws 0 --volume-points 10 --report "$work/report" &&
    "$volcomp" build-tables --machine host_sim/machines/xyfz.toml --runs "$work"/report/campaign/noise_free/runs_*.csv \
      --out "$work/tables.vct"
}
without_bus tables.vct make_tables
bus_begins

# --- somebody else's CAN library reads the heartbeat and an object
cat > "$work/read.py" << 'END'
import can

with can.Bus(interface="socketcan", channel="vcan0") as bus:
    while bus.recv(timeout=30).arbitration_id != 0x720:
        pass
    print("heartbeat heard")
    # SDO upload of 1018h:02, the product code.
    bus.send(can.Message(arbitration_id=0x620, data=[0x40, 0x18, 0x10, 2, 0, 0, 0, 0], is_extended_id=False))
    while (answer := bus.recv(timeout=30)).arbitration_id != 0x5A0:
        pass
    print(answer.data.hex())
END
start_node
says 'python-can hears the heartbeat' 'heartbeat heard' "$python" "$work/read.py"
expect 'python-can reads the product code 564F4C43h' grep -qx '43181002434c4f56' "$work/said.txt"

# --- tables: downloaded, refused, stored
says 'a node without tables says so' 'nothing was sent' "$volcomp" diagnose --can vcan0
says 'tables are accepted' 'active' "$volcomp" download "$work/tables.vct" --can vcan0 --store
"$volcomp" upload "$work/back.vct" --can vcan0 > /dev/null || fail 'the tables cannot be read back'
expect 'tables come back byte for byte' cmp "$work/tables.vct" "$work/back.vct"
"$volcomp" upload - --can vcan0 2> /dev/null > "$work/back.vct" || fail 'the tables cannot be read back into a pipe'
expect 'tables come back byte for byte through a pipe' cmp "$work/tables.vct" "$work/back.vct"
# shellcheck disable=SC2016  # expanded by the shell below
says 'tables from a pipe are accepted, told in JSON' "\"crc32\": \"$(crc32_of "$work/tables.vct")\"" \
  bash -c '"$1" download - --can vcan0 --json - < "$2"' download "$volcomp" "$work/tables.vct"
says 'monitor hears the node' 'node (id 32): pre-operational' "$volcomp" monitor --can vcan0 --rate-hz 0.3 --once

cp "$work/tables.vct" "$work/damaged.vct"
printf '\377' | dd of="$work/damaged.vct" bs=1 seek=3000 conv=notrunc status=none
refuses 1 'checksum' "$volcomp" download "$work/damaged.vct" --can vcan0
says 'the last good tables stay' "CRC-32 $(crc32_of "$work/tables.vct")" "$volcomp" diagnose --can vcan0

# --- power fails; the store brings the tables back
stop_node KILL
start_node
says 'stored tables are active after a restart' "CRC-32 $(crc32_of "$work/tables.vct")" \
  "$volcomp" diagnose --can vcan0

# --- nobody there
stop_node TERM
refuses 2 'node 32' "$volcomp" diagnose --can vcan0
refuses 2 'vcan7' "$volcomp" diagnose --can vcan7
refuses 2 'vcan7' "$node" --can vcan7
