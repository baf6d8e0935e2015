#!/usr/bin/env bash
# A simulated machine measured as its owner would, compensated, and judged: volcomp simulate and volcomp verify.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
machine=$source_dir/host_sim/machines/xyfz.toml

# cell WHERE FIGURE COLUMN: of the table that verify writes.
cell() {
  awk -F, -v where="$1" -v figure="$2" -v column="$3" '$1 == where && $2 == figure { print $column }' "$work/figures.csv"
}

# near WHAT FOUND WANTED TOLERANCE
near() {
  awk -v a="$2" -v b="$3" -v t="$4" 'BEGIN { exit !(a != "" && a - b <= t && b - a <= t) }' ||
    { echo "FAILED: $1 is \"$2\" instead of $3"; failed=1; }
}

# --- the noise-free machine: the figures are those of the paper (PNP) and of the README
expect 0 'runs_Z.csv' "$volcomp" simulate runs --perfect --runs 1 --out "$work/perfect"
expect 0 'CRC-32' "$volcomp" build-tables --machine "$machine" --runs "$work"/perfect/runs_*.csv --out "$work/perfect.vct"
# As many points as the README has: between the knots of the tables, too.
plan=(--perfect --points 37 --runs 1)
expect 0 'nothing is compensated' "$volcomp" simulate diagonals "${plan[@]}" --out "$work/before.csv"
expect 0 'compensated with' "$volcomp" simulate diagonals "${plan[@]}" --tables "$work/perfect.vct" --out "$work/after.csv"
expect 0 'PASS body diagonals E_d' "$volcomp" verify "$work/before.csv" "$work/after.csv" --csv "$work/figures.csv"
near 'PNP before' "$(cell PNP largest 3)" 41.15 0.05
near 'PPP before' "$(cell PPP largest 3)" 91.61 0.05
near 'NPP before' "$(cell NPP largest 3)" 94.12 0.05
near 'PPN before' "$(cell PPN largest 3)" 22.90 0.05
near 'PNP after' "$(cell PNP largest 4)" 0.37 0.05
grep -q 'without statistics' < <("$volcomp" verify "$work/before.csv" "$work/after.csv") || { echo 'FAILED: one run is no statistics'; failed=1; }
near 'its reduction' "$(cell PNP largest 5)" 99.10 0.1
expect 1 'significantly worse' "$volcomp" verify "$work/after.csv" "$work/before.csv"
expect 1 'no significant difference' "$volcomp" verify "$work/after.csv" "$work/after.csv"
expect 0 'within 2 µm' "$volcomp" verify "$work/before.csv" "$work/after.csv" --limit-um 2
expect 1 'more than 0.1 µm' "$volcomp" verify "$work/before.csv" "$work/after.csv" --limit-um 0.1

# --- what the tables predict is what the machine then shows
expect 0 'the tables predict' "$volcomp" verify "$work/before.csv" "$work/after.csv" --machine "$machine" \
  --tables "$work/perfect.vct" --json "$work/predicted.json"
worst=$(sed -n 's/.*"prediction_max_difference_um": \([0-9.e-]*\).*/\1/p' "$work/predicted.json" | sort -g | tail -n 1)
# Hysteresis of the direction, the step of the trajectory and a nanometre of rounding are not in the model.
near 'largest difference from the prediction' "$worst" 0 0.03
expect 2 '--box-mm says where it lies' "$volcomp" verify "$work/before.csv" "$work/after.csv" --machine "$machine" \
  --tables "$work/perfect.vct" --box-mm -400 0 -300 0 -400 0
expect 2 'is not below' "$volcomp" verify "$work/before.csv" "$work/after.csv" --machine "$machine" \
  --tables "$work/perfect.vct" --box-mm 0 0 -300 0 -400 0
sed 's/^id = .*/id = 77/' "$machine" >"$work/other.toml"
expect 2 'describes machine 77' "$volcomp" verify "$work/before.csv" "$work/after.csv" --machine "$work/other.toml" \
  --tables "$work/perfect.vct"
