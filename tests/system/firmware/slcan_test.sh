#!/usr/bin/env bash
# The M7 image in real time on a serial line, met by somebody else's CAN library and by the commands of this project,
# on a computer that is busy.
# shellcheck source=tests/system/firmware/common.sh
. "$(dirname "$0")/common.sh"

bash toolchain/run-firmware --real-time --serial pty m7 "$(image_of m7)" slcan > "$work/qemu.txt" 2>&1 &
board=$!
loads=()
trap 'kill "$board" "${loads[@]}" 2> /dev/null; wait "$board" 2> /dev/null; rm -rf "$work"' EXIT
# QEMU: "char device redirected to /dev/pts/3 (label serial0)".
wait_for 'QEMU names its serial line' grep -q '/dev/pts/' "$work/qemu.txt"
line=$(grep -o '/dev/pts/[0-9]*' "$work/qemu.txt")

# Whoever is busy keeps the emulated processor waiting, which must not wake its watchdog.
for ((i = 0; i < 2 * $(nproc); ++i)); do
  (while :; do :; done) &
  loads+=("$!")
done

# As told by python-can. 43h: expedited, 4 bytes: 564F4C43h, "VOLC". 4Fh: 1 byte: 0, not OPERATIONAL.
heard=$("$python" tests/system/firmware/slcan_reader.py "$line" 2>&1)
for wanted in 'heartbeat 7f' 'product code 43181002434c4f56' 'state of the node 4f00260100000000' \
  'cycles 4300260400000000'; do
  holds "python-can hears: $wanted" grep -qxF "$wanted" <<< "$heard"
done

expect 0 'PRE-OPERATIONAL' "$volcomp" diagnose --can "slcan:$line"
sleep 5
expect 0 'power was switched on' "$volcomp" diagnose --can "slcan:$line"
kill "$board"
wait "$board" 2> /dev/null
expect 2 "$line: " "$volcomp" diagnose --can "slcan:$line"
exit "$failed"
