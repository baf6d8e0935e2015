#!/usr/bin/env bash
# Runs every test of a folder here:
#
#   toolchain/with-vcan tests/system/run_all.sh vcan    the node on a CAN interface of the kernel; vcan0 must be up
#   tests/system/run_all.sh vcan --compute              what these compare with and needs no bus, into VOLCOMP_COMPUTED
#   tests/system/run_all.sh firmware                    the node as firmware in QEMU; presets m7 and m4 must be built
#   tests/system/run_all.sh vm                          a shell in the virtual machine of toolchain/with-vcan
#
# VOLCOMP_BUILD is the folder with the programs under test (default build/host). The last line is the
# summary of ctest, for who adds up.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1

readonly limit_s=900
arguments=("${@:2}")
tests=(tests/system/"$1"/*_test.sh)
if [ "${arguments[*]}" = --compute ]; then
  mapfile -t tests < <(grep -l '^without_bus ' "${tests[@]}")
fi
failed=0
for test in "${tests[@]}"; do
  name=$(basename "$test" .sh)
  started=$SECONDS
  if output=$(timeout --kill-after=5 "$limit_s" "$test" "${arguments[@]}" 2>&1); then
    printf 'PASSED %s (%s s)\n' "$name" "$((SECONDS - started))"
    grep -E '^(skipped|again)' <<< "$output"
  else
    printf '%s\nFAILED %s (exit code %s)\n' "$output" "$name" "$?"
    failed=$((failed + 1))
  fi
done
printf '%s%% tests passed, %s tests failed out of %s\n' \
  "$(((${#tests[@]} - failed) * 100 / ${#tests[@]}))" "$failed" "${#tests[@]}"
[ "$failed" = 0 ]