# The same number on another machine: one slide the other way round, or a head that sits elsewhere.
for change in '0,/^sign = -1/s//sign = 1/' 's/^offset_mm = \[-200.0/offset_mm = [-199.0/'; do
  sed "$change" "$machine" >"$work/other.toml"
  cmp -s "$machine" "$work/other.toml" && { echo "FAILED: nothing was changed by $change"; failed=1; }
  other=("$volcomp" verify "$work/before.csv" "$work/after.csv" --machine "$work/other.toml" --tables "$work/perfect.vct")
  expect 2 "perfect.vct: tables of another chain of bodies than $work/other.toml describes" "${other[@]}"
  one_line "${other[@]}"
done

# --- noisy, with volume and everything that is known of the instrument; a report, JSON and pipes
expect 0 'runs_Z.csv' "$volcomp" simulate runs --runs 5 --out "$work/noisy" --json "$work/noisy.json"
/usr/bin/python3 - "$work/noisy.json" <<'PYTHON' || { echo 'FAILED: simulate runs --json'; failed=1; }
import json, sys
figures = json.load(open(sys.argv[1]))
assert [axis["axis"] for axis in figures["axes"]] == ["X", "Y", "Z"] and not figures["perfect"], figures
for axis in figures["axes"]:
    rows = sum(line[0] in "-0123456789" for line in open(axis["file"]))
    assert axis["runs_up"] == axis["runs_down"] == 5 and axis["rows"] == rows == 10 * axis["targets"], axis
PYTHON
"$volcomp" simulate runs --perfect --runs 1 --out "$work/piped" --json - 2>"$work/words.txt" | /usr/bin/python3 -c 'import json, sys
assert json.load(sys.stdin)["perfect"]' || { echo 'FAILED: simulate runs --json -'; failed=1; }
grep -q 'runs_Z.csv' "$work/words.txt" || { echo 'FAILED: simulate runs says nothing for people'; failed=1; }
expect 0 'CRC-32' "$volcomp" build-tables --machine "$machine" --runs "$work"/noisy/runs_*.csv --out "$work/noisy.vct"
plan=(--faces --points 5 --runs 3)
expect 0 'diagonals' "$volcomp" simulate diagonals "${plan[@]}" --seed 3 --out "$work/before.csv"
expect 0 'diagonals' "$volcomp" simulate diagonals "${plan[@]}" --seed 4 --tables "$work/noisy.vct" --out "$work/after.csv"
expect 0 'places' "$volcomp" simulate volume --points 20 --out "$work/volume_before.csv"
expect 0 'places' "$volcomp" simulate volume --points 20 --tables "$work/noisy.vct" --out "$work/volume_after.csv"
cat >"$work/uncertainty.toml" <<'TOML'
[uncertainty]
device_um_per_m = 0.5
misalignment_mm = 0.5
temperature_K = 0.1
expansion_um_per_m_K = 11.0
eve_um = 0.4
volume_um = 1.0
TOML
verify=("$volcomp" verify "$work/before.csv" "$work/after.csv" --volume "$work/volume_before.csv" "$work/volume_after.csv"
  --uncertainty "$work/uncertainty.toml")
expect 0 'PASS' "${verify[@]}" --report "$work/report" --json "$work/figures.json"
for file in report/report.html report/report.json figures.json; do
  [ -s "$work/$file" ] || { echo "FAILED: $file is missing"; failed=1; }
done
/usr/bin/python3 - "$work" <<'PYTHON' || { echo 'FAILED: the report names other files or shows another volume'; failed=1; }
import hashlib, json, math, pathlib, sys
work = pathlib.Path(sys.argv[1])
report = json.loads((work / "report/report.json").read_text())
names = ["before", "after", "volume_before", "volume_after", "uncertainty"]
read = {(i["name"], i["bytes"], i["sha256"]) for i in report["inputs"]}
held = [(f, f.read_bytes()) for f in (next(work.glob(name + ".*[lv]")) for name in names)]
assert read == {(f.name, len(data), hashlib.sha256(data).hexdigest()) for f, data in held}, read
volume = next(section for section in report["sections"] if section["id"] == "volume")
longest = {s["name"]: max(math.hypot(*v) for v in s["vectors"]) for s in volume["series"]}
largest = next(f for f in json.loads((work / "figures.json").read_text())["figures"] if f["figure"] == "max")
for when in ("before", "after"):
    assert math.isclose(longest[when], largest[when]["um"], rel_tol=1e-9), (longest, largest)
