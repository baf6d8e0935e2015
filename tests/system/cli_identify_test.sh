#!/usr/bin/env bash
# volcomp identify and plan as a user meets them: cases of an independent implementation as files, what is wrong in a
# measurement is found and named, and what cannot be used is refused with its place.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
cases=$source_dir/tests/data/cases/identification.json
here=$source_dir/tests/system
cd "$work" || exit 1

# files CASE: the plan of a case, in a folder of its own.
files() {
  mkdir -p "$1"
  /usr/bin/python3 "$here/identification_files.py" "$cases" "$1" "$1" || { echo "FAILED: files of $1"; failed=1; }
}

# --- values, uncertainties, chi-square and outliers through files, of every kind but centres and runs
for case in id_solve_01 id_solve_02 id_solve_06 id_solve_07 id_solve_09 id_solve_10 id_solve_11 id_solve_noisy_00 id_solve_noisy_04 \
  id_solve_noisy_05 id_solve_noisy_07 id_solve_noisy_08 id_solve_robust_00 id_solve_robust_01; do
  files "$case"
  options=(--no-leave-out)
  [[ $case != *robust* ]] || options+=(--robust)
  (cd "$case" && "$volcomp" identify plan.toml "${options[@]}" --json identified.json -o tables.vct >text.txt 2>&1)
  code=$?
  # Chi-square of these is beyond its limit: outliers, and a prior that the truth does not follow.
  [ "$code" -le 1 ] || { echo "FAILED: $case ended with $code: $(cat "$case/text.txt")"; failed=1; }
  /usr/bin/python3 "$here/identification_check.py" "$case/identified.json" "$case/wanted.json" ||
    { echo "FAILED: $case"; failed=1; }
done
expect 0 'axis' "$volcomp" dump id_solve_01/tables.vct

# --- left out by the same estimator: with weights, too, a set-up less takes chi-square away
"$volcomp" identify id_solve_robust_00/plan.toml --robust --json robust.json >robust.txt 2>&1
/usr/bin/python3 -c 'import json; assert all(s["leave_out"] > 0 for s in json.load(open("robust.json"))["setups"])' ||
  { echo 'FAILED: left out with weights'; failed=1; }

# --- a set-up that has moved after half of its readings is named: by 20 µm, which is refused, and by 3 µm
files id_solve_noisy_00
cd id_solve_noisy_00 || exit 1
moved() {
  /usr/bin/python3 - "$1" <<'PYTHON'
import sys
lines = open("setup_1.csv").read().splitlines()
half = len(lines) // 2
moved = [",".join(l.split(",")[:-1] + [repr(float(l.split(",")[-1]) + float(sys.argv[1]))]) for l in lines[half:]]
open("moved.csv", "w").write("\n".join(lines[:half] + moved) + "\n")
PYTHON
}
sed 's/setup_1.csv/moved.csv/' plan.toml >moved.toml
moved 0.020
expect 2 '[contradictory] The others do not predict "T1".' "$volcomp" identify moved.toml
moved 0.003
expect 1 'the others do not predict it' "$volcomp" identify moved.toml --json moved.json
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: which set-up has moved'; failed=1; }
import json
found = json.load(open("moved.json"))
# Chi-square of the rest, over its degrees of freedom, without each set-up.
rest = {s["name"]: (found["chi2"] - s["leave_out"]) / (found["dof"] - s["leave_out_dof"]) for s in found["setups"]}
assert min(rest, key=rest.get) == "T1" and rest["T1"] < 1.3 and min(v for k, v in rest.items() if k != "T1") > 3, rest
PYTHON

# --- a bar or an R-test in a unit a thousand times too large shows nothing but readings that are too good
sed 's/^u_um = \(.*\)/u_um = \1e3/; s/^machine_um.*//' plan.toml >quiet.toml
expect 0 'leave less than a tenth of their uncertainty: is a unit wrong?' "$volcomp" identify quiet.toml --no-leave-out
"$volcomp" identify plan.toml | grep -q 'is a unit wrong' && { echo 'FAILED: readings as good as stated are doubted'; failed=1; }

