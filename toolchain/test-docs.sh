#!/usr/bin/env bash
# Does what pages of the documentation tell their reader to do, word for word; tests/system/run_docs.py says how a page is
# marked for it.
#
#   toolchain/test-docs.sh            the pages written for it, and those about the papers with their figures
#   toolchain/test-docs.sh PAGE...    these; a page with commands for vcan0 runs below toolchain/with-vcan
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
esac
pages=("$@")
readonly given=${#pages[@]}
[ ${#pages[@]} -gt 0 ] || pages=(docs/getting-started.md docs/verification.md docs/command-line.md)
build_preset host --target volcomp volcomp-node
# shellcheck disable=SC2016  # expanded by the shell that runs there
readonly in_path='PATH=$PWD/build/host/host_sim:$PWD/build/host/firmware:$PATH exec /usr/bin/python3 tests/system/run_docs.py "$@"'
for page in "${pages[@]}"; do
  if /usr/bin/python3 tests/system/run_docs.py --list "$page" | grep -q ' vcan0'; then
    bash toolchain/with-vcan bash -c "$in_path" run_docs --needs vcan0 "$page" < /dev/null
  else
    bash -c "$in_path" run_docs "$page"
  fi
done
if [ "$given" -eq 0 ]; then
  /usr/bin/python3 tests/system/papers_test.py build/host/host_sim/volcomp .
fi
