#!/usr/bin/env bash
# Lets the image commit one misdeed and compares exit code and report with what they should be. That the report
# names the right function is judged by addr2line.
#
#   tests/target/faults/faults_test.sh BOARD IMAGE MISDEED EXIT_CODE TEXT [FUNCTION]
#
# Each line of TEXT begins a line of the output, in this order. FUNCTION is where the first PC points to.
set -euo pipefail
run_firmware=$(dirname "${BASH_SOURCE[0]}")/../../../toolchain/run-firmware
readonly run_firmware board=$1 image=$2 misdeed=$3 expected_code=$4 expected_text=$5 function=${6:-}

complain() {
  printf '%s: %s\nThe output was:\n%s\n' "$misdeed" "$*" "$output" >&2
  exit 1
}

# Where nobody listens to semihosting an image has no end: it runs until it has said its last line.
run_without_host() {
  local line
  coproc QEMU { exec "$run_firmware" --no-semihosting "$board" "$image" 2>&1; }
  while IFS= read -r line <&"${QEMU[0]}"; do
    printf '%s\n' "$line"
    [[ $line != 'restarted after'* ]] || break
  done
  kill "$QEMU_PID"
}

run() {
  case $misdeed in
    without-host) run_without_host ;;
    other-board) "$run_firmware" "$([ "$board" = m7 ] && echo m4 || echo m7)" "$image" ;;
    *) "$run_firmware" "$board" "$image" "$misdeed" ;;
  esac
}

code=0
output=$(run 2>&1) || code=$?
[ "$code" = "$expected_code" ] || complain "ended with $code instead of $expected_code."

rest=$output
while IFS= read -r line; do
  rest=$(awk -v line="$line" 'found { print } index($0, line) == 1 { found = 1 } END { exit !found }' <<< "$rest") ||
    complain "the line \"$line\" is missing, or comes too early."
done <<< "$(printf '%b' "$expected_text")"

if [ -n "$function" ]; then
  pc=$(sed -n 's/^  PC \(0x[0-9a-f]*\) .*/\1/p' <<< "$output" | head -n 1)
  addr2line=arm-none-eabi-addr2line
  [ "$board" != a53 ] || addr2line=aarch64-linux-gnu-addr2line
  found=$("$addr2line" -f -C -e "$image" "$pc" | head -n 1)
  [[ $found == *"$function"* ]] || complain "PC $pc lies in $found, not in $function."
fi