# --- refusals
refused() {
  expect 2 "$@" --json never.json
  one_line "${@:2}" --json never.json
  [ ! -e never.json ] || { echo "FAILED: never.json was written"; failed=1; rm never.json; }
}
changed() { sed "$1" plan.toml >bad.toml; }
bad() { refused "$1" "$volcomp" identify bad.toml; }
table() { sed "$1" setup_0.csv >bad.csv; sed 's/setup_0.csv/bad.csv/' plan.toml >bad.toml; }
changed '/^positions/d'
bad "'positions'"
changed 's/^compensation.*/compensation = "1234ABCD"/; s/^positions.*/positions = "command"/'
bad 'measure with compensation switched off'
changed 's/^compensation.*/compensation = "on"/'
bad 'the CRC-32 of the image that was active'
sed 's/^compensation.*/compensation = "1234ABCD"/; s/^positions.*/positions = "actual"/' plan.toml >active.toml
expect 0 'Measured with the tables 1234ABCD at work' "$volcomp" identify active.toml --no-leave-out
changed '/^temperature_C/d'
bad "'temperature_C'"
changed 's/^file = "machine.toml"/file = "none.toml"/'
bad 'none.toml: cannot be opened'
changed 's/X = 2/W = 2/'
bad 'no axis W'
changed 's/X = 2/X = 0/'
bad "'X'"
changed 's/kind = "tracer"/kind = "laser"/'
bad "'kind'"
changed '0,/u_um = .*/s//u_um = 0/'
bad "'u_um' must be larger than 0"
changed 's/"T1"/"T0"/'
bad 'set-up "T0": A name occurs twice. [duplicate_id]'
changed '/^reference = true/d'
bad '[reference_stylus]'
changed 's/^gauge = .*/gauge = [["Y", "EX"], ["Y", "EZ"]]/'
sed -i 's/^u_mm = .*//' bad.toml
bad '[not_observable] Not seen: '
# With what is known of the styli it can be solved, and is hardly known.
changed 's/^gauge = .*/gauge = [["Y", "EX"], ["Y", "EZ"]]/'
expect 0 'warning: 1 combinations of these are held by nothing but what is known of the styli' "$volcomp" identify bad.toml
changed 's/^gauge = .*/gauge = [["Y", "EX"], ["Y", "EZ"], ["X", "EZ"], ["X", "EX"]]/'
bad '[gauge_excess]'
table '1s/length \[mm\]/length [um]/'
bad '[unit_suspected]'
table '1s/tip/top/'
bad 'bad.csv:1: '
table '1s/length \[mm\]/length [rad]/'
bad 'bad.csv:1: column "length [rad]" has a unit of the wrong kind'
table '1s/,direction Z,length/,direction Z,direction Z/'
bad 'bad.csv:1: '
table '5s/,S[0-3],/,S9,/'
bad 'bad.csv:5: the plan has no stylus "S9" [unknown_reference]'
table '5s/,[+-],/,up,/'
bad 'bad.csv:5: direction'
table '5s/[^,]*$/nan/'
bad 'bad.csv:5: length: "nan" must be finite'
table '5s/,[^,]*$//'
bad 'bad.csv:5: 7 cells instead of 8'
table '5,999d'
bad 'set-up "T0": A set-up has no more readings than unknowns of its own. [too_few_observations]'
table '3s/^[^,]*/5000/'
bad '[position_out_of_range]'
noise 2000 >bad.csv
bad 'bad.csv'
expect 2 'cannot take the place of an input' "$volcomp" identify plan.toml --json setup_0.csv

# --- plans that come with the program
expect 2 'there is no plan "none"; the plans are: every_kind, ' "$volcomp" plan --example none
expect 2 'PLAN or --example' "$volcomp" plan
expect 0 'every_kind' "$volcomp" list

