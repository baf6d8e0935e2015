#!/usr/bin/env bash
# The tool as a user meets it: help, exit codes, one clear sentence for bad input, nothing half-written.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2

machine=$source_dir/host_sim/machines/xyfz.toml
expect 0 'Subcommands' "$volcomp" --help
expect 0 'volcomp 0.' "$volcomp" --version
expect 0 'xyfz' "$volcomp" list
expect 0 'good' "$volcomp" machine check "$machine"
expect 2 'subcommand' "$volcomp"
expect 2 '--draws' "$volcomp" run xyfz --draws many

# An option that takes a number takes numbers only: what is none compares with no limit.
# numbers OPTION COMMAND…: the command with what is no number behind it, and beyond what a number can be.
numbers() {
  local option=$1
  shift
  for number in nan -nan inf -inf 1e999; do
    expect 2 "$option: $number is not a number from" "$@" "$option=$number"
  done
}
# A variable of the shell that is not set is no value.
expect 2 '--out: the value is empty' "$volcomp" build-tables --machine "$machine" --runs "$work/a.csv" --out ''
expect 2 '--json: the value is empty' "$volcomp" run machine --json ''
expect 2 '--can: the value is empty' "$volcomp" run l300g --can ''
expect 2 'FILE: the value is empty' "$volcomp" machine check ''
for seed in -1 1e3 0x10 18446744073709551616 99999999999999999999; do
  expect 2 "--seed: $seed is not a whole number" "$volcomp" run machine --seed "$seed"
  expect 2 "--machine-seed: $seed is not a whole number" "$volcomp" simulate runs --machine-seed "$seed" --out "$work/never"
  expect 2 "--seed: $seed is not a whole number" "$volcomp" verify "$work/none.csv" "$work/none2.csv" --seed "$seed"
done

# What is misspelt is named, with what it may have been.
expect 2 'volcomp: unknown command "simulte", did you mean "simulate"? (known: run, ' "$volcomp" simulte
expect 2 'unknown command "chek", did you mean "check"? (known: ' "$volcomp" machine chek "$machine"
expect 2 'unknown command "frobnicate" (known: ' "$volcomp" frobnicate
expect 2 'unknown option "--mahcine", did you mean "--machine"? (all: volcomp build-tables --help)' \
  "$volcomp" build-tables --mahcine "$machine" --runs "$work/a.csv" --out "$work/never"
expect 2 'unknown option "--cycl-hz", did you mean "--cycle-hz"?' "$volcomp" simulate diagonals --out simulte --cycl-hz=50
one_line "$volcomp" simulte
one_line "$volcomp" monitor --cn vcan0

files=(--machine "$work/none.toml" --runs "$work/none.csv" --out "$work/none.vct")
numbers --temperature "$volcomp" build-tables "${files[@]}"
numbers --expires "$volcomp" build-tables "${files[@]}"
numbers --limit "$volcomp" compare "$work/none.csv" "$work/none2.csv"
numbers --rate-hz "$volcomp" monitor --log "$work/none.log"
numbers --tool-length "$volcomp" run machine
numbers --cycle-hz "$volcomp" run xyfz --can loopback
for option in limit-um device-um-per-m misalignment-mm expansion-um-per-m-K temperature-K expansion-limits-um-per-m-K from-20-K eve-um volume-um; do
  numbers "--$option" "$volcomp" verify "$work/none.csv" "$work/none2.csv"
done
for place in '0 nan 0' 'inf 0 0' '0 0 1e999'; do
  # shellcheck disable=SC2086  # three numbers
  expect 2 '--second-point: ' "$volcomp" check-lever --machine "$machine" --first "$work/a.csv" --second "$work/b.csv" --second-point $place
  # shellcheck disable=SC2086
  expect 2 '--box-mm: ' "$volcomp" verify "$work/a.csv" "$work/b.csv" --machine "$machine" --tables "$work/a.vct" --box-mm $place 1 1 1
done

expect 0 '[ManufacturerObjects]' "$volcomp" device-files --eds -
for arguments in '' '--drives 1,1,2 --eds -' '--drives 1,2 --eds -'; do
  # shellcheck disable=SC2086  # several arguments
  expect 2 'volcomp' "$volcomp" device-files $arguments
  # shellcheck disable=SC2086
  one_line "$volcomp" device-files $arguments
done

