#!/usr/bin/env bash
# volcomp drive as a user meets it: data sheets that come with it and of his own, a bus without anybody, wrong words.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$(realpath "$1")
source_dir=$(realpath "$2")
drive_on_pipe=$(realpath "$3")
export XDG_STATE_HOME=$work/state
check=("$volcomp" drive check)

# --- every drive that comes with the program is checked, and stands in the page with its way
for eds in "$source_dir"/host_sim/drives/*.eds; do
  name=$(basename "$eds" .eds)
  expect 1 'cyclic synchronous position' "${check[@]}" --eds "$name" --json "$work/$name.json"
  way=$(/usr/bin/python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["way"])' "$work/$name.json")
  grep -qE "^\|[^|]*\| \`$name\` \| ${way}[ ,]" "$source_dir/docs/drives.md" ||
    { echo "FAILED: docs/drives.md does not say way $way of $name"; failed=1; }
done
expect 1 'by PDO; not in a TPDO' "${check[@]}" --eds epos4_0170
expect 1 'RPDO2 hears 305h: an offset there would be taken for 6040h, 6060h' "${check[@]}" --eds epos4_0170 --node 5
expect 1 'way 1 (forwarded target)' "${check[@]}" --eds eyou

# --- the user's own file; a linear axis; standard input
sed 's/^DefaultValue=0xFF410000/DefaultValue=0x00B50000/' "$source_dir/host_sim/drives/nanotec_cl4e.eds" >"$work/own.eds"
cmp -s "$work/own.eds" "$source_dir/host_sim/drives/nanotec_cl4e.eds" && { echo 'FAILED: own.eds is no other file'; failed=1; }
expect 1 'the drive does not tell how many units a turn has' "${check[@]}" --eds "$work/own.eds"
expect 1 'a unit is 2.78 um' "${check[@]}" --eds nanotec_cl4e --feed 10
expect 1 'by PDO; not in a TPDO' "${check[@]}" --eds - <"$work/own.eds"
holds_json() { /usr/bin/python3 -c 'import json, sys; d = json.load(sys.stdin); sys.exit(not (d["way"] == 0 and d["confirmed"] is False and d["missing"]))'; }
"${check[@]}" --eds nanotec_cl4e --json - 2>/dev/null | holds_json || { echo 'FAILED: JSON of drive check'; failed=1; }

# --- what cannot be used
expect 2 'no such drive; there are elmo_gold, epos4_0150' "${check[@]}" --eds epos5
expect 2 'none.eds: cannot be opened' "${check[@]}" --eds ./none.eds
expect 2 'drive check needs --can or --eds, one of them' "${check[@]}"
expect 2 'drive check needs --can or --eds, one of them' "${check[@]}" --eds eyou --can vcan9
expect 2 'describes no object' "${check[@]}" --eds /dev/null
noise 5000 >"$work/noise.eds"
expect 2 'noise.eds: ' "${check[@]}" --eds "$work/noise.eds"
sed 's/^DataType=.*/DataType=x/' "$work/own.eds" >"$work/untyped.eds"
expect 2 'untyped.eds: describes no object' "${check[@]}" --eds "$work/untyped.eds"
expect 2 'loopback is a bus inside volcomp run' "${check[@]}" --can loopback
expect 2 'loopback is a bus inside volcomp run' "$volcomp" drive list --can loopback
expect 2 '' "${check[@]}" --eds eyou --node 0
expect 2 '' "${check[@]}" --eds eyou --node 128
expect 2 '' "$volcomp" drive
one_line "${check[@]}" --eds epos5
one_line "${check[@]}"

# --- a data sheet that is its own result
cp "$work/own.eds" "$work/kept.eds"
expect 2 'a result cannot take the place of an input' "${check[@]}" --eds "$work/kept.eds" --json "$work/kept.eds"
cmp -s "$work/kept.eds" "$work/own.eds" || { echo 'FAILED: the data sheet was overwritten'; failed=1; }

# --- a drive on a bus: its state is in bus/state, what is left of commands in state/volcomp
mkdir "$work/bus"
bus=pipe:$work/bus
journals=$work/state/volcomp
"$drive_on_pipe" epos4_0170 3 "$work/bus" &
drive=$!
trap 'touch "$work/bus/quit" "$work/bus/go"; wait "$drive"; rm -rf "$work"' EXIT
told=0
# met: waits until the drive has seen the last command go.
met() {
  told=$((told + 1))
  for _ in $(seq 500); do
    [ "$(cat "$work/bus/sessions" 2>/dev/null)" = "$told" ] && return
    sleep 0.02
  done
  echo "FAILED: the drive did not see the end of command $told"
  failed=1
}
await() {
  for _ in $(seq 500); do [ -e "$1" ] && return; sleep 0.02; done
  echo "FAILED: no $1"
  failed=1
}
unchanged() {
  cmp -s "$work/bus/state" "$work/before" || { echo "FAILED: the drive is not as it was after $1"; failed=1; }
  [ -z "$(ls "$journals" 2>/dev/null)" ] || { echo "FAILED: a journal is left after $1"; failed=1; }
}
await "$work/bus/state"
cp "$work/bus/state" "$work/before"

