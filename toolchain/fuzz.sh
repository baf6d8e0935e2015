#!/usr/bin/env bash
# Runs libFuzzer programs and fails on the first crash, hang or sanitizer report.
#
#   toolchain/fuzz.sh PROGRAM...      each for VOLCOMP_FUZZ_SECONDS (default 10) seconds, VOLCOMP_JOBS at a time
#
# fuzz_NAME starts from tests/data/corpus/NAME, which is only read, and takes its dictionary from
# tests/data/corpus/NAME.dict. What makes a program fail is kept in build/fuzz/findings.
caller_folder=$PWD
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

readonly seconds=${VOLCOMP_FUZZ_SECONDS:-10}
readonly findings=build/fuzz/findings
readonly corpus=tests/data/corpus

# Leaves what the run printed in $2.
fuzz_one() {
  local program=$1 log=$2 name
  name=$(basename "$program")
  name=${name#fuzz_}
  local arguments=("-max_total_time=$seconds" "-artifact_prefix=$findings/${name}-" -timeout=10
    -rss_limit_mb=2048 -use_value_profile=1 -print_final_stats=1)
  [ -f "$corpus/$name.dict" ] && arguments+=("-dict=$corpus/$name.dict")
  arguments+=("$work/$name")
  [ -d "$corpus/$name" ] && arguments+=("$corpus/$name")
  mkdir -p "$work/$name"
  UBSAN_OPTIONS=print_stacktrace=1 "$program" "${arguments[@]}" > "$log" 2>&1
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  '') die "no program given: build the preset \"fuzz\" first." ;;
esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$findings"
programs=()
for program in "$@"; do
  program=$(cd "$caller_folder" && realpath -m "$program")
  { [ -f "$program" ] && [ -x "$program" ]; } || die "\"$program\" is not a program."
  programs+=("$program")
done

# As many at a time as there are processors; each leaves NAME.log and, having failed, NAME.failed.
for program in "${programs[@]}"; do
  while [ "$(jobs -rp | wc -l)" -ge "$(jobs_allowed)" ]; do wait -n || true; done
  name=$(basename "$program")
  { fuzz_one "$program" "$work/$name.log" || touch "$work/$name.failed"; } &
done
wait
failed=()
for program in "${programs[@]}"; do
  name=$(basename "$program")
  if [ -e "$work/$name.failed" ]; then
    tail -n 60 "$work/$name.log"
    failed+=("$name")
    continue
  fi
  awk -v name="$name" '
    / cov: / { for (i = 1; i < NF; ++i) if ($i == "cov:") coverage = $(i + 1) }
    /number_of_executed_units/ { runs = $2 }
    END { printf "%-28s %10s runs, %6s edges, no failure\n", name, runs, coverage }' "$work/$name.log"
done
[ ${#failed[@]} -eq 0 ] || die "${failed[*]} failed; the inputs are in $findings."