# --- plans, without a reading: what is unseen is named as the cases have it
cut -d, -f1-7 setup_0.csv >positions.csv
sed 's/setup_[0-3].csv/positions.csv/' plan.toml >positions.toml
refused 'not every set-up has readings' "$volcomp" identify positions.toml
cd ..
for case in id_rank_00 id_rank_01 id_rank_05 id_rank_06 id_rank_14 id_rank_21; do
  files "$case"
  (cd "$case" && "$volcomp" plan plan.toml --json predicted.json >text.txt 2>&1)
  code=$?
  /usr/bin/python3 - "$case" "$code" <<'PYTHON' || { echo "FAILED: $case: $(head -n 5 "$case/text.txt")"; failed=1; }
import json, sys
case, code = sys.argv[1], int(sys.argv[2])
found, wanted = json.load(open(f"{case}/predicted.json")), json.load(open(f"{case}/wanted.json"))["out"]
assert found["unseen"] == wanted["unseen"] and found["together"] == wanted["together"], (found["together"], wanted["together"])
assert found["nullity_functions"] == wanted["nullity_functions"]
assert code == (0 if found["solvable"] else 1)
text = open(f"{case}/text.txt").read()
for group in wanted["together"]:
    assert ", ".join(group) in text, group
PYTHON
done
# --- the plan of a ball plate: unknowns, rows and uncertainty as an independent implementation predicts them, which draws
# 1500 places at random: 0.73 µm rms, 1.42 µm at 95 % of them.
"$volcomp" machine example xyfz >xyfz.toml
grep -v '^file = "touches' "$source_dir/tests/data/plan_plate.toml" | sed 's/^calibrated = true/&\nradius_mm = 10/' >plate.toml
expect 0 'Set-ups, each adding most to those before' "$volcomp" plan plate.toml --json plate.json --points points.csv
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: ball plate'; failed=1; }
import json
found = json.load(open("plate.json"))
assert (found["unknowns"], found["rows"]) == (292, 1705), (found["unknowns"], found["rows"])
u = found["u_volume"]
assert abs(u["rms_um"] - 0.73) < 0.03 and abs(u["p95_um"] - 1.42) < 0.1, u
rms = [step["rms_u_um"] for step in found["order"]]
# Every set-up adds; all of them with a weak prior tell no less than without one, at other places.
assert len(rms) == 12 and rms == sorted(rms, reverse=True) and rms[-1] < 1.1 * u["rms_um"], rms
assert len(found["unreached"]) > 20, found["unreached"]
import csv
points = list(csv.DictReader(open("points.csv")))
assert len(points) == sum(step["observations"] for step in found["order"]), len(points)
# Room for ball and tip on either side.
assert all(-487 <= float(p["X [mm]"]) <= -13 and -287 <= float(p["Y [mm]"]) <= -13 and -387 <= float(p["Z [mm]"]) <= -13 for p in points)
PYTHON
# --- reports: both files, the figures of the text in them; never in the place of an input
expect 0 'report: predicted/report.html' "$volcomp" plan plate.toml --report predicted
(cd id_solve_noisy_00 && "$volcomp" identify plan.toml --report found >text.txt 2>&1)
[ $? -le 1 ] || { echo "FAILED: report: $(cat id_solve_noisy_00/text.txt)"; failed=1; }
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: reports'; failed=1; }
import json
for folder, wanted in (("predicted", {"functions", "volume-XY", "volume-XZ", "volume-YZ", "order", "plan", "weakest"}),
                       ("id_solve_noisy_00/found", {"functions", "volume-XY", "residuals", "leave-out", "plan", "weakest"})):
    page = open(f"{folder}/report.html").read()
    report = json.load(open(f"{folder}/report.json"))
    assert report["title"] in page and len(page) > 100000
    ids = {s.get("id") for s in report["sections"]}
    assert wanted <= ids, wanted - ids
    assert {i["what"] for i in report["inputs"]} >= {"plan", "machine file"}
