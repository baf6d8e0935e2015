#!/usr/bin/env bash
# The bus that the other tests of this folder stand on: what can-utils send comes back unchanged, in
# order, to can-utils and to python-can.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# NMT start of all nodes, SYNC without data, an SDO upload request of 1000h, its answer for a servo drive (the
# bytes of CiA 301 and CiA 402), a remote frame, a 29-bit identifier.
readonly frames=(000#0100 080# 601#4000100000000000 581#4300100092010200 701#R 12345678#DEADBEEF)

# Without the time and the interface in front.
frames_in() {
  awk '{ print $3 }' "$1"
}

start candump candump -L vcan0
wait_for 'candump listens' listeners_are 1
for frame in "${frames[@]}"; do
  cansend vcan0 "$frame"
done
wait_for 'all frames are there' lines_are ${#frames[@]} "$work/candump.txt"
expect 'candump shows the frames as sent' diff <(printf '%s\n' "${frames[@]}") <(frames_in "$work/candump.txt")

cat > "$work/receive.py" << 'END'
import can

with can.Bus(interface="socketcan", channel="vcan0") as bus:
    message = bus.recv(timeout=30)
    print(f"{message.arbitration_id:03X}#{message.data.hex().upper()}")
END
start python "$python" "$work/receive.py"
receiver=$!
wait_for 'python-can listens' listeners_are 2
cansend vcan0 601#4000100000000000
expect 'python-can ends well' wait "$receiver"
expect 'python-can reads the frame' grep -qx '601#4000100000000000' "$work/python.txt"
