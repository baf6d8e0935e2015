#!/usr/bin/env bash
# The runner of the board tests reports what it must: runner_test.sh RUN_FIRMWARE BOARD IMAGE MISCOUNTED_IMAGE
set -uo pipefail
run_firmware=$1 board=$2 image=$3 miscounted=$4
failures=0

expect() {
  local what=$1
  shift
  "$@" && return
  printf 'not so: %s\n' "$what"
  failures=$((failures + 1))
}
said() { grep -qF -- "$1" <<< "$output"; }
silent() { ! said "$1"; }
in_order() { [[ $output == *"$1"$'\n'*"$2"$'\n'* ]]; }

output=$("$run_firmware" "$board" "$image" < /dev/null)
status=$?
expect "exit code 1 where a test fails, not $status" [ "$status" = 1 ]
while read -r name; do
  case $name in
    Passes.* | *.Passes*) expect "$name passes" said "[       OK ] $name" ;;
    *) expect "$name fails" said "[  FAILED  ] $name" ;;
  esac
done < <(sed -nE 's/^TEST(_F)?\(([A-Za-z]+), ([A-Za-z]+)\).*/\2.\3/p' "$(dirname "$0")/self_test.cpp")
tests=$(grep -cE '^TEST(_F)?\(' "$(dirname "$0")/self_test.cpp")
expect "$tests tests are counted" said "[==========] $tests tests"
expect '3 tests are counted as passed' said '[  PASSED  ] 3 tests'
expect 'the place of a failure' said "self_test.cpp:$(grep -n 'TEST(Fails, Less)' "$(dirname "$0")/self_test.cpp" | cut -d: -f1): Failure: 2 < 2"
expect 'the values of a comparison' said 'does not hold: { 1, 2 } against { 1, 3 }'
expect 'decimals and exact bits' said '2.50000000e+00 (0x1.4p+1) against -0'
expect 'the allowance of NEAR' said 'allowed 2.50000000e-01'
expect 'the words of the test' said ': shown 42'
expect 'both traces, the inner one first' in_order ': inner' ': outer'
expect 'no trace that has ended' silent 'gone'
expect 'that an assertion ends its test' silent 'reached_after_an_assertion'
expect 'that a test without set-up is not run' silent 'reached_without_set_up'
expect 'that a fatal failure of a helper is known' said 'helper_gave_up=1'
expect 'that TearDown runs after SetUp' said 'set_up_before_tear_down=1'
expect 'nothing of a check that holds' silent 'never shown'

output=$("$run_firmware" "$board" "$miscounted" < /dev/null)
status=$?
expect "exit code 2 where a test is missing, not $status" [ "$status" = 2 ]
expect 'that it says so' said 'contain another number of tests'
[ "$failures" = 0 ]
