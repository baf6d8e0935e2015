#!/usr/bin/env bash
# The commands around the CAN bus as a user meets them, without a CAN interface: help, one clear
# sentence where there is no interface, the load of the bus, a recorded bus replayed.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1

for command in setup download upload diagnose replay; do
  expect 0 '--node-id' "$volcomp" "$command" --help
done
expect 0 '--axes' "$volcomp" bus-load --help
expect 0 'loopback' "$volcomp" run xyfz --help

# Without an interface.
printf 'image' >"$work/image.vct"
for arguments in "download $work/image.vct" "upload $work/got.vct" diagnose 'run xyfz --draws 0'; do
  # shellcheck disable=SC2086 # a command line in one word
  expect 2 'volcomp: no-such-can0: ' "$volcomp" $arguments --can no-such-can0
  # shellcheck disable=SC2086
  one_line "$volcomp" $arguments --can no-such-can0
done
[ -e "$work/got.vct" ] && { echo 'FAILED: an upload without a bus wrote a file'; failed=1; }

# Input that is refused before the bus is touched.
expect 2 'cannot be opened' "$volcomp" download "$work/none.vct" --can no-such-can0
: >"$work/empty.vct"
expect 2 'is empty' "$volcomp" download "$work/empty.vct" --can no-such-can0
head -c 1000000 /dev/zero >"$work/large.vct"
expect 2 'is larger' "$volcomp" download "$work/large.vct" --can no-such-can0
expect 2 '--can' "$volcomp" diagnose
expect 2 '--can' "$volcomp" run xyfz --log "$work/never.log"
expect 2 '--store' "$volcomp" download "$work/image.vct" --can no-such-can0 --store --no-activate
expect 2 '--node-id' "$volcomp" diagnose --can no-such-can0 --node-id 128

expect 0 '1200  fits' "$volcomp" bus-load --json "$work/load.json"
expect 0 '1000        115.1 ' "$volcomp" bus-load --axes 3
expect 0 'does not fit' "$volcomp" bus-load --axes 3
expect 0 'ways 1 1 1: at most 580 Hz' "$volcomp" bus-load --axes 3 --way 1
expect 0 'ways 1 1 1 0 0: at most 335 Hz' "$volcomp" bus-load --way 1,1,1,0,0
expect 0 'at most 636 Hz' "$volcomp" bus-load --axes 3 --unconfirmed
expect 2 'ways of 2 axes' "$volcomp" bus-load --axes 3 --way 1,1
expect 2 '--way' "$volcomp" bus-load --way 2
grep -q '"computed_worst_load"' "$work/load.json" || { echo 'FAILED: no load in the JSON'; failed=1; }

# A campaign with the node on the bus: the first seconds of its second machine, which is the first
# with tables. The run ends when nobody reads its log any more.
mkfifo "$work/bus.fifo"
awk '/ 000#8100/ { machine++ } machine == 2 { print; if (++lines == 60000) exit }' \
  "$work/bus.fifo" >"$work/bus.log" &
"$volcomp" run xyfz --draws 0 --volume-points 10 --can loopback --log "$work/bus.fifo" >/dev/null 2>&1
wait
expect 0 'the node did the same again' "$volcomp" replay "$work/bus.log"

# One bit of one target: a difference. The line is the 3000th target of axis 1.
line=$(grep -n ' 201#' "$work/bus.log" | sed -n '3000s/:.*//p')
sed -E "${line}s/(201#.{9})./\1$(sed -nE "${line}s/.*201#.{9}(.).*/\1/p" "$work/bus.log" | tr '0-9A-F' '89ABCDEF01234567')/" \
  "$work/bus.log" >"$work/changed.log"
cmp -s "$work/bus.log" "$work/changed.log" && { echo 'FAILED: nothing was changed'; failed=1; }
expect 1 'first difference' "$volcomp" replay "$work/changed.log" --json "$work/changed.json"
grep -q '"ok": false' "$work/changed.json" || { echo 'FAILED: the JSON knows of no difference'; failed=1; }
"$volcomp" replay - --json - <"$work/bus.log" 2>/dev/null | grep -q '"difference": null' ||
  { echo 'FAILED: a log from a pipe does not replay'; failed=1; }

# The clock of the computer was set back by an hour while candump ran: noted, with the line.
awk 'NR <= 20000 { sub(/\([0-9]+/, sprintf("(%010d", substr($1, 2) + 3600)) } 1' "$work/bus.log" >"$work/set.log"
expect 0 'line 20001: the clock of the log was set back by 3600' "$volcomp" replay "$work/set.log"

# A log that lacks a SYNC is no difference of the node, and no agreement: not judged.
line=$(grep -n ' 080#' "$work/bus.log" | sed -n '3000s/:.*//p')
sed "${line}d" "$work/bus.log" >"$work/lacks.log"
expect 2 'cannot be judged' "$volcomp" replay "$work/lacks.log"
one_line "$volcomp" replay "$work/lacks.log"

tail -n 1000 "$work/bus.log" >"$work/headless.log"
expect 2 'no start of node 32' "$volcomp" replay "$work/headless.log"
one_line "$volcomp" replay "$work/headless.log"
expect 2 'no start of node 33' "$volcomp" replay "$work/headless.log" --node-id 33
sed '5s/#/!/' "$work/bus.log" >"$work/bad.log"
expect 2 'bad.log:5: ' "$volcomp" replay "$work/bad.log"
one_line "$volcomp" replay "$work/bad.log"
expect 2 'cannot be opened' "$volcomp" replay "$work/none.log"
exit "$failed"
