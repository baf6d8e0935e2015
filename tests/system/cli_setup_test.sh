#!/usr/bin/env bash
# A new node is set up from a machine file, over a frame pipe: what is printed, what the node then holds, what survives
# its power failure, and everything that is refused.
#
#   cli_setup_test.sh VOLCOMP VOLCOMP_NODE SOURCE_FOLDER
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$(realpath "$1")
node=$(realpath "$2")
source_dir=$(realpath "$3")
cd "$work" || exit 1

"$volcomp" machine example trunnion >machine.toml
"$volcomp" machine example xyfz >other.toml

# start_node NAME [OPTION…]: volcomp-node behind pipe:NAME, its process in $node_process. The pipe is held open, so that the
# node does not take the end of a tool for the end of its host.
start_node() {
  local name=$1
  shift
  mkdir -p "$name"
  [ -p "$name/to_node" ] || mkfifo "$name/to_node"
  exec 9<>"$name/to_node"
  "$node" --can "pipe:$name" "$@" >"$name/output.txt" &
  node_process=$!
}

stop_node() {
  kill "$1" "$node_process"
  wait "$node_process" 2>/dev/null
  exec 9>&-
}

# one_value JSON OBJECT: value, what was there before and what was read back.
one_value() {
  /usr/bin/python3 - "$1" "$2" <<'PYTHON'
import json, sys
rows = [row for row in json.load(open(sys.argv[1]))["objects"] if row["object"] == sys.argv[2]]
print(*[f'{row["value"]} {row["unit"]} {row.get("before")} {row.get("read_back")}' for row in rows])
PYTHON
}

# is EXPECTED SENTENCE ACTUAL
is() {
  [ "$1" = "$3" ] || { printf 'FAILED: %s: wanted "%s", got "%s"\n' "$2" "$1" "$3"; failed=1; }
}

# --- help, and the plan without a bus
expect 0 '--dry-run' "$volcomp" setup --help
expect 0 'nothing is sent' "$volcomp" setup --machine machine.toml --dry-run --json plan.json
expect 0 '2201h:04  Largest offset (axis A)' "$volcomp" setup --machine machine.toml --dry-run
is '683565 2^-32 turn None None' 'the limit of A in the plan' "$(one_value plan.json 2201h:04)"
# 0.2 m/s² where the file states nothing: 3200 nm per 4 ms and 4 ms. Corrections have a seventh of the 10 mm/s of 2202h.
expect 0 'offset of X: at most 1.428 mm/s and 200 mm/s2 (3200 per period and period)' \
  "$volcomp" setup --machine machine.toml --dry-run
/usr/bin/python3 -c 'import json
plan = json.load(open("plan.json"))
written = [row["value"] for row in plan["objects"] if row["object"] == "2209h:01"]
assert written == [0, 3200], written
assert plan["offsets"][0]["acceleration_per_period2"] == 3200 and not plan["offsets"][0]["coarse"], plan["offsets"]' ||
  { echo 'FAILED: the acceleration in the plan'; failed=1; }
expect 0 'cycle of 10000 us' "$volcomp" setup --machine machine.toml --dry-run --cycle-hz 100
"$volcomp" setup --machine - --dry-run --json - <machine.toml 2>/dev/null | grep -q '"period_us": 4000' ||
  { echo 'FAILED: the plan cannot stand in a pipe'; failed=1; }

# --- a new node
start_node new --store new/store
expect 0 'read back as written' "$volcomp" setup --machine machine.toml --can pipe:new --json first.json
is '5001  0 5001' 'the machine id, before and after' "$(one_value first.json 2000h:01)"
is '683565 2^-32 turn 200000 683565' 'the limit of A, before and after' "$(one_value first.json 2201h:04)"
grep -q '"stored": true' first.json || { echo 'FAILED: the JSON says nothing of the store'; failed=1; }
expect 0 ' 0 of them differed before' "$volcomp" setup --machine machine.toml --can pipe:new
stop_node -KILL
# Power has failed.
start_node new --store new/store
expect 0 ' 0 of them differed before' "$volcomp" setup --machine machine.toml --can pipe:new --no-store
expect 0 'axis 5' "$volcomp" diagnose --can pipe:new