# A code that somebody read on a bus, in a log or in an answer of this program.
expect 0 'The checksum is wrong' "$volcomp" explain crc_mismatch
expect 0 'crc_mismatch (20)' "$volcomp" explain 20
expect 0 'A table image was refused' "$volcomp" explain FF10h
expect 0 'Largest step of an offset' "$volcomp" explain 0x2202
expect 0 'read but not written' "$volcomp" explain 0601:0002
expect 0 'retracting' "$volcomp" explain
expect 2 'nothing is known of "frobnicate"' "$volcomp" explain crc_mismatch frobnicate
one_line "$volcomp" explain frobnicate
# For programs: what a number may mean is told of every kind, an object with its sub-indexes.
"$volcomp" explain 20 0x2202 --json - 2>"$work/words.txt" | /usr/bin/python3 -c 'import json, sys
number, index = json.load(sys.stdin)["words"]
assert number["word"] == "20" and all(code["number"] == 20 for code in number["codes"]), number
reason, = [code for code in number["codes"] if code["kind"] == "reason"]
assert reason["name"] == "crc_mismatch" and reason["what"] and reason["remedy"], reason
found, = index["objects"]
subs = [value["sub"] for value in found["values"]]
assert not index["codes"] and found["index"] == 0x2202 and subs == sorted(set(subs)), index
assert any(value["low"] is not None and value["low"] < value["high"] for value in found["values"]), found' ||
  { echo 'FAILED: explain --json -'; failed=1; }
grep -q 'The checksum is wrong' "$work/words.txt" || { echo 'FAILED: explain says nothing for people'; failed=1; }
"$volcomp" explain --json "$work/codes.json" >/dev/null || failed=1
/usr/bin/python3 - "$work/codes.json" <<'PYTHON' || { echo 'FAILED: explain --json of all codes'; failed=1; }
import json, sys
codes = json.load(open(sys.argv[1]))["codes"]
assert {code["kind"] for code in codes} == {"reason", "status_bit", "emergency", "verdict", "abort"}
assert len({(code["kind"], code["number"]) for code in codes}) == len(codes)
assert all(code["what"] and code["label"] for code in codes)
PYTHON

touch "$work/file"
expect 2 'cannot be created' "$volcomp" run xyfz --draws 0 --report "$work/file"
one_line "$volcomp" run xyfz --draws 0 --report "$work/file"

# A gear, measured; with a machine that the user describes, and one that no table of an axis puts right.
expect 0 'l300g' "$volcomp" list
expect 0 'PASS Profile grade 8 before, 4 after' "$volcomp" run l300g --noise-free --report "$work/gear" --json "$work/gear.json" --gcode "$work/gear"
for file in gear/report.html gear/report.json gear.json gear/inspection_before.ngc gear/inspection_after.ngc; do
  [ -s "$work/$file" ] || { echo "FAILED: $file is missing"; failed=1; }
done
grep -q '"transport"' "$work/gear.json" || { echo 'FAILED: the figures do not say where the node was'; failed=1; }
expect 1 'FAIL Profile grade 8 before, 8 after' "$volcomp" run l300g --noise-free --cycle-hz 50 --path generate --errors short-arm
printf 'convention = "body"\n[Y]\nconstant = [0, 4.5, 0, 0, 0, 0]\n' >"$work/errors.toml"
expect 0 'PASS' "$volcomp" run l300g --noise-free --cycle-hz 50 --errors "$work/errors.toml"
printf 'convention = "body"\n[Y]\nconstant = [0, 4.5]\n' >"$work/bad_errors.toml"
expect 2 'bad_errors.toml:3' "$volcomp" run l300g --errors "$work/bad_errors.toml"
one_line "$volcomp" run l300g --errors "$work/bad_errors.toml"
expect 2 'cannot be opened' "$volcomp" run l300g --errors p9
expect 2 '--path' "$volcomp" run l300g --path sideways
expect 2 'the axes must be X Y B A' "$volcomp" run l300g --machine "$machine"
expect 2 'no-such-can0' "$volcomp" run l300g --can no-such-can0

# A gear of one's own, ground; beside the controller and over the bus the same is learned.
grinder=$source_dir/host_sim/machines/internal_grinder.toml
sed 's/^teeth = .*/teeth = 51/;s/^radius_mm = .*/radius_mm = 25.0/;s/^width_mm = .*/width_mm = 10.0/;s/^overrun_mm = .*/overrun_mm = 2.0/' \
  "$grinder" >"$work/grinder.toml"
