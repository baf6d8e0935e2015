#!/usr/bin/env bash
# volcomp compare as a user meets it: the paper's tables, and maps that cannot be used.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2

tables=$source_dir/tests/data/tables-002
left=("$tables/table5_omm_left_um.csv" "$tables/table7_gmc_left_um.csv")
right=("$tables/table6_omm_right_um.csv" "$tables/table8_gmc_right_um.csv")
both=("$volcomp" compare "${left[@]}" "${right[@]}" --names OMM GMC)

# What the paper says of its own tables.
expect 0 'largest difference 5.0 µm, rms 2.14 µm' "${both[@]}"
expect 0 'left flank (side +1): OMM - GMC' "${both[@]}"
expect 0 'OMM: 5.8 µm, right flank, column 8: grade 5' "${both[@]}"
expect 0 'worse than grade 5' "${both[@]}" --rows 1 7
expect 0 'unchecked' "${both[@]}"
expect 0 'frame: not looked for' "${both[@]}" --gear ''
expect 0 '66 %, rms 2.14 -> 1.25 µm; X -41.3 Y 0.0 Z 4.1 µm' "${both[@]}"
expect 0 '68 %, rms 2.14 -> 1.22 µm' "${both[@]}"
expect 0 'X 41.3 Y 0.0 Z -4.1 µm' "${both[@]}" --plus-is space
expect 0 'left = side -1; row 1 = root, column 1 = outer' "${both[@]}" --left-is -1 --row-1 root --column-1 outer
expect 0 'largest 5.0 µm at row 7, column 4' "$volcomp" compare "${left[@]}" --zero centre
expect 0 'zeroed by the mean' "$volcomp" compare "${left[@]}" --zero mean

# A verdict, files, and figures for other programs.
expect 0 'PASS' "${both[@]}" --limit 5.01
expect 1 'FAIL' "${both[@]}" --limit 4.9
expect 0 'largest' "${both[@]}" --report "$work/report" --json "$work/figures.json"
for file in report/report.html report/report.json figures.json; do
  [ -s "$work/$file" ] || { echo "FAILED: $file is missing"; failed=1; }
done
"${both[@]}" --json - 2>/dev/null | python3 -c 'import json, sys
figures = json.load(sys.stdin)
assert len(figures["flanks"]) == 2 and figures["profile"][0]["grade"] == 5 and figures["ok"]
assert figures["flanks"][0]["rows"][4]["at"] == [5, 3]' || { echo 'FAILED: --json -'; failed=1; }

# A cell that was not measured is left empty: everything but the grade and the zeroing stays.
bad=$work/bad.csv
damage() { sed "$1" "${left[0]}" >"$bad"; }
damage '4s/,3.9,/,,/'
expect 0 '1 cells not measured' "$volcomp" compare "$bad" "${left[1]}"
expect 0 'no grade: measured values are missing' "$volcomp" compare "$bad" "${left[1]}"
damage '5s/,0.3,0,-0.2,/,0.3,,-0.2,/'
expect 2 'centre_missing' "$volcomp" compare "$bad" "${left[1]}" --zero centre
one_line "$volcomp" compare "$bad" "${left[1]}" --zero centre
sed '2,$s/,[^,]*/,/g' "${left[0]}" >"$bad"
expect 2 'every cell is empty' "$volcomp" compare "$bad" "${left[1]}"

# Maps that cannot be used: exit 2 and one line that says where.
refused() {
  expect 2 "$1" "$volcomp" compare "$bad" "${left[1]}"
  one_line "$volcomp" compare "$bad" "${left[1]}"
}
damage '4s/,3.9,/,nan,/'
refused 'bad.csv:4: row 3, column 5: "nan" is no measured value'
damage '4s/,3.9,/,-inf,/'
refused 'row 3, column 5: "-inf" is no measured value'
damage '4s/,3.9,/,four,/'
refused 'bad.csv:4: row 3, column 5: "four" is not a number'
damage '4s/,3.9,/,1e999,/'
refused 'row 3, column 5: "1e999" is out of range'
damage '6d'
refused 'bad.csv: row 5 of 7 is missing'
damage '$ a 8,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0'
refused 'bad.csv:9: row "8" must be a whole number from 1 to 7'
damage '6s/^5/4/'
refused 'bad.csv:6: row 4 is there twice'
damage '3s/,[^,]*$//'
refused 'bad.csv:3: 15 cells instead of 16'
damage '1s/,c15//'
refused 'the first line must be row,c1,...,c15'
: >"$bad"
refused 'the file is empty'
noise 300 >"$bad"
refused 'bad.csv'
for path in "$work/none.csv" "$work"; do
  expect 2 'cannot be opened' "$volcomp" compare "$path" "${left[1]}"
  expect 2 'cannot be opened' "$volcomp" compare "${left[@]}" --gear "$path"
done
printf 'teeth = 86\n' >"$bad"
expect 2 "shaper_teeth" "$volcomp" compare "${left[@]}" --gear "$bad"
expect 2 '3 maps given' "$volcomp" compare "${left[@]}" "${right[0]}"
expect 2 'MAPS' "$volcomp" compare "${left[0]}"
expect 2 '--left-is' "$volcomp" compare "${left[@]}" --left-is 0
expect 2 '--rows' "$volcomp" compare "${left[@]}" --rows 0 7
expect 2 'the first row comes first' "$volcomp" compare "${left[@]}" --rows 6 2
expect 2 '--limit' "$volcomp" compare "${left[@]}" --limit -1
touch "$work/file"
expect 2 'cannot be created' "$volcomp" compare "${left[@]}" --report "$work/file"
expect 2 'cannot be written' "$volcomp" compare "${left[@]}" --json "$work/none/figures.json"
leftover=$(find "$work" -name '*.tmp')
[ -z "$leftover" ] || { echo "FAILED: left behind: $leftover"; failed=1; }
exit "$failed"