# --- its tables, too; and a node of another machine is none of this one
"$volcomp" simulate runs --machine other.toml --out runs >simulate.txt
"$volcomp" build-tables --machine other.toml --runs runs/runs_*.csv --out other.vct >build.txt
expect 2 'other.vct: tables of machine 1001' "$volcomp" setup --machine machine.toml --can pipe:new --tables other.vct
expect 2 'belongs to machine 5001' "$volcomp" setup --machine other.toml --can pipe:new
one_line "$volcomp" setup --machine other.toml --can pipe:new
expect 0 ' 0 of them differed before' "$volcomp" setup --machine machine.toml --can pipe:new --no-store
stop_node -TERM

start_node second --store second/store
expect 0 'active: CRC-32' "$volcomp" setup --machine other.toml --can pipe:second --tables other.vct
stop_node -KILL
start_node second --store second/store
expect 0 'active tables:         CRC-32' "$volcomp" diagnose --can pipe:second
stop_node -TERM

# --- tables alone tell the machine, too
start_node tables
expect 0 'active' "$volcomp" download other.vct --can pipe:tables
expect 2 'has the tables of machine 1001' "$volcomp" setup --machine machine.toml --can pipe:tables --no-store

# --- a node without store, and without an answer
expect 2 'has no store' "$volcomp" setup --machine other.toml --can pipe:tables
one_line "$volcomp" setup --machine other.toml --can pipe:tables
expect 0 'not stored' "$volcomp" setup --machine other.toml --can pipe:tables --no-store
expect 2 'node 33 does not answer' "$volcomp" setup --machine other.toml --can pipe:tables --node-id 33
stop_node -TERM

# --- units and bits of a drive
sed 's/^units_per_turn = .*/units_per_turn = 360000/' machine.toml >degrees.toml
expect 0 'Units of the drive per turn (axis A)' "$volcomp" setup --machine degrees.toml --dry-run
sed '0,/^name = "C"/s//name = "C"\nunits_per_turn = 4294967295/' machine.toml >lost.toml
expect 2 'beyond them the turn is lost' "$volcomp" setup --machine lost.toml --dry-run
sed '0,/^name = "X"/s//name = "X"\ndrive = "elmo_gold"/' machine.toml >named.toml
expect 2 'axis X needs referenced_mask' "$volcomp" setup --machine named.toml --dry-run
one_line "$volcomp" setup --machine named.toml --dry-run
sed -i 's/^drive = .*/&\nreferenced_mask = 4096/' named.toml
expect 0 '1000h' "$volcomp" setup --machine named.toml --dry-run

# --- input that is refused before the bus is touched
grep -v -e '^node_id = 32' -e '^\[bus\]' -e '^cycle_hz' machine.toml >no_bus.toml
expect 2 'no_bus.toml: there is no [bus]' "$volcomp" setup --machine no_bus.toml --can pipe:new
one_line "$volcomp" setup --machine no_bus.toml --can pipe:new
grep -v '^cycle_hz' machine.toml >no_cycle.toml
expect 2 'no_cycle.toml: [bus] has no cycle_hz' "$volcomp" setup --machine no_cycle.toml --can pipe:new
sed 's/^cycle_hz = .*/cycle_hz = 5000/' machine.toml >fast.toml
expect 2 "fast.toml:$(grep -n '^cycle_hz' fast.toml | cut -d: -f1): 'cycle_hz' must be" "$volcomp" setup --machine fast.toml --dry-run
expect 2 'none.toml' "$volcomp" setup --machine none.toml --can pipe:new
expect 2 'there is no such folder' "$volcomp" setup --machine machine.toml --can pipe:/no/such/folder
expect 2 'no-such-can0: ' "$volcomp" setup --machine machine.toml --can no-such-can0
one_line "$volcomp" setup --machine machine.toml --can no-such-can0
expect 2 'needs --can' "$volcomp" setup --machine machine.toml
expect 2 'no node to be met' "$volcomp" setup --machine machine.toml --can loopback
expect 2 'node 3 is the drive of axis Z' "$volcomp" setup --machine machine.toml --can pipe:new --node-id 3
expect 2 '--cycle-hz' "$volcomp" setup --machine machine.toml --dry-run --cycle-hz nan
expect 2 'is empty' "$volcomp" setup --machine other.toml --can pipe:new --tables /dev/null
printf 'no image' >letter.vct
expect 2 'letter.vct: ' "$volcomp" setup --machine other.toml --can pipe:new --tables letter.vct
expect 2 'cannot take the place of an input' "$volcomp" setup --machine machine.toml --dry-run --json machine.toml

# Every machine that comes with the program can be set up.
for machine in "$source_dir"/host_sim/machines/*.toml; do
  expect 0 'nothing is sent' "$volcomp" setup --machine "$machine" --dry-run
done
exit "$failed"