grind=("$volcomp" run internal-helical --machine "$work/grinder.toml" --seeds 1)
expect 0 'transport: integrated' "${grind[@]}" --tables "$work/beside"
expect 0 'transport: CAN loopback, 500 Hz' "${grind[@]}" --can loopback --tables "$work/on_bus" --json "$work/ground.json"
diff -r "$work/beside" "$work/on_bus" || { echo 'FAILED: over the bus something else was learned'; failed=1; }
grep -q '"transport": "CAN loopback' "$work/ground.json" || { echo 'FAILED: the figures do not say where the node was'; failed=1; }
expect 2 '--wrong one-table: a node keeps a table for each direction' "${grind[@]}" --can loopback --wrong one-table
expect 2 '--can' "${grind[@]}" --log "$work/never.log"
expect 2 'no-such-can0' "${grind[@]}" --can no-such-can0
sed '0,/^name = "X"/s//name = "X"\nunits_per_mm = 1000/' "$work/grinder.toml" >"$work/coarse.toml"
expect 2 'axis X has other units' "$volcomp" run internal-helical --machine "$work/coarse.toml" --seeds 1 --can loopback
expect 2 'the machine has no [gear], [wheel] and [stroke]' "$volcomp" run internal-helical --machine "$machine"
bad_grinder() {
  sed "$1" "$grinder" >"$work/bad.toml"
  expect 2 "$2" "$volcomp" run internal-helical --seeds 1 --machine "$work/bad.toml"
  one_line "$volcomp" run internal-helical --seeds 1 --machine "$work/bad.toml"
}
bad_grinder 's/^teeth = .*/teeth = 129/' "'teeth' of [gear] must be at most 128"
bad_grinder 's/^teeth = .*/teeth = 11/' 'no_involute_at_tip'
bad_grinder 's/^teeth = .*/teeth = 4/' "'teeth'"
bad_grinder '/^teeth/d' "missing mandatory field 'teeth'"
bad_grinder 's/^helix_angle_deg = .*/helix_angle_deg = 0.0/' "'helix_angle_deg' of [gear] is 0"
bad_grinder 's/^helix_angle_deg = .*/helix_angle_deg = 46.0/' 'helix_angle'
bad_grinder 's/^width_mm = .*/width_mm = 66.0/' "'width_mm' of [gear] must be at most 65"
bad_grinder '/^width_mm/d' "missing mandatory field 'width_mm'"
bad_grinder 's/^radius_mm = .*/radius_mm = 80.0/' "'radius_mm' must be above 0 and below the tip radius of the gear, 79.787"
bad_grinder 's/^feed_mm_per_s = .*/feed_mm_per_s = 0.0/' "'feed_mm_per_s' must be from 0.1 to 60"
bad_grinder 's/^overrun_mm = .*/overrun_mm = 0.5/' "'overrun_mm' must be at least 0.898"
bad_grinder '/^\[stroke\]/,/^overrun/d' "stroke"

# The whole road of a user's own data, with the run files of a simulated campaign.
expect 0 'those of medians with noise' "$volcomp" run internal-helical --noise-free --seeds 1
expect 0 'PASS' "$volcomp" run xyfz --draws 1 --report "$work/report" --json "$work/figures.json"
for file in report/report.html report/report.json figures.json report/campaign/draw_001/runs_X.csv; do
  [ -s "$work/$file" ] || { echo "FAILED: $file is missing"; failed=1; }
done
runs=("$work"/report/campaign/draw_001/runs_*.csv)
expect 0 'CRC-32' "$volcomp" build-tables --machine "$machine" --runs "${runs[@]}" --out "$work/tables.vct"

# Bad input: exit 2, one sentence that names file and place, the last good image untouched.
cp "$work/tables.vct" "$work/before.vct"
build=("$volcomp" build-tables --machine "$machine" --runs "$work/bad.csv" "${runs[@]:1}" --out "$work/tables.vct")
damage() { sed "$1" "${runs[0]}" >"$work/bad.csv"; }

