#!/usr/bin/env bash
# The links of the node image: how it begins and ends on a frame pipe, and that it speaks SLCAN.
#
#   tests/target/node/links_test.sh BOARD IMAGE CASE
#
# CASE: no-pipes, quit, host-gone, nonsense, slcan
set -euo pipefail
run_firmware=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../../toolchain/run-firmware")
readonly run_firmware board=$1 image=$2 case=$3

folder=$(mktemp -d)
image_pid=
finish() {
  [ -z "$image_pid" ] || kill "$image_pid" 2> /dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
cd "$folder"

complain() {
  printf '%s: %s\n' "$case" "$*" >&2
  [ ! -f output ] || cat output >&2
  exit 1
}

# expect_end EXIT_CODE TEXT: of the image that was started in the background.
expect_end() {
  local code=0
  wait "$!" || code=$?
  image_pid=
  [ "$code" = "$1" ] || complain "ended with $code instead of $1."
  grep -q "$2" output || complain "it does not say \"$2\"."
}

# start_on_pipe: the image has opened both pipes; 3 leads to the node, 4 comes from it.
start_on_pipe() {
  mkfifo to_node from_node
  "$run_firmware" "$board" "$image" pipe > output 2>&1 &
  image_pid=$!
  exec 3> to_node 4< from_node
}

# record ID: without data, as in hal/frame_pipe.hpp.
record() {
  printf '%b\0\0\0\0\0\0\0\0\0\0\0\0' "$1"
}
readonly end_of_turn='\xfe\xff\xff\xff' quit='\xff\xff\xff\xff' id_beyond_can='\x00\x08\x00\x00'

# The answer to the first turn is the boot-up message of node 32 and the end of the node's turn.
take_first_turn() {
  local answer
  record "$end_of_turn" >&3
  answer=$(head -c 32 <&4 | od -An -v -tx1 | tr -d ' \n')
  [ "${answer:0:12}" = 200700000100 ] || complain "the first frame is not the boot-up: $answer."
  [ "${answer:32:8}" = feffffff ] || complain "the turn does not end after it: $answer."
}

# expect_line PATTERN: sooner or later; in between may come frames and the empty lines that acknowledge ours.
expect_line() {
  local line
  while IFS= read -r -d $'\r' line <&"${NODE[0]}"; do
    # shellcheck disable=SC2053  # a pattern
    [[ $line == $1 ]] && return 0
    [[ $line == t* || -z $line ]] || complain "\"$line\" came instead of \"$1\"."
  done
  complain "the line went dead."
}

case $case in
  no-pipes)
    "$run_firmware" "$board" "$image" pipe > output 2>&1 &
    expect_end 2 'There is no frame pipe'
    ;;
  quit)
    start_on_pipe
    take_first_turn
    record "$quit" >&3
    expect_end 0 'stack: [0-9]* bytes'
    ;;
  host-gone)
    start_on_pipe
    take_first_turn
    exec 3>&- 4<&-
    expect_end 2 'The other end of the frame pipe is gone'
    ;;
  nonsense)
    start_on_pipe
    take_first_turn
    record "$id_beyond_can" >&3
    expect_end 2 'not a record'
    ;;
  slcan)
    # In real time: else the node says in a moment what a busy computer reads in minutes, and has to drop frames.
    coproc NODE { exec "$run_firmware" --real-time "$board" "$image" slcan 2>&1; }
    image_pid=$NODE_PID
    printf 'V\rS8\rO\r' >&"${NODE[1]}"
    expect_line 'V[0-9][0-9][0-9][0-9]'
    expect_line ''
    expect_line ''
    expect_line 't72017F'                             # heartbeat: pre-operational
    printf 't62084000100000000000\r' >&"${NODE[1]}"  # upload of 1000h
    expect_line 't5A0843001000*'
    printf 't00020120\r' >&"${NODE[1]}"              # NMT start of node 32
    expect_line 't720105'                             # heartbeat: operational
    ;;
  *) complain 'unknown case.' ;;
esac
