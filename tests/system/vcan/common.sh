# Sourced by the tests of this folder, which run below toolchain/with-vcan: vcan0 is up, no time is promised.
# shellcheck shell=bash
set -euo pipefail
export LC_ALL=C.UTF-8
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

# The folder with the programs under test; python-can is Debian's and so needs Debian's interpreter.
# shellcheck disable=SC2034  # for the tests
readonly build=${VOLCOMP_BUILD:-build/host} python=/usr/bin/python3
work=$(mktemp -d)
only_compute=no
[ "${1:-}" != --compute ] || only_compute=yes
background=()

end_test() {
  [ ${#background[@]} -eq 0 ] || kill "${background[@]}" 2> /dev/null || true
  wait
  rm -rf "$work"
}
trap end_test EXIT

# fail SENTENCE: ends the test, showing what the processes in the background have said.
fail() {
  printf 'FAILED: %s\n' "$*"
  tail -n 20 "$work"/*.txt 2> /dev/null || true
  exit 1
}

# expect SENTENCE COMMAND...: the sentence says what is true if the command succeeds.
expect() {
  local sentence=$1
  shift
  "$@" || fail "expected: $sentence"
}

# start NAME COMMAND...: runs in the background until the end of the test, printing into $work/NAME.txt;
# $! is its process.
start() {
  local output=$work/$1.txt
  shift
  "$@" > "$output" 2>&1 &
  background+=("$!")
}

# wait_for SENTENCE COMMAND...: until the command succeeds, at most 30 s.
wait_for() {
  local sentence=$1 attempt
  shift
  for ((attempt = 0; attempt < 300; ++attempt)); do
    "$@" && return
    sleep 0.1
  done
  fail "waited in vain for: $sentence"
}

# listeners_are NUMBER: so many raw CAN sockets without a narrower filter listen on vcan0.
listeners_are() {
  [ "$(grep -c '^ *vcan0 .* raw' /proc/net/can/rcvlist_all)" = "$1" ]
}

# node_listens: the node with id 32 has told the kernel which frames it wants.
node_listens() {
  grep -q '^ *vcan0 *620 .* raw' /proc/net/can/rcvlist_sff
}

# lines_are NUMBER FILE: the file has so many lines.
lines_are() {
  [ "$(wc -l < "$2")" = "$1" ]
}

# without_bus FILE COMMAND...: runs a command that needs no vcan0 and leaves the file in $work. An emulated processor
# takes thirty times as long: called with --compute, a test does no more than these and leaves the files in the folder
# VOLCOMP_COMPUTED; called without, it takes them from there, where there is one.
without_bus() {
  local file=$1 kept
  kept=${VOLCOMP_COMPUTED:-}/$(basename "$0" .sh).$1
  shift
  if [ -n "${VOLCOMP_COMPUTED:-}" ] && [ "$only_compute" = no ]; then
    cp "$kept" "$work/$file"
    return
  fi
  "$@" > "$work/without_bus.txt" 2>&1 || fail "without a bus: $*"
  [ "$only_compute" = no ] || cp "$work/$file" "$kept"
}

# bus_begins: after the last of these.
bus_begins() {
  [ "$only_compute" = no ] || exit 0
}

# crc32_of IMAGE: the CRC-32 in hexadecimal that names it; its last four bytes hold the same.
crc32_of() {
  "$python" -c 'import sys, zlib; print("%08X" % zlib.crc32(open(sys.argv[1], "rb").read()[:-4]))' "$1"
}