damage '4s/,\([^,]*\)$/,nan/'
expect 2 'not_finite' "${build[@]}"
one_line "${build[@]}"
damage '5s/up/sideways/'
expect 2 'bad.csv:5' "${build[@]}"
damage '1s/EXX \[mm\]/EXX/'
expect 2 'unit in brackets' "${build[@]}"
damage '1s/EAX \[rad\]/EAX [mm]/'
expect 2 'wrong kind' "${build[@]}"
damage '1s/,ECX \[rad\]//'
expect 2 'lacks the column' "${build[@]}"
damage '7d'
expect 2 'run_length' "${build[@]}"
damage '3s/^/x/'
expect 2 'not a number' "${build[@]}"
damage '1s/EXX \[mm\]/EXX [nm]/;1s/EAX \[rad\]/EAX [deg]/'
expect 0 'CRC-32' "${build[@]}"
cp "$work/before.vct" "$work/tables.vct"
: >"$work/bad.csv"
expect 2 'empty' "${build[@]}"
noise 300 >"$work/bad.csv"
expect 2 'bad.csv:' "${build[@]}"
iconv -t UTF-16 "${runs[0]}" >"$work/bad.csv"
expect 2 'the file is UTF-16' "${build[@]}"
damage '6s/,[^,]*$/,\xff\xfe/'
expect 2 'bad.csv:6' "${build[@]}"
head -c 500 "${runs[0]}" >"$work/bad.csv"
expect 2 'bad.csv:' "${build[@]}"
one_line "${build[@]}"
# A million lines, refused where the first of them is too many.
awk 'NR == 1 { print } END { for (i = 0; i < 1000000; ++i) print i ",1,up,0,0,0,0,0,0" }' "${runs[0]}" >"$work/bad.csv"
expect 2 'bad.csv:514: more than 512 targets' "${build[@]}"
for path in "$work/none.csv" "$work"; do
  expect 2 'cannot be opened' "$volcomp" build-tables --machine "$machine" --runs "$path" "${runs[@]:1}" --out "$work/tables.vct"
done
expect 2 'both hold axis X' "$volcomp" build-tables --machine "$machine" --runs "${runs[@]}" "${runs[0]}" --out "$work/tables.vct"
expect 2 'no runs given for axis Z' "$volcomp" build-tables --machine "$machine" --runs "${runs[0]}" "${runs[1]}" --out "$work/tables.vct"
expect 2 'cannot be written' "$volcomp" build-tables --machine "$machine" --runs "${runs[@]}" --out "$work/none/tables.vct"

bad_machine() {
  sed "$1" "$machine" >"$work/bad.toml"
  expect 2 "$2" "$volcomp" machine check "$work/bad.toml"
  one_line "$volcomp" machine check "$work/bad.toml"
}
bad_machine '/^convention/d' "missing mandatory field 'convention'"
bad_machine '/^side/d' "missing mandatory field 'side'"
bad_machine '0,/^kappa/{/^kappa/d}' "missing mandatory field 'kappa'"
bad_machine '0,/^sensed_point_mm/{/^sensed_point_mm/d}' "missing mandatory field 'sensed_point_mm'"
bad_machine 's/^a_xy_rad.*/a_xy_rad = 26.25/' 'unit_suspected'
bad_machine 's/250.0, 0.0, 550.0/0.25, 0.0, 0.55/' 'unit_suspected'
bad_machine 's/^convention.*/convention = "mine"/' 'must be one of'
bad_machine 's/^limit_mm.*/limit_mm = -1.0/' "'limit_mm' must be from"
bad_machine 's/^id = .*/id = nan/' "'id' must be a whole number"
bad_machine 's/^name = "XYFZ"/name = /' 'not valid TOML'
bad_machine 's/^refine = 8/refin = 8/' "unknown field 'refin'"
bad_machine 's/^on = "Y slide"/on = "nowhere"/' 'no earlier [[body]]'
expect 2 'cannot be opened' "$volcomp" machine check "$work/none.toml"
head -c 900 "$machine" >"$work/bad.toml"
expect 2 'bad.toml:25: not valid TOML' "$volcomp" machine check "$work/bad.toml"
printf 'name = "\377\376"\n' >"$work/bad.toml"
expect 2 'bad.toml:1: not UTF-8' "$volcomp" machine check "$work/bad.toml"
: >"$work/bad.toml"
expect 2 'missing mandatory field' "$volcomp" machine check "$work/bad.toml"