expect 1 'whether a PDO takes it, only trying tells' "${check[@]}" --can "$bus" --node 3; met
expect 2 'objects of a drive are written only on consent: --yes' "${check[@]}" --can "$bus" --node 3 --try </dev/null; met
unchanged 'a trial without consent'
expect 1 'by PDO; not in a TPDO' "${check[@]}" --can "$bus" --node 3 --try --yes; met
unchanged 'a trial'
expect 1 'yes: 6040h alone' "${check[@]}" --can "$bus" --node 3 --try --move --yes; met
expect 1 'moves no demand value while disabled: not known' "${check[@]}" --can "$bus" --node 3 --move --yes; met
unchanged 'a trial with --move'
expect 2 '--try and --move need a drive on a bus' "${check[@]}" --eds eyou --try
expect 2 'node 4 does not answer' "${check[@]}" --can "$bus" --node 4 --timeout 50 --try --yes; met

# Stands still at its 12th write: the command is in the middle of its trial then.
in_the_middle() {
  rm -f "$work/bus/stalled"
  echo 12 >"$work/bus/stall_after"
  "${check[@]}" --can "$bus" --node 3 --try --yes >"$work/out" 2>&1 &
  command=$!
  await "$work/bus/stalled"
  rm "$work/bus/stall_after"
}
for signal in TERM INT; do
  in_the_middle
  [ -n "$(ls "$journals")" ] || { echo 'FAILED: no journal during a trial'; failed=1; }
  kill "-$signal" "$command"
  touch "$work/bus/go"
  wait "$command" && { echo "FAILED: $signal did not end the command"; failed=1; }
  met
  unchanged "SIG$signal"
done

in_the_middle
kill -KILL "$command"
wait "$command" 2>/dev/null
touch "$work/bus/go"
met
cmp -s "$work/bus/state" "$work/before" && { echo 'FAILED: nothing was changed when the command was killed'; failed=1; }
[ -n "$(ls "$journals")" ] || { echo 'FAILED: a killed command left no journal'; failed=1; }
expect 1 'an interrupted command has left changes in node 3' "${check[@]}" --eds eyou
cp -r "$journals" "$work/kept"
expect 0 'node 3: what an interrupted command had changed is as it was' "$volcomp" drive list --can "$bus"; met
unchanged 'the next command'

# Another drive answers there now: the list, and the journal stays.
sed -i 's/^drive 3 [0-9a-f]*/drive 3 00000001/' "$work"/kept/*.journal
/usr/bin/python3 - "$work"/kept/*.journal <<'PYTHON'
import sys, zlib
with open(sys.argv[1]) as file:
    lines = [line.rsplit(' ', 1)[0] for line in file]
with open(sys.argv[1], 'w') as file:
    file.writelines(f'{line} {zlib.crc32(line.encode()):08x}\n' for line in lines)
PYTHON
cp "$work"/kept/*.journal "$work/other.journal"
expect 2 'power cycle also restores: 1010h was not touched' "$volcomp" drive list --can "$bus" --journal "$work/other.journal"; met
expect 2 'another drive answers now (1018h)' "$volcomp" drive list --can "$bus" --journal "$work/other.journal"; met
expect 2 '  1603h:00 = 02h' "$volcomp" drive list --can "$bus" --journal "$work/other.journal"; met
unchanged 'another drive'

# --- its PDOs for a way
forward=("$volcomp" drive forward --can "$bus" --node 3)
expect 2 'needs --way or --off, one of them' "${forward[@]}"
expect 2 'needs --way or --off, one of them' "${forward[@]}" --way 1 --off
expect 2 'only on consent: --yes' "${forward[@]}" --way 1 </dev/null; met
unchanged 'drive forward without consent'
expect 2 'node 32 must be PRE-OPERATIONAL, and sends no heartbeat' "${forward[@]}" --way 1 --axis 1 --yes; met
unchanged 'drive forward for an axis of a node that is not there'
expect 2 '--axis' "${forward[@]}" --way 1 --node-id 33 --yes
expect 2 '--axis' "${forward[@]}" --way 1 --axis 6 --yes
expect 0 'RPDO2: 303h {607Ah}, type 1' "${forward[@]}" --way 1 --yes; met
[ -z "$(ls "$journals")" ] || { echo 'FAILED: a journal is left after drive forward'; failed=1; }
cmp -s "$work/bus/state" "$work/before" && { echo 'FAILED: drive forward changed nothing'; failed=1; }
expect 1 '303h, type 1: 607Ah' "${check[@]}" --can "$bus" --node 3; met
expect 0 'RPDO1: 203h {6040h, 607Ah}' "${forward[@]}" --off --yes; met
expect 0 'RPDO2: 303h {60B0h}, type 1' "${forward[@]}" --way 0 --yes --json "$work/forward.json"; met
grep -q '"way": 0' "$work/forward.json" || { echo 'FAILED: JSON of drive forward'; failed=1; }

exit "$failed"
