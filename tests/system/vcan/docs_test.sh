#!/usr/bin/env bash
# A stranger with the page for beginners, a bus and nothing else: every command of it, word for word.
# shellcheck source=tests/system/vcan/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

programs=$(realpath "$build")
PATH=$programs/host_sim:$programs/firmware:$PATH "$python" tests/system/run_docs.py --needs vcan0 docs/getting-started.md
