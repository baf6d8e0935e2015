# Sourced by the scripts of this folder: moves to the project folder and offers a few helpers.
# shellcheck shell=bash
set -euo pipefail
export LC_ALL=C.UTF-8
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# die SENTENCE: ends the script with one plain sentence.
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# need COMMAND...: ends the script unless every command exists.
need() {
  local command
  for command in "$@"; do
    command -v "$command" > /dev/null ||
      die "the command \"$command\" is missing: run toolchain/setup.sh first."
  done
}

# usage: the leading comment of the script is its manual.
usage() {
  awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$0"
}

# sources PATTERN FOLDER...: our own files below the folders that exist, sorted, one a line.
sources() {
  local pattern=$1 folder
  shift
  for folder in "$@"; do
    [ -d "$folder" ] || continue
    find "$folder" -name node_modules -prune -o -type f -name "$pattern" -print
  done | sort
}

# jobs: how many processes a step may use.
jobs_allowed() {
  printf '%s\n' "${VOLCOMP_JOBS:-$(nproc)}"
}

# build_preset PRESET [CMAKE_BUILD_ARGUMENT...]: one at a time for each preset, though two steps may run at once.
build_preset() {
  local preset=$1 log=build/log/configure-$1.txt lock
  shift
  need cmake ninja flock
  mkdir -p build/log
  exec {lock}> "build/log/$preset.lock"
  flock "$lock"
  cmake --preset "$preset" > "$log" 2>&1 || { cat "$log"; return 1; }
  cmake --build --preset "$preset" -j "$(jobs_allowed)" "$@" {lock}>&-
  exec {lock}>&-
}