u = json.load(open("plate.json"))["u_volume"]["rms_um"]
assert f"u {u:.2f} µm rms" in json.load(open("predicted/report.json"))["verdict"]["text"]
PYTHON
mkdir -p taken
cp plate.toml xyfz.toml taken
mv taken/plate.toml taken/report.json
before=$(cksum taken/report.json)
expect 2 'cannot take the place of an input' "$volcomp" plan taken/report.json --report taken
[ "$before" = "$(cksum taken/report.json)" ] || { echo 'FAILED: a report took the place of its plan'; failed=1; }
[ ! -e taken/report.html ] || { echo 'FAILED: half a report'; failed=1; }

# --- the program of touches, run by a controller with a machine that has no errors: what it logs is read, and says so
"$volcomp" plan plate.toml --program plate.ngc >plate.txt 2>&1 || { echo "FAILED: program: $(cat plate.txt)"; failed=1; }
expect 2 'cannot take the place of an input' "$volcomp" plan plate.toml --program plate.toml
expect 2 'cannot take the place of an input' "$volcomp" plan plate.toml --program xyfz.toml
sed '/^radius_mm = 10/d' plate.toml >no_radius.toml
refused_program() { expect 2 "$1" "$volcomp" plan "$2" --program never.ngc; [ ! -e never.ngc ] || { echo 'FAILED: never.ngc'; failed=1; }; }
refused_program "has no 'radius_mm'" no_radius.toml
sed 's/"placement 3"/"placement (3)"/' plate.toml >names.toml
refused_program 'cannot stand in a program' names.toml
cp id_solve_noisy_00/plan.toml id_solve_noisy_00/setup_*.csv id_solve_noisy_00/machine.toml .
refused_program 'there is no set-up of kind centre or touch' plan.toml
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: the program as a controller runs it'; failed=1; }
import json, re
at, rows, pauses = {}, [], 0
for line in open("plate.ngc"):
    line = line.strip()
    log = re.fullmatch(r"\(LOG,(.*)\)", line)
    if log:
        # The tip stops at the contact: 3 mm from where probing begins, 2 mm from the target.
        latched = {5061 + "XYZ".index(a): (2 * begin[a] + 3 * at[a]) / 5 for a in "XYZ"} if rows else {}
        rows.append(re.sub(r"#(\d+)", lambda p: f"{latched[int(p[1])]:.6f}", log[1]))
    elif re.match(r"G(0|1|38\.2) ", line):
        begin = dict(at)
        at.update({w[0]: float(w[1:]) for w in line.split()[1:] if w[0] in "XYZ"})
    pauses += line == "M0"
    assert not line.startswith("(") or (line.count("(") == 1 and line.endswith(")") and len(line) < 256), line
# A pause for every placement and tip.
assert pauses == len({tuple(r.split(",")[:3:2]) for r in rows[1:]}), pauses
text = open("plate.txt").read()
assert f"program: {len(rows) - 1} touches" in text, len(rows)
left_out = sum(len(line.split(": spheres ")[1].split()) for line in text.splitlines() if line.startswith("not in the program"))
planned = sum(step["observations"] for step in json.load(open("plate.json"))["order"])
assert 5 * (planned - left_out) == len(rows) - 1 and left_out < 0.1 * planned, (planned, left_out, len(rows))
open("touches.csv", "w").write("\n".join(rows) + "\n")
PYTHON
sed 's/^kind = "centre"/&\nfile = "touches.csv"/' plate.toml >touched.toml
expect 0 'chi-square 0.0 of' "$volcomp" identify touched.toml --json touched.json --no-leave-out
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: errors of a machine without'; failed=1; }
import json
found = json.load(open("touched.json"))
# Coordinates in a program have five decimals.
assert all(abs(v) < 0.1 for f in found["functions"] for v in f["value"]), [(f["name"], max(map(abs, f["value"]))) for f in found["functions"]]
PYTHON
exit "$failed"
