#!/usr/bin/env bash
# A shell below toolchain/with-vcan in the virtual machine: typed at, and fed by a pipe.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  printf 'FAILED: %s\n' "$*"
  exit 1
}

export VOLCOMP_VM_TIMEOUT=300  # so that the one that hangs says so
/usr/bin/python3 tests/system/vm/terminal.py toolchain/with-vcan --vm bash

# Every byte, and the end; nothing is read that the command does not ask for.
/usr/bin/python3 -c 'import random, sys; sys.stdout.buffer.write(random.Random(1).randbytes(1_000_000))' > "$work/bytes"
[ "$(toolchain/with-vcan --vm sha256sum < "$work/bytes")" = "$(sha256sum < "$work/bytes")" ] || fail 'a file is not the one given'
code=0
# shellcheck disable=SC2016  # for the shell inside
said=$(printf 'read -r line\nhallo\nrev <<< "$line"\nexit 5\n' | toolchain/with-vcan --vm bash) || code=$?
[ "$said,$code" = 'ollah,5' ] || fail "a shell that reads a pipe said \"$said\" and ended with $code"
[ "$(toolchain/with-vcan --vm bash -c 'cat; echo end' < /dev/null)" = end ] || fail 'an empty input has no end'
[ "$(toolchain/with-vcan --vm bash -c 'cat; echo end' <&-)" = end ] || fail 'a closed input has no end'
printf 'input by file and pipe, empty and closed\n'
