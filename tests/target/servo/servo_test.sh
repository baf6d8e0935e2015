#!/usr/bin/env bash
# The servo example on a board prints the offsets that this computer computes for the same path, to the last bit.
#
#   tests/target/servo/servo_test.sh BOARD IMAGE HOST_PROGRAM TABLE_IMAGE
set -euo pipefail
run_firmware=$(dirname "${BASH_SOURCE[0]}")/../../../toolchain/run-firmware
readonly run_firmware board=$1 image=$2 host_program=$3 tables=$4

complain() {
  printf 'servo_test.sh: %s\n' "$*" >&2
  exit 1
}

[ -x "$host_program" ] || complain "there is no $host_program to compare with: build the preset \"host\" first."
expected=$("$host_program" "$tables")
output=$("$run_firmware" "$board" "$image") || complain "the image ended with $?: $output"
printf 'on %s:\n%s\n' "$board" "$output"

# The board says more than the computer: what it costs.
common=$(head -n "$(wc -l <<< "$expected")" <<< "$output")
[ "$common" = "$expected" ] || complain "this computer says otherwise: $expected"

# The tables matter: with nothing to correct every line would agree, too.
grep -q 'largest [1-9][0-9]\{4,\}' <<< "$expected" || complain 'no offset reaches 10 um.'