# A machine by its chain: what follows from its file, and the same machine simulated.
trunnion=$source_dir/host_sim/machines/trunnion.toml
for name in internal_grinder l300g trunnion xyfz yk7280; do
  expect 0 "  $name " "$volcomp" list
done
expect 0 'workpiece: base - Y - A - C' "$volcomp" machine check "$trunnion"
expect 0 'w-C-A-Y-b-X-Z-t' "$volcomp" machine show "$trunnion"
expect 0 'EX0C EY0C EA0C EB0C' "$volcomp" machine show "$trunnion"
expect 0 'least authority 1.000' "$volcomp" machine show "$trunnion"
expect 0 'A C hold the axis of the tool' "$volcomp" machine show "$trunnion"
sed 's/^orienting.*//' "$trunnion" >"$work/upright.toml"
expect 0 'reported only; A C could turn the axis of the tool' "$volcomp" machine show "$work/upright.toml"
"$volcomp" machine show --json "$work/facts.json" "$trunnion" >/dev/null
/usr/bin/python3 - "$work/facts.json" <<'PYTHON' || { echo 'FAILED: machine show --json'; failed=1; }
import json, sys
facts = json.load(open(sys.argv[1]))
# The lower-body array of bed, Y, A, C, X, Z.
assert facts["lower_body"] == [0, 1, 2, 3, 1, 5], facts["lower_body"]
assert facts["orientation"]["rotary_axes"] == ["A", "C"]
assert facts["orientation"]["axes"] == ["A", "C"] and facts["orientation"]["corrected"] is True
assert facts["axes"][0]["units_per_mm"] == 1e6 and facts["axes"][3]["scale"] == [512, 1]
PYTHON
expect 0 'PASS' "$volcomp" run machine --places 20 --report "$work/own" --json "$work/own.json"
for file in own/report.html own/report.json own.json; do
  [ -s "$work/$file" ] || { echo "FAILED: $file is missing"; failed=1; }
done
expect 2 '--cycle-hz requires --can' "$volcomp" run machine --cycle-hz 100
# Several machines: with perfect instruments less is left of each figure than with realistic ones.
expect 0 'of 4 machines are good' "$volcomp" run machine --seeds 4 --places 20 --json "$work/noisy.json"
expect 0 'of 4 machines are good' "$volcomp" run machine --seeds 4 --places 20 --noise-free --json "$work/perfect.json"
/usr/bin/python3 - "$work/noisy.json" "$work/perfect.json" <<'PYTHON' || { echo 'FAILED: run machine --seeds'; failed=1; }
import json, sys
noisy, perfect = (json.load(open(name)) for name in sys.argv[1:])
assert len(noisy["figures"]) == len(perfect["figures"]) > 4
for with_noise, without in zip(noisy["figures"], perfect["figures"]):
    assert with_noise["figure"] == without["figure"]
    assert without["after_median_um"] < with_noise["after_median_um"], (with_noise, without)
    assert without["after_least_um"] <= without["after_median_um"] <= without["after_most_um"]
PYTHON
expect 2 '--seeds excludes --can' "$volcomp" run machine --seeds 2 --can loopback
bad_chain() {
  sed "$1" "$trunnion" >"$work/bad.toml"
  expect 2 "$2" "$volcomp" machine check "$work/bad.toml"
  one_line "$volcomp" machine show "$work/bad.toml"
}
bad_chain 's/w-C-A-Y-b-X-Z-t/w-C-A-Y-X-Z-t/' "'b' is missing"
bad_chain 's/w-C-A-Y-b-X-Z-t/w-C-A-Y-b-X-Z-Y-t/' "'Y' appears more than once"
bad_chain 's/w-C-A-Y-b-X-Z-t/w-C-A-Y-b-X-B-Z-t/' "axis B of 'chain' has no [[axis]] table"
bad_chain 's/w-C-A-Y-b-X-Z-t/w-C-A-Y-b-X-S-Z-t/' "'S' is not known"
bad_chain 's/^node_id = 3$/node_id = 2/' 'axis Y and axis Z both have the node id 2'
expect 2 'cannot be opened' "$volcomp" run machine --machine "$work/none.toml"

cmp -s "$work/before.vct" "$work/tables.vct" || { echo 'FAILED: a refused build touched the last good image'; failed=1; }
leftover=$(find "$work" -name '*.tmp')
[ -z "$leftover" ] || { echo "FAILED: left behind: $leftover"; failed=1; }
exit "$failed"
