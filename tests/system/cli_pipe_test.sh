#!/usr/bin/env bash
# The node as a process of its own behind a frame pipe, turn by turn: needs no CAN and no clock, so
# every run is the same to the last byte.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$(realpath "$1")
node=$2

# The slower the cycle, the fewer there are; what is compared does not depend on it.
campaign=("$volcomp" run xyfz --draws 0 --volume-points 10 --cycle-hz 50)

# start_node FOLDER: volcomp-node in the background, its process in $node_process.
start_node() {
  mkdir -p "$1"
  "$node" --can "pipe:$1" >"$1/output.txt" &
  node_process=$!
}

# frames_in LOG: how many it holds so far.
frames_in() {
  { wc -l <"$1"; } 2>/dev/null || echo 0
}

# --- a campaign: figures as without a bus of its own, the log replays
start_node "$work/first"
expect 0 'PASS' "${campaign[@]}" --can "pipe:$work/first" --json "$work/pipe.json" --log "$work/pipe.log"
wait "$node_process" || { echo 'FAILED: the node did not end well when its host was gone'; failed=1; }
expect 0 'PASS' "${campaign[@]}" --can loopback --json "$work/loopback.json"
diff <(grep -v '"transport"' "$work/pipe.json") <(grep -v '"transport"' "$work/loopback.json") ||
  { echo 'FAILED: other figures over the pipe than over the loopback bus'; failed=1; }
expect 0 'the node did the same again' "$volcomp" replay "$work/pipe.log"

# --- a gear: every touch through another process, and every figure the same
start_node "$work/gear"
expect 0 'PASS' "$volcomp" run l300g --noise-free --cycle-hz 50 --can "pipe:$work/gear" --json "$work/gear_pipe.json"
wait "$node_process" || { echo 'FAILED: the node did not end well after the gear'; failed=1; }
expect 0 'PASS' "$volcomp" run l300g --noise-free --cycle-hz 50 --json "$work/gear_loopback.json"
diff <(grep -v '"transport"' "$work/gear_pipe.json") <(grep -v '"transport"' "$work/gear_loopback.json") ||
  { echo 'FAILED: another gear over the pipe than over the loopback bus'; failed=1; }

# --- service tools
# The pipe is held open, so that the node does not take the end of a tool for the end of its host.
mkdir "$work/second"
mkfifo "$work/second/to_node"
exec 9<>"$work/second/to_node"
start_node "$work/second"
expect 0 'PRE-OPERATIONAL' "$volcomp" diagnose --can "pipe:$work/second"
expect 0 'nothing was sent' "$volcomp" diagnose --can "pipe:$work/second"
kill "$node_process"
wait "$node_process"
exec 9>&-

# --- a node that dies in the middle
start_node "$work/third"
"${campaign[@]}" --can "pipe:$work/third" --log "$work/third/log" >"$work/third/run.txt" 2>&1 &
campaign_process=$!
# Some thousand frames: it moves. The log takes its place at the end.
growing_log=$work/third/log.$campaign_process.tmp
while kill -0 "$campaign_process" 2>/dev/null && [ "$(frames_in "$growing_log")" -lt 20000 ]; do
  sleep 0.05
done
kill -9 "$node_process"
wait "$campaign_process"
status=$?
if [ "$status" -ne 2 ] || ! grep -qx "volcomp: pipe:$work/third: the node at the other end is gone" "$work/third/run.txt"; then
  printf 'FAILED: without its node the campaign ended with %s and said:\n' "$status"
  cat "$work/third/run.txt"
  failed=1
fi

[ -z "$(find "$work/third" -name 'log*')" ] || { echo 'FAILED: half a log was left behind'; failed=1; }

# --- input that cannot be used
one_line "$volcomp" diagnose --can pipe:/no/such/folder
expect 2 'there is no such folder' "$volcomp" diagnose --can pipe:/no/such/folder
expect 2 'there is no such folder' "$node" --can pipe:/no/such/folder
expect 2 'no-such-can: ' "$node" --can no-such-can
expect 2 '--can is required' "$node"
expect 2 '--node-id' "$node" --can can0 --node-id 128
expect 0 'volcomp-node ' "$node" --version
printf 'a letter' > "$work/letter"
expect 2 'the file does not have the size of the store' "$node" --can pipe:/no/such/folder --store "$work/letter"
expect 2 'there is no such folder' "$node" --can pipe:/no/such/folder --store "$work/new.store"
expect 2 'needs a folder' "$volcomp" diagnose --can pipe:
expect 2 'No such file' "$volcomp" diagnose --can slcan:/dev/no-such-line
expect 2 'neither a serial line nor a socket' "$volcomp" upload "$work/never.vct" --can slcan:/dev/null
expect 2 'no node to be met' "$volcomp" diagnose --can loopback
expect 2 'there is no firmware for such a board' "${campaign[@]}" --firmware m3
expect 2 'no such file' "${campaign[@]}" --firmware m7 --firmware-image /no/such.elf
expect 2 '--firmware' "${campaign[@]}" --firmware m7 --can loopback
expect 2 '--firmware' "$volcomp" run xyfz --cycle-hz 50
expect 2 '--firmware' "$volcomp" run xyfz --firmware-image "$work/none.elf"
touch "$work/image.elf"
expect 2 'is not installed' /usr/bin/env PATH=/nowhere "${campaign[@]}" --firmware m7 --firmware-image "$work/image.elf"
exit "$failed"
