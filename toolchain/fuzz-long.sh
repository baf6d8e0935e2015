#!/usr/bin/env bash
# Fuzzes for hours: every program in turn, again and again in slices of ten minutes, each slice going on from what
# the earlier ones found.
#
#   toolchain/fuzz-long.sh HOURS    inputs worth keeping in build/fuzz/long, failures in build/fuzz/findings
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  '' | *[!0-9]*) die "say for how many hours (a whole number)." ;;
esac
need cmake clang++
readonly slice_s=${VOLCOMP_FUZZ_SECONDS:-600} findings=build/fuzz/findings keep=build/fuzz/long
cmake --preset fuzz > /dev/null
cmake --build --preset fuzz -j "$(jobs_allowed)"
mapfile -t programs < <(find build/fuzz/tests -type f -name 'fuzz_*' -perm -u+x | sort)
[ ${#programs[@]} -gt 0 ] || die "the preset \"fuzz\" built no fuzz program."
mkdir -p "$findings"

end=$((SECONDS + $1 * 3600))
while [ "$SECONDS" -lt "$end" ]; do
  for program in "${programs[@]}"; do
    name=$(basename "$program")
    name=${name#fuzz_}
    mkdir -p "$keep/$name"
    arguments=("-max_total_time=$slice_s" "-artifact_prefix=$findings/$name-" -timeout=10 -rss_limit_mb=2048
      -use_value_profile=1)
    [ ! -f "tests/data/corpus/$name.dict" ] || arguments+=("-dict=tests/data/corpus/$name.dict")
    arguments+=("$keep/$name")
    [ ! -d "tests/data/corpus/$name" ] || arguments+=("tests/data/corpus/$name")
    "$program" "${arguments[@]}" > "$keep/$name.log" 2>&1 ||
      die "$name failed; the input is in $findings, the report in $keep/$name.log."
    printf '%s: %s inputs kept, no failure\n' "$name" "$(find "$keep/$name" -type f | wc -l)"
  done
done
