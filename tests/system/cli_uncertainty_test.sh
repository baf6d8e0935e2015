#!/usr/bin/env bash
# volcomp uncertainty as a user meets it: from run files and an image to figures, and what is refused.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
machine=$source_dir/host_sim/machines/xyfz.toml

expect 0 'runs_Z.csv' "$volcomp" simulate runs --runs 3 --out "$work/runs"
expect 0 'CRC-32' "$volcomp" build-tables --machine "$machine" --runs "$work"/runs/runs_*.csv --out "$work/t.vct"
of=("$volcomp" uncertainty "$work/t.vct" --machine "$machine" --draws 100)
ask=("${of[@]}" --runs "$work"/runs/runs_*.csv)
printf 'X [mm],Y [mm],Z [mm]\n-100,-100,-100\n-200,-100,-100\n-200,-200,-100\n-200,-200,-200\n-300,-200,-200\n' >"$work/task.csv"
printf '[campaign]\nscale_um_per_m = 0.25\nsquareness_urad = 3\n' >"$work/campaign.toml"

# What a user can mend: one sentence.
refused() {
  local text=$1
  shift
  expect 2 "$text" "$@"
  one_line "$@"
}

# number FILE PATH…: what the JSON has there.
number() {
  /usr/bin/python3 -c 'import json, sys
value = json.load(open(sys.argv[1]))
for key in sys.argv[2:]:
    value = value[int(key) if key.isdigit() else key]
print(value)' "$@"
}

expect 0 'X -100 mm, Y -100 mm, Z -100 mm' "${ask[@]}" --task "$work/task.csv" --uncertainty "$work/campaign.toml" --json "$work/task.json"
expect 0 'after the best rigid motion' "${ask[@]}" --task "$work/task.csv"
expect 0 'not stated, drawn as 0: levers (lever_mm)' "${ask[@]}" --point=-250,-150,-200
expect 0 'range of E along the line' "${ask[@]}" --line=-500,-300,-400:0,0,0 --places 5
[ "$(number "$work/task.json" stated squareness_urad)" = 3.0 ] || { echo 'FAILED: what is stated is not in the JSON'; failed=1; }

# An option overrides the file. Squareness alone, uncertain by u: EX has u · Z (docs/papers/xyfz.md), to first order exactly.
expect 0 'runs_Z.csv' "$volcomp" simulate runs --perfect --runs 1 --out "$work/perfect"
expect 0 'CRC-32' "$volcomp" build-tables --machine "$machine" --runs "$work"/perfect/runs_*.csv --out "$work/perfect.vct"
expect 0 'not stated, drawn as 0: readings of EXX, EYX, EZX, EAX, EBX, ECX (reading_um, reading_urad)' \
  "$volcomp" uncertainty "$work/perfect.vct" --machine "$machine" --runs "$work"/perfect/runs_*.csv --draws 100 \
  --uncertainty "$work/campaign.toml" --squareness-urad 10 --scale-um-per-m 0 --point=-250,-150,-200 --json "$work/point.json"
awk -v u="$(number "$work/point.json" places 0 EX first_order_um)" 'BEGIN { exit !(u > 1.9999 && u < 2.0001) }' ||
  { echo 'FAILED: 10 µrad at Z = 200 mm are 2 µm'; failed=1; }

# The same seed, the same bytes; a pipe; a report.
"${ask[@]}" --point=-250,-150,-200 --json - >"$work/one.json" 2>"$work/words" || failed=1
"${ask[@]}" --point=-250,-150,-200 --json "$work/two.json" >/dev/null || failed=1
cmp "$work/one.json" "$work/two.json" || failed=1
grep -q 'Where it comes from' "$work/words" || { echo 'FAILED: no words on standard error'; failed=1; }
expect 0 "report: $work/report/report.html" "${ask[@]}" --task "$work/task.csv" --report "$work/report"
[ -s "$work/report/report.json" ] || { echo 'FAILED: no report.json'; failed=1; }

