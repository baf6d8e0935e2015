# Sourced by the tests of the command line.
# shellcheck shell=bash disable=SC2034
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# expect CODE TEXT COMMAND…: the exit code, and a text that the output must contain.
expect() {
  local code=$1 text=$2
  shift 2
  local output status
  output=$("$@" 2>&1)
  status=$?
  if [ "$status" -ne "$code" ] || ! grep -qF -- "$text" <<<"$output"; then
    printf 'FAILED: %s\n  wanted exit %s and "%s", got exit %s:\n%s\n' "$*" "$code" "$text" "$status" "$output"
    failed=1
  fi
}

# one_line COMMAND…: what goes wrong is said in one line that starts with the program's name.
one_line() {
  local output
  output=$("$@" 2>&1)
  if [ "$(wc -l <<<"$output")" -ne 1 ] || [ "${output#volcomp: }" = "$output" ]; then
    printf 'FAILED: %s must say it in one line, said:\n%s\n' "$*" "$output"
    failed=1
  fi
}

# noise COUNT: so many bytes of no format, the same in every run.
noise() {
  /usr/bin/python3 -c 'import random, sys; sys.stdout.buffer.write(random.Random(1).randbytes(int(sys.argv[1])))' "$1"
}