PYTHON
/usr/bin/python3 - "$work/figures.json" <<'PYTHON' || { echo 'FAILED: intervals in the JSON'; failed=1; }
import json, sys
result = json.load(open(sys.argv[1]))
assert (result["draws"], result["seed"]) == (4000, 1), result
stated = {s["name"]: s["value"] for s in result["stated"]}
assert stated == {"device_um_per_m": 0.5, "misalignment_mm": 0.5, "temperature_K": 0.1, "expansion_um_per_m_K": 11.0,
                  "eve_um": 0.4, "volume_um": 1.0}, stated
names = {f["figure"] for f in result["figures"]}
assert names == {"largest", "E", "B", "M", "A", "R", "E_d", "B_d", "max", "rms"}, names
for figure in result["figures"]:
    for side in (figure["before"], figure["after"]):
        assert set(side) == {"um", "corrected_um", "low_um", "high_um", "upper95_um"}, side
        if figure["figure"] == "rms":
            assert side["low_um"] is None, side
        else:
            assert 0 <= side["low_um"] <= side["corrected_um"] <= side["high_um"], (figure, side)
            assert side["corrected_um"] <= side["upper95_um"], (figure, side)
bounds = {kind: max(f["after"]["upper95_um"] for f in result["figures"] if f["figure"] == "E" and (f["where"][2] in "+-") == face)
          for kind, face in (("body diagonals", False), ("face diagonals", True))}
for figure in result["figures"]:
    if figure["figure"] == "E_d":
        assert figure["after"]["upper95_um"] == bounds[figure["where"]], (figure, bounds)
PYTHON
# As many draws take seconds; what follows needs no more than a few.
verify+=(--draws 400)
"${verify[@]}" --json "$work/figures.json" >/dev/null
"${verify[@]}" --seed 2 --json "$work/other.json" >/dev/null
cmp -s "$work/other.json" "$work/figures.json" && { echo 'FAILED: another seed gives the same intervals'; failed=1; }
expect 0 'intervals: scatter of the runs and device_um_per_m 0.5' "${verify[@]}"
expect 0 'ISO/TR 230-9, instrument and surroundings only: U (k = 2) of E' "${verify[@]}"
expect 0 'not a test after ISO 230-2' "${verify[@]}"
expect 0 'upper bound' "${verify[@]}" --limit-um 50
expect 1 'FAIL' "${verify[@]}" --limit-um 0.5
for draws in 99 100001 -1 many; do expect 2 '--draws' "${verify[@]}" --draws "$draws"; done
expect 0 'PASS' "$volcomp" verify <(cat "$work/before.csv") "$work/after.csv" --report "$work/piped_report"
grep -q '"before","/dev/fd/' <(tr -d ' \n' <"$work/piped_report/report.json") || { echo 'FAILED: a pipe has no name in the report'; failed=1; }
expect 0 'left out of the uncertainty: expansion coefficient' "${verify[@]}"
expect 0 'device 0.' "${verify[@]}"
"${verify[@]}" --csv - 2>/dev/null >"$work/figures.csv"
"${verify[@]}" --csv "$work/file.csv" >"$work/words.txt"
cmp "$work/figures.csv" "$work/file.csv" || { echo 'FAILED: the pipe holds something else than the file'; failed=1; }
near 'columns of every line' "$(awk -F, '{ print NF }' "$work/figures.csv" | sort -u | tr -d '\n')" 14 0
"${verify[@]}" --json - 2>/dev/null | cmp - "$work/figures.json" || { echo 'FAILED: other JSON in the pipe'; failed=1; }
expect 2 'only one result' "${verify[@]}" --json - --csv -
"$volcomp" simulate diagonals "${plan[@]}" --seed 3 --out - 2>/dev/null | cmp - "$work/before.csv" ||
  { echo 'FAILED: the same seed gives other diagonals, or words are in the pipe'; failed=1; }
expect 2 '/dev/full' "${verify[@]}" --csv /dev/full/none
if "${verify[@]}" --csv - >/dev/full 2>"$work/words.txt"; then echo 'FAILED: a full disk was not noticed'; failed=1; fi