# A rotary axis with a table that turns once round.
turning=$work/turning.toml
cat >"$turning" <<'END'
name = "slide over a table"
id = 7
convention = "relative"
side = "moving"
chain = "w-C-b-X-t"
tool = { point_mm = [0.0, 0.0, -100.0] }
correction = { axes = ["X"] }
axis = [
  { name = "X", travel_mm = [-200.0, 0.0], targets = 5, reference_mm = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
  { name = "C", travel_rad = [0.0, 6.283185307179586], targets = 9, sign = -1, reference_rad = 0.0, sensed_point_mm = [0.0, 0.0, 0.0], kappa = 0 },
]
END
expect 0 'runs_C.csv' "$volcomp" simulate runs --machine "$turning" --runs 3 --out "$work/turning"
expect 0 'CRC-32' "$volcomp" build-tables --machine "$turning" --runs "$work"/turning/runs_*.csv --out "$work/turning.vct"
expect 0 'X -150 mm, C 90 deg' "$volcomp" uncertainty "$work/turning.vct" --machine "$turning" --runs "$work"/turning/runs_*.csv \
  --draws 100 --point=-150,90

of_turning=("$volcomp" uncertainty "$work/turning.vct" --machine "$turning" --runs "$work"/turning/runs_*.csv --draws 100)
expect 0 'location of rotary axes' "${of_turning[@]}" --location-um 1 --location-urad 3 --point=-150,90
expect 0 'not stated, drawn as 0: zero of rotary axes (zero_urad)' "${of_turning[@]}" --point=-150,90

# Squareness by circles of a ball bar, and by nothing but circles: 10 µrad at Z = 200 mm are 2 µm again.
sed -e 's/^at_mm = \[-250.0/circle_radius_mm = 100.0\n&/' -e '/^[xyz]_mm = /d' "$machine" >"$work/circles.toml"
expect 0 'CRC-32' "$volcomp" build-tables --machine "$work/circles.toml" --runs "$work"/perfect/runs_*.csv --out "$work/circles.vct"
expect 0 'squareness' "$volcomp" uncertainty "$work/circles.vct" --machine "$work/circles.toml" --runs "$work"/perfect/runs_*.csv --draws 100 \
  --squareness-urad 10 --point=-250,-150,-200 --json "$work/circles.json"
awk -v u="$(number "$work/circles.json" places 0 EX first_order_um)" 'BEGIN { exit !(u > 1.9999 && u < 2.0001) }' ||
  { echo 'FAILED: 10 µrad at Z = 200 mm are 2 µm, by circles, too'; failed=1; }
refused 'not made from these runs: the squareness differs' "$volcomp" uncertainty "$work/perfect.vct" --machine "$work/circles.toml" \
  --runs "$work"/perfect/runs_*.csv --squareness-urad 10 --point=-250,-150,-200
refused 'location_um: ' "${ask[@]}" --point=0,0,0 --location-um 1
refused 'has no [squareness]' "${of_turning[@]}" --point=-150,90 --squareness-urad 3

# --- refused
refused 'no places: give --task, --point or --line' "${ask[@]}"
refused '--point -600,0,0: X -600 mm is outside the travel -500 … 0 mm' "${ask[@]}" --point=-600,0,0
printf 'X [mm],Y [mm],Z [mm]\n0,0,0\n0,0,1\n' >"$work/beyond.csv"
refused 'beyond.csv:3: Z 1 mm is outside the travel' "${ask[@]}" --task "$work/beyond.csv"
refused 'not made from these runs: the tables of axis X differ' "${of[@]}" --runs "$work"/perfect/runs_*.csv --point=0,0,0
refused 'nothing is uncertain' "$volcomp" uncertainty "$work/perfect.vct" --machine "$machine" --runs "$work"/perfect/runs_*.csv --point=0,0,0
refused 'growth_K needs expansion_um_per_m_K' "${ask[@]}" --point=0,0,0 --growth-K 0.1
sed 's/^id = .*/id = 77/' "$machine" >"$work/other.toml"
refused 'tables of machine 1001' "$volcomp" uncertainty "$work/t.vct" --machine "$work/other.toml" --runs "$work"/runs/runs_*.csv --point=0,0,0
sed 's/^a_xy_rad = .*/a_xy_rad = 100e-6/' "$machine" >"$work/other.toml"
refused 'the squareness differs by 27.26 urad' "$volcomp" uncertainty "$work/t.vct" --machine "$work/other.toml" --runs "$work"/runs/runs_*.csv --point=0,0,0
printf '[campaign]\nscale_um_per_mm = 0.25\n' >"$work/misspelt.toml"
refused 'misspelt.toml:2' "${ask[@]}" --point=0,0,0 --uncertainty "$work/misspelt.toml"
expect 2 '--draws' "${of[@]}" --runs "$work"/runs/runs_*.csv --point=0,0,0 --draws 99
expect 2 'excludes --' "${ask[@]}" --point=0,0,0 --task "$work/task.csv"
expect 2 '--lever-mm: nan is not a number from' "${ask[@]}" --point=0,0,0 --lever-mm=nan
exit "$failed"
