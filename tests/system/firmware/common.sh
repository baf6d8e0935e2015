# Sourced by the tests of this folder: the node as firmware on emulated boards, together with the host tool.
# The images and the host tool must have been built (presets host, m7 and m4).
# shellcheck shell=bash disable=SC2034
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "${BASH_SOURCE[0]}")/../cli_common.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/../../.." || exit 1

# The folder with the programs under test; beside it those with the images.
build=$(realpath "${VOLCOMP_BUILD:-build/host}")
volcomp=$build/host_sim/volcomp
linux_node=$build/firmware/volcomp-node
python=/usr/bin/python3 # python-can is Debian's

# image_of BOARD: the image of the node.
image_of() {
  printf '%s\n' "$build/../$1/firmware/volcomp-node-$1.elf"
}

# knots_of BOARD: how many a table of its node may have.
knots_of() {
  case $1 in
    m4) echo 64 ;;
    *) echo 128 ;;
  esac
}

# holds SENTENCE COMMAND...: the sentence says what is true if the command succeeds.
holds() {
  local sentence=$1 output
  shift
  output=$("$@" 2>&1) && return
  printf 'FAILED: %s\n  %s\n%s\n' "$sentence" "$*" "$output"
  failed=1
}

# wait_for SENTENCE COMMAND...: until the command succeeds, at most a minute.
wait_for() {
  local sentence=$1 attempt
  shift
  for ((attempt = 0; attempt < 600; ++attempt)); do
    "$@" 2> /dev/null && return
    sleep 0.1
  done
  printf 'FAILED: waited in vain for: %s\n' "$sentence"
  exit 1
}

# lines_are_more_than NUMBER FILE
lines_are_more_than() {
  [ "$(wc -l < "$2")" -gt "$1" ]
}
