#!/usr/bin/env bash
# A program of volcomp_host alone does what the command line does: the same image, the same node, the same words.
#
#   host_alone_test.sh VOLCOMP_HOST_ALONE VOLCOMP VOLCOMP_NODE
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/../../../system/cli_common.sh"
alone=$1 volcomp=$2 node=$3
cd "$work" || exit 1

same() {
  cmp -s "$1" "$2" || { printf 'FAILED: %s and %s differ:\n' "$1" "$2"; diff -a "$1" "$2"; failed=1; }
}

"$volcomp" machine example xyfz >machine.toml
"$volcomp" simulate runs --machine machine.toml --out runs >/dev/null
expect 0 'bytes' "$alone" build-tables machine.toml alone.vct runs/runs_*.csv
"$volcomp" build-tables --machine machine.toml --runs runs/runs_*.csv --out whole.vct >/dev/null
# The command line adds its name and the time, so the images differ: what they correct is compared.
"$volcomp" simulate diagonals --machine machine.toml --out before.csv >/dev/null
"$volcomp" simulate diagonals --machine machine.toml --tables alone.vct --out after.csv >/dev/null
"$volcomp" simulate diagonals --machine machine.toml --tables whole.vct --out after_whole.csv >/dev/null
same after.csv after_whole.csv

"$alone" verify before.csv after.csv >verify_alone.txt || { echo 'FAILED: verify finds no improvement'; failed=1; }
"$volcomp" verify before.csv after.csv >verify_whole.txt
same verify_alone.txt verify_whole.txt

# The pipe is held open, so that the node does not take the end of a tool for the end of its host.
mkdir pipe
mkfifo pipe/to_node
exec 9<>pipe/to_node
"$node" --can pipe:pipe >node.txt &
node_process=$!
expect 0 'PRE-OPERATIONAL' "$alone" diagnose pipe:pipe
expect 0 'read back as written' "$alone" setup pipe:pipe machine.toml
expect 0 ' 0 of them differed before' "$volcomp" setup --machine machine.toml --can pipe:pipe --no-store
expect 0 'active: CRC-32' "$alone" download pipe:pipe alone.vct
"$alone" diagnose pipe:pipe >diagnose_alone.txt
"$volcomp" diagnose --can pipe:pipe >diagnose_whole.txt
same diagnose_alone.txt diagnose_whole.txt
kill "$node_process"
wait "$node_process"
exec 9>&-

expect 2 'no-such.toml' "$alone" build-tables no-such.toml never.vct runs/runs_X.csv
exit "$failed"