# --- input that cannot be used: one sentence with the line, nothing written
# refused TEXT: bad.csv as the measurement before.
refused() {
  expect 2 "$1" "$volcomp" verify "$work/bad.csv" "$work/after.csv" --json "$work/never.json" --csv "$work/never.csv"
  one_line "$volcomp" verify "$work/bad.csv" "$work/after.csv" --json "$work/never.json"
}
damage() { sed "$1" "$work/before.csv" >"$work/bad.csv"; }
damage '5s/up/sideways/'
refused 'bad.csv:5: direction is "sideways"'
damage '1s/\[um\]/[deg]/'
refused 'bad.csv:1: '
damage '1s/ \[um\]//'
refused 'bad.csv:1: column "deviation" needs its unit'
damage '7s/^PPP/QQQ/'
refused 'bad.csv:7: diagonal "QQQ"'
damage '9s/,[^,]*$/,0x12/'
refused 'bad.csv:9: '
damage '9s/,[^,]*$/,inf/'
refused 'bad.csv:9: '
damage '6d'
refused 'PPP: run 1 up has 4 of 5 targets'
head -c 700 "$work/before.csv" >"$work/bad.csv"
refused 'bad.csv:'
iconv -t UTF-16 "$work/before.csv" >"$work/bad.csv"
refused 'bad.csv:1: the file is UTF-16'
noise 3000 >"$work/bad.csv"
refused 'bad.csv:1: '
{ head -n 4 "$work/before.csv"; printf 'PPP,\377\376,1,up,0\n'; } >"$work/bad.csv"
refused 'bad.csv:5: '
: >"$work/bad.csv"
refused 'bad.csv: the file is empty'
head -n 1 "$work/before.csv" >"$work/bad.csv"
refused 'bad.csv: there is no reading'
rm "$work/bad.csv"
refused 'bad.csv: cannot be opened'
mkdir "$work/bad.csv"
refused 'bad.csv: cannot be opened'
rmdir "$work/bad.csv"
# A million lines: one is wrong, near the end.
awk 'BEGIN { print "diagonal,target [mm],run,direction,deviation [um]"
  for (i = 0; i < 1000000; ++i) printf "PPP,%d,%d,up,%s\n", i % 512, 1 + i / 512, i == 511999 ? "x" : "1.5" }' >"$work/bad.csv"
refused 'bad.csv:512001: deviation [um]: "x" is not a number'
sed -i 's/,x$/,0/' "$work/bad.csv"
refused 'diagonal PPP has more than 1000 runs'
sed '2d' "$work/volume_after.csv" >"$work/bad.csv"
expect 2 'lacks the place' "$volcomp" verify "$work/before.csv" "$work/after.csv" --volume "$work/volume_before.csv" "$work/bad.csv"
sed '4s/mm/um/;5s/^/x/' "$work/volume_after.csv" >"$work/bad.csv"
expect 2 'bad.csv:5: X: ' "$volcomp" verify "$work/before.csv" "$work/after.csv" --volume "$work/volume_before.csv" "$work/bad.csv"
printf '[uncertainty]\ndevice = 1\n' >"$work/bad.toml"
expect 2 "bad.toml:2: unknown field 'device'" "$volcomp" verify "$work/before.csv" "$work/after.csv" --uncertainty "$work/bad.toml"
expect 2 'temperature_K needs expansion_um_per_m_K' "$volcomp" verify "$work/before.csv" "$work/after.csv" --temperature-K 1
expect 2 '--machine' "$volcomp" verify "$work/before.csv" "$work/after.csv" --tables "$work/noisy.vct"
expect 2 'AFTER' "$volcomp" verify "$work/before.csv"
expect 2 'no-such-can0' "$volcomp" simulate diagonals --can no-such-can0 --out "$work/never.csv"
expect 2 'no node to be met' "$volcomp" simulate volume --can loopback --out "$work/never.csv"
expect 2 'excludes' "$volcomp" simulate volume --can vcan0 --tables "$work/noisy.vct" --out "$work/never.csv"
left=$(find "$work" -name 'never*' -o -name '*.tmp')
[ -z "$left" ] || { echo "FAILED: written in spite of it: $left"; failed=1; }
exit "$failed"
