#!/usr/bin/env bash
# Runs every test and check of the project, goes on after a step that fails, and names all that failed at the end.
#
#   toolchain/test.sh               everything
#   toolchain/test.sh --quick       format, build and tests of the host only
#   toolchain/test.sh --step NAME   one step (may be repeated)
#   toolchain/test.sh --only FOLDER what belongs to a folder, for instance comp/tables: its format, its unit tests, built
#                                   by the preset "dev", where a change compiles only what includes it
#
# Steps, in this order:
#   setup       install what is missing
#   format      clang-format over all C++ files
#   scripts     shellcheck over the scripts
#   arrows      includes follow the order of the rooms, without a circle
#   build       the optimized host build
#   test        its tests
#   proofs      no heap, exceptions, globals, recursion ... in the libraries and images of every target
#   can         the tests that need a CAN interface of the kernel, below toolchain/with-vcan, and its shell; beside the next step
#   asan        built with clang, tests with the address and undefined-behaviour sanitizers
#   coverage    what of the target code those tests have run, at least 95 % of the branches; table in
#               build/host-asan/coverage.txt
#   boards      the firmware and its tests, executed in QEMU
#   evidence    sizes, stack and instructions of the images, measured, compared with docs/evidence.md; beside the next step
#   tidy        clang-tidy
#   loop        the firmware in QEMU in the loop with the simulated machine; beside the next step
#   cppcheck    cppcheck over comp, hal and firmware
#   fuzz        each fuzz program for VOLCOMP_FUZZ_SECONDS (default 10) seconds
#   bench       the benchmarks are built; our ticks on this computer beside what others compute (tests/bench/host_bench.py);
#               how often intervals hold the truth, in few campaigns (tests/bench/interval_coverage.cpp),
#               and function by function what is identified (tests/bench/function_coverage.cpp);
#               what identification of a machine's errors costs (tests/bench/identification_bench.cpp)
#
# VOLCOMP_JOBS limits the processes (default: the number of processors). The last line says how many
# tests passed and failed over all configurations; a failed check counts as one failed test.
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

readonly all_steps=(setup format scripts arrows build test proofs can asan coverage boards evidence tidy loop cppcheck fuzz bench)
readonly quick_steps=(format build test)
# Emulate one processor most of the time: each runs beside the step after it.
readonly one_processor_steps=(can evidence loop)
readonly code_folders=(comp hal firmware host_sim tests)
readonly logs=build/log

# Shows failures, the summary and every hundredth test that passed.
test_preset() {
  local log=$logs/ctest-$1.txt
  need ctest
  ctest --preset "$1" -j "$(jobs_allowed)" --no-tests=error 2>&1 | tee "$log" |
    awk '/^ *Start +[0-9]+:/ { next } / Passed +[0-9.]+ sec/ && ++passed % 100 { next } { print; fflush() }'
}

step_setup() {
  bash toolchain/setup.sh
}

