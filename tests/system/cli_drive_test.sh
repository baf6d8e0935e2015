#!/usr/bin/env bash
# volcomp drive as a user meets it: data sheets that come with it and of his own, a bus without anybody, wrong words.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$(realpath "$1")
source_dir=$(realpath "$2")
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
expect 1 'which this node does not know yet' "${check[@]}" --eds eyou

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

exit "$failed"