step_format() {
  local files
  need clang-format
  mapfile -t files < <(sources '*.[ch]pp' "${code_folders[@]}"; sources '*.inl' "${code_folders[@]}")
  [ ${#files[@]} -gt 0 ] || die "there is no C++ file to check."
  clang-format --dry-run -Werror "${files[@]}"
  printf '%s files\n' "${#files[@]}"
}

step_scripts() {
  local files
  need shellcheck
  mapfile -t files < <(sources '*.sh' toolchain "${code_folders[@]}")
  files+=(toolchain/with-vcan toolchain/vm/init .ci/run)
  shellcheck -x "${files[@]}"
  printf '%s files\n' "${#files[@]}"
}

step_arrows() {
  need python3
  python3 toolchain/arrows.py --self-test
  python3 toolchain/arrows.py
}

step_build() {
  build_preset host
}

# The steps that use the host build bring it up to date, so that none judges an old one.
step_test() {
  build_preset host
  test_preset host
}

step_can() {
  local way
  need aarch64-linux-gnu-g++ qemu-system-aarch64
  build_preset host
  build_preset a53 --target volcomp-node
  way=$(bash toolchain/with-vcan --how)
  printf 'way to vcan0: %s\n' "$way"
  export VOLCOMP_BUILD=$PWD/build/host VOLCOMP_COMPUTED=$PWD/build/host/without-bus VOLCOMP_VM_TIMEOUT=1500
  rm -rf "$VOLCOMP_COMPUTED"
  mkdir -p "$VOLCOMP_COMPUTED"
  bash tests/system/run_all.sh vcan --compute
  bash toolchain/with-vcan bash tests/system/run_all.sh vcan < /dev/null 2>&1 | tee "$logs/ctest-can.txt"
  bash toolchain/with-vcan --vm --how > /dev/null
  bash tests/system/run_all.sh vm 2>&1 | tee "$logs/ctest-vm.txt"
}

step_proofs() {
  bash toolchain/evidence.sh --self-test
  bash toolchain/evidence.sh --proofs
}

step_asan() {
  need clang++
  build_preset host-asan
  rm -rf build/host-asan/profile
  test_preset host-asan
}

step_coverage() {
  need python3
  python3 toolchain/coverage.py build/host-asan
}

step_boards() {
  local board
  need arm-none-eabi-g++ qemu-system-arm aarch64-linux-gnu-g++ qemu-system-aarch64
  build_preset host
  for board in m7 m4 a53; do
    build_preset "$board"
    test_preset "$board"
  done
}

step_loop() {
  local board
  need arm-none-eabi-g++ qemu-system-arm
  build_preset host
  for board in m7 m4; do
    build_preset "$board" --target volcomp-node
  done
  bash tests/system/run_all.sh firmware 2>&1 | tee "$logs/ctest-firmware.txt"
}

step_evidence() {
  bash toolchain/evidence.sh
}

step_tidy() {
  need python3
  build_preset host
  python3 toolchain/tidy.py --self-test
  python3 toolchain/tidy.py build/host
}

step_cppcheck() {
  local files
  need cppcheck python3
  mapfile -t files < <(sources '*.[ch]pp' comp hal firmware/embed/c firmware/canopen firmware/node |
    python3 toolchain/not_included.py)
  [ ${#files[@]} -gt 0 ] || die "there is no C++ file of the target to check."
  cppcheck --quiet --std=c++17 --language=c++ --enable=warning,performance,portability --inline-suppr \
    --inconclusive --suppress=missingInclude --suppress=missingIncludeSystem --suppress=unmatchedSuppression \
    --error-exitcode=1 -I . -j "$(jobs_allowed)" "${files[@]}"
  printf '%s files and what they include\n' "${#files[@]}"
}

step_fuzz() {
  local programs
  need clang++
  build_preset fuzz
  mapfile -t programs < <(find build/fuzz/tests -type f -name 'fuzz_*' -perm -u+x | sort)
  [ ${#programs[@]} -gt 0 ] || die "the preset \"fuzz\" built no fuzz program."
  bash toolchain/fuzz.sh "${programs[@]}"
}

step_bench() {
  need valgrind python3
  build_preset host --target volcomp_bench volcomp_host_bench volcomp_interval_coverage volcomp_function_coverage volcomp_identification_bench
  python3 tests/bench/host_bench.py build/host/tests/bench/volcomp_host_bench
  build/host/tests/bench/volcomp_interval_coverage --campaigns 12 --draws 300 --sizes 3 --whole-campaigns 200
  build/host/tests/bench/volcomp_function_coverage --campaigns 100
  build/host/tests/bench/volcomp_identification_bench tests/data/plan_plate.toml --repetitions 3
}

# tests_of FOLDER: the folders of tests that lie as it does, or, where it has none, as the nearest folder above it.
tests_of() {
  local folder=${1#tests/} found
  while :; do
    mapfile -t found < <(cd tests && find "$folder" -name CMakeLists.txt -printf '%h\n' 2> /dev/null | sort)
    [ ${#found[@]} -eq 0 ] || break
    [[ $folder == */* ]] || die "there are no tests of $1."
    folder=${folder%/*}
  done
  printf 'tests/%s\n' "${found[@]}"
}

# only FOLDER: it and its tests, for the inner loop; no check of the whole is replaced by it.
only() {
  local folder=${1%/} tests files
  [ -d "$folder" ] || die "there is no folder \"$1\"."
  need clang-format ctest
  tests_of "$folder" > "$logs/only.txt"
  mapfile -t tests < "$logs/only.txt"
  mapfile -t files < <(for pattern in '*.[ch]pp' '*.inl'; do sources "$pattern" "$folder" "${tests[@]}"; done | sort -u)
  [ ${#files[@]} -eq 0 ] || clang-format --dry-run -Werror "${files[@]}"
  build_preset dev --target "${tests[@]/%//all}"
  for folder in "${tests[@]}"; do
    ctest --test-dir "build/dev/$folder" -j "$(jobs_allowed)" --no-tests=error --output-on-failure --progress
  done
}

# Adds the ctest summary of each log; a skipped test is neither passed nor failed.
count_tests() {
  local log
  for log in "$logs"/ctest-*.txt; do
    [ -f "$log" ] && cat "$log"
  done | awk '
    / tests passed, [0-9]+ tests? failed out of / { failed += $4; passed += $NF - $4 }
    /\*\*\*Skipped/ { --passed }
    END { print passed + 0, failed + 0 }'
}

finish() {
  local step passed failed
  read -r passed failed < <(count_tests)
  if [ ${#failed_steps[@]} -gt 0 ]; then
    [ "$failed" -ge ${#failed_steps[@]} ] || failed=${#failed_steps[@]}
    printf '\n'
    for step in "${failed_steps[@]}"; do
      printf 'The step "%s" failed; repeat it with toolchain/test.sh --step %s.\n' "$step" "$step"
    done
  else
    printf '\nAll steps passed in %s s.\n' "$SECONDS"
  fi
  printf '%s passed, %s failed\n' "$passed" "$failed"
  [ ${#failed_steps[@]} -eq 0 ]
}

steps=()
while [ $# -gt 0 ]; do
  case $1 in
    --quick) steps=("${quick_steps[@]}") ;;
    --step)
      [ $# -ge 2 ] || die "--step needs the name of a step (try --help)."
      shift
      [[ " ${all_steps[*]} " == *" $1 "* ]] || die "there is no step \"$1\"; the steps are: ${all_steps[*]}."
      steps+=("$1")
      ;;
    --only)
      [ $# -ge 2 ] || die "--only needs a folder (try --help)."
      mkdir -p "$logs"
      only "$2"
      exit
      ;;
    -h | --help) usage; exit 0 ;;
    *) die "unknown argument \"$1\" (try --help)." ;;
  esac
  shift
done
[ ${#steps[@]} -gt 0 ] || steps=("${all_steps[@]}")

# run_step NAME: a subshell outside of any condition, since only there "set -e" ends a step at its first failing command.
run_step() {
  local started=$SECONDS status
  set +e
  (
    # What emulates a processor keeps the time of a bus.
    [ -z "$beside" ] || renice -n 10 -p "$BASHPID" > /dev/null
    set -e
    "step_$1"
  ) 2>&1
  status=$?
  printf '%s: %s s\n' "$1" "$((SECONDS - started))"
  return "$status"
}

begin_beside() {
  printf 'beside the next step\n'
  run_step "$1" > "$logs/step-$1.txt" &
  beside=$1
}

end_beside() {
  [ -n "$beside" ] || return 0
  wait "$!" || failed_steps+=("$beside")
  printf '\n%s, meanwhile:\n' "$beside"
  cat "$logs/step-$beside.txt"
  beside=
}

mkdir -p "$logs"
rm -f "$logs"/ctest-*.txt
set +e
number=0 failed_steps=() beside=''
for step in "${steps[@]}"; do
  number=$((number + 1))
  printf '\n[%s/%s] %s\n' "$number" "${#steps[@]}" "$step"
  if [[ " ${one_processor_steps[*]} " == *" $step "* ]] && [ "$number" -lt "${#steps[@]}" ]; then
    begin_beside "$step"
    continue
  fi
  run_step "$step"
  status=$?
  [ "$status" = 0 ] || failed_steps+=("$step")
  end_beside
  # Nothing can be judged without what the setup installs.
  [[ " ${failed_steps[*]} " != *" setup "* ]] || break
done
finish
