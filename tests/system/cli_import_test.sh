#!/usr/bin/env bash
# volcomp import as a user meets it: the examples of docs/formats.md, values against a calculation by hand, and every
# kind of file that cannot be used.
# shellcheck disable=SC2016  # the dollars are those of sed and of Siemens
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
examples=$source_dir/docs/examples
comp=("$volcomp" import linuxcnc --out "$work/out")
isg=("$volcomp" import isg-csv --sign actual-minus-nominal --absent zero --out "$work/out")
etalon=("$volcomp" import etalon --sign actual-minus-nominal --absent zero --out "$work/out")

# is FILE TARGET DIRECTION CHANNEL VALUE: one cell of a run file, in mm and rad.
is() {
  /usr/bin/python3 - "$work/out/$1" "$2" "$3" "$4" "$5" <<'PY' || { echo "FAILED: $*"; failed=1; }
import csv, math, sys
path, target, direction, channel, value = sys.argv[1:]
rows = list(csv.DictReader(line for line in open(path) if not line.startswith("#")))
target, value = eval(target, {"pi": math.pi}), float(value)
found = [r for r in rows if r["direction"] == direction and abs(float(next(v for k, v in r.items() if k.startswith("target"))) - target) < 1e-12]
got = float(next(v for k, v in found[0].items() if k.startswith(channel)))
sys.exit(len(found) != 1 or abs(got - value) > 1e-12)
PY
}

# LinuxCNC, positions: 0.1 was commanded and 0.098742 reached, in inches; error = reached − commanded.
expect 0 'axis X, 3 positions, both directions' "${comp[@]}" --axis X --type 0 --unit inch --absent zero "$examples/linuxcnc_x.comp"
is runs_X.csv 2.54 up EXX -0.0319532
is runs_X.csv 2.54 down EXX -1.2285472
is runs_X.csv 2.54 down ECX 0
# The same numbers as trims: what is added, so the error is minus that.
expect 0 'mm and rad' "${comp[@]}" --axis Y --type 1 --unit mm --absent zero "$examples/linuxcnc_x.comp"
is runs_Y.csv 0.1 up EYY -0.098742
expect 0 'axis B' "${comp[@]}" --axis B --type 1 --unit deg --absent zero "$examples/linuxcnc_x.comp"
is runs_B.csv '0.2*pi/180' down EBB -0.003389708660053307

# Saved by an editor that marks UTF-8, with signs as sscanf of LinuxCNC takes them.
{ printf '\xef\xbb\xbf'; sed 's/^0/+0/' "$examples/linuxcnc_x.comp"; } >"$work/marked.comp"
expect 0 'axis Z, 3 positions' "${comp[@]}" --axis Z --type 1 --unit mm --absent zero "$work/marked.comp"
is runs_Z.csv 0.1 up EZZ -0.098742

expect 0 'runs_C.csv: axis C, 3 positions, one direction' "${isg[@]}" "$examples/isg_volumetric.csv"
is runs_X.csv 10 up EZX 0.0005
is runs_X.csv 20 up ECX 3e-6
is runs_C.csv pi/2 up ECC 2.5e-5
grep -qx 'B0Z,-1.7e-05,rad' "$work/out/location_errors.csv" || { echo 'FAILED: location errors'; failed=1; }
expect 0 'location errors' "$volcomp" import isg-csv --sign nominal-minus-actual --absent zero --out "$work/out" "$examples/isg_volumetric.csv"
is runs_X.csv 10 up EYX 0.001
grep -qx 'B0Z,1.7e-05,rad' "$work/out/location_errors.csv" || { echo 'FAILED: sign of location errors'; failed=1; }

expect 0 'axis Y, 3 positions' "${etalon[@]}" "$examples/etalon_vendor.txt"
is runs_Y.csv -10 up EXY -0.0002
is runs_Y.csv -20 up EYY 0.004
is runs_Y.csv -20 up EZY 0
grep -qx 'C0Y,2.2355737e-05,rad' "$work/out/location_errors.csv" || { echo 'FAILED: location of Etalon'; failed=1; }

# What was imported is a run file: a table is built of it.
printf 'X EXX EYX EZX EAX EBX ECX\n-500 .05 0 0 0 0 0\n-250 .02 0 0 0 0 0\n0 0 0 0 0 0 0\n' >"$work/x.csv"
sed 's/^X/Y/; s/\(E.\)X/\1Y/g; s/500/300/; s/250/150/' "$work/x.csv" >"$work/y.csv"
sed 's/^X/Z/; s/\(E.\)X/\1Z/g; s/500/400/; s/250/200/' "$work/x.csv" >"$work/z.csv"
expect 0 'runs_Z.csv' "$volcomp" import isg-csv --sign actual-minus-nominal --out "$work/three" "$work/x.csv" "$work/y.csv" "$work/z.csv"
expect 0 'CRC-32' "$volcomp" build-tables --machine "$source_dir/host_sim/machines/xyfz.toml" --runs "$work"/three/runs_?.csv --out "$work/tables.vct"


# The example of a run file of one's own, for X and scaled for the other two.
example=$examples/runs_x.csv
sed 's/\(E.\)X/\1Y/g; s/^-500/-300/; s/^-250/-150/' "$example" >"$work/own_y.csv"
sed 's/\(E.\)X/\1Z/g; s/^-500/-400/; s/^-250/-200/' "$example" >"$work/own_z.csv"
expect 0 'X  3 targets -> 17 knots, known reversal' "$volcomp" build-tables \
  --machine "$source_dir/host_sim/machines/xyfz.toml" --runs "$example" "$work/own_y.csv" "$work/own_z.csv" --out "$work/tables.vct"

# For programs: what was read and where it is; the words go beside it.
"${isg[@]}" "$examples/isg_volumetric.csv" --json - 2>"$work/words.txt" >"$work/isg.json" || { echo 'FAILED: import --json -'; failed=1; }
grep -q 'runs_C.csv: axis C' "$work/words.txt" || { echo 'FAILED: import says nothing for people'; failed=1; }
"$volcomp" import linuxcnc --out "$work/inch" --axis X --type 0 --unit inch --absent zero "$examples/linuxcnc_x.comp" --json "$work/comp.json" \
  >/dev/null || failed=1
/usr/bin/python3 - "$work/isg.json" "$work/comp.json" "$examples" <<'PYTHON' || { echo 'FAILED: figures of import'; failed=1; }
import json, math, sys
isg, comp = (json.load(open(path)) for path in sys.argv[1:3])
assert isg["sources"] == [sys.argv[3] + "/isg_volumetric.csv"] and isg["source_convention"] == {"sign": "actual-minus-nominal"}, isg
assert comp["source_convention"] == {"type": 0, "unit": "inch"} and comp["location_errors"] is None, comp
assert isg["values"] == comp["values"] == {"meaning": "actual - nominal", "length_unit": "mm", "angle_unit": "rad"}
for result in isg, comp:
    assert result["absent_channels"] == "zero"
    for axis in result["axes"]:
        lines = [line.split(",") for line in open(axis["file"]) if not line.startswith("#")]
        head, rows = lines[0], lines[1:]
        places = [float(row[head.index(f"target [{axis['unit']}]")]) for row in rows]
        assert axis["rows"] == len(rows) and axis["targets"] == len(set(places)), axis
        assert (axis["from"], axis["to"]) == (min(places), max(places)), axis
        ways = [row[head.index("direction")] for row in rows]
        assert (axis["runs_up"] > 0, axis["runs_down"] > 0) == ("up" in ways, "down" in ways), axis
turning, = [axis for axis in isg["axes"] if axis["axis"] == "C"]
assert turning["unit"] == "rad" and turning["to"] <= 2 * math.pi, turning
assert "rad" in open(isg["location_errors"]).read()
PYTHON

# Nothing is guessed.
expect 2 '--sign' "$volcomp" import isg-csv --out "$work/out" "$examples/isg_volumetric.csv"
expect 2 '--sign' "$volcomp" import etalon --out "$work/out" "$examples/etalon_vendor.txt"
expect 2 '--type' "${comp[@]}" --axis X --unit mm --absent zero "$examples/linuxcnc_x.comp"
expect 2 '--unit' "${comp[@]}" --axis X --type 0 --absent zero "$examples/linuxcnc_x.comp"
expect 2 '--axis' "${comp[@]}" --unit mm --type 0 --absent zero "$examples/linuxcnc_x.comp"
expect 2 'of the wrong kind for axis C' "${comp[@]}" --axis C --type 0 --unit mm --absent zero "$examples/linuxcnc_x.comp"
expect 2 'of the wrong kind for axis X' "${comp[@]}" --axis X --type 0 --unit deg --absent zero "$examples/linuxcnc_x.comp"
expect 2 '--absent zero writes the other five' "${comp[@]}" --axis X --type 0 --unit mm "$examples/linuxcnc_x.comp"
expect 2 'axis C lacks EXC, EYC, EZC, EAC, EBC' "$volcomp" import isg-csv --sign actual-minus-nominal --out "$work/out" "$examples/isg_volumetric.csv"
expect 2 'axis Y lacks EZY, EAY, EBY, ECY' "$volcomp" import etalon --sign actual-minus-nominal --out "$work/out" "$examples/etalon_vendor.txt"

# Bad files: exit 2, one sentence with file and line, the folder as it was.
cp -r "$work/out" "$work/before"
bad=$work/bad.txt
refused() {
  local text=$1
  shift
  expect 2 "$text" "$@" "$bad"
  one_line "$@" "$bad"
}
to_isg() { sed "$1" "$examples/isg_volumetric.csv" >"$bad"; refused "$2" "${isg[@]}"; }
to_isg '4s/0.002/0,002/' 'bad.txt:4: "0,002" is not a number'
to_isg '4s/ 4.2e-6//' 'bad.txt:4: 6 numbers instead of 7'
to_isg '4s/0.002/nan/' 'bad.txt:4: a number must be finite'
to_isg '4s/0.002/1e999/' 'bad.txt:4: "1e999" is out of range'
to_isg '4s/0.002/1e99/' 'bad.txt:4: the error is out of range'
to_isg '5s/^20.0/1e99/' 'bad.txt:5: the position is out of range'
to_isg '4s/^10.0/20.0/' 'bad.txt:5: EXX has position 20 twice'
to_isg '2s/EXX/FXX/' 'bad.txt:2: unknown column "FXX"'
to_isg '2s/EYX/EXX/' 'bad.txt:2: column "EXX" occurs twice'
to_isg '2s/EYX/EYY/' 'bad.txt:2: EYY does not belong to axis X'
to_isg '2s/EXX/Z/' 'bad.txt:2: errors that depend on several axes'
to_isg '2s/^X/EXX/;2s/EXX /EYX/' 'bad.txt:2: '
to_isg '2s/^X  /EDX/' 'bad.txt:2: unknown column "EDX"'
to_isg '3,5d' 'there is no record after the header'
to_isg '15,$d' 'bad.txt:14: there is no record after the header'
to_isg '$ a 1 2' 'bad.txt:16: a location error has one value'
to_isg '14s/B0Z/C0Y/' 'bad.txt:14: column "C0Y" occurs twice'
to_isg '14s/B0Z/EXX/' 'bad.txt:14: the header has no position'
to_isg '4,5d' 'axis X has one position'
to_isg '$ a #\nX EXX\n0 1\n1 2' 'bad.txt:17: EXX is there twice'
to_isg '2,11d' 'there is no error function of an axis'
expect 2 'EXX is there twice' "${isg[@]}" "$examples/isg_volumetric.csv" "$examples/isg_volumetric.csv"
printf 'X EXX\n0 1\n1 2\n#\nX EYX\n0 1\n2 2\n' >"$bad"
refused 'EXX and EYX are not at the same positions' "${isg[@]}"

to_etalon() { sed "$1" "$examples/etalon_vendor.txt" >"$bad"; refused "$2" "${etalon[@]}"; }
to_etalon '3s/VALUE/UNIT/' 'bad.txt:3: "UNIT = 0.000022355737" is not what [C0Y] needs: VALUE = number'
to_etalon '3s/= .*/=/' 'bad.txt:3: "" is not a number'
to_etalon '3d' '[C0Y] has no value'
to_etalon '4s/EXY/EXW/' 'bad.txt:4: unknown block "[EXW]"'
to_etalon '4s/]//' 'bad.txt:4: unknown block'
to_etalon '6s/-0.0013/-0.0013 7/' 'bad.txt:6: expected: position error'
to_etalon '6s/-0.0013/x/' 'bad.txt:6: "x" is not a number'
to_etalon '13,$d' 'bad.txt:12: the file ends inside Gridpoints of [EYY]'
to_etalon '9d' 'bad.txt:9: expected: position error'
to_etalon '12,14d' 'bad.txt:12: Gridpoints of [EYY] are empty'
to_etalon '10s/EYY/EXY/' 'bad.txt:10: EXY is there twice'
to_etalon '6,8d' 'bad.txt:6: Gridpoints of [EXY] are empty'
to_etalon '2d' 'bad.txt:2: expected [name]'
to_etalon '$ a VALUE = 3' 'bad.txt:16: [EYY] has two values'
to_etalon '5s/Gridpoints = {/VALUE = 3/' 'bad.txt:5: "VALUE = 3" is not what [EXY] needs: Gridpoints = {'
to_etalon '$ a [C0Y]\nVALUE = 3' 'bad.txt:17: C0Y is there twice'
to_etalon '1,$s/.*//' 'there is no block'

read_comp=("${comp[@]}" --axis X --type 0 --unit mm --absent zero)
to_comp() { sed "$1" "$examples/linuxcnc_x.comp" >"$bad"; refused "$2" "${read_comp[@]}"; }
to_comp '2s/0.098742/0,098742/' 'bad.txt:2: "0,098742" is not a number'
to_comp '2s/ 0.051632//' 'bad.txt:2: expected: nominal forward reverse'
to_comp '2s/$/ 7/' 'bad.txt:2: expected: nominal forward reverse'
to_comp '3s/^0.2/0.1/' 'bad.txt:3: nominal positions must ascend'
to_comp '2s/0.098742/inf/' 'bad.txt:2: a number must be finite'
to_comp '2s/^/\n/' 'bad.txt:3: LinuxCNC reads nothing after an empty line'
to_comp '2,3d' 'bad.txt: 1 entries; 2 to 256 are allowed'
seq 0 256 | awk '{print $1, 0, 0}' >"$bad"
refused 'bad.txt:257: more than 256 entries' "${read_comp[@]}"
# What a run file could not hold, once it is in mm and rad.
inch=("${comp[@]}" --axis X --unit inch --absent zero)
turns=("${comp[@]}" --axis C --unit deg --absent zero)
printf '0 0 0\n1e308 0 0\n' >"$bad"
refused 'bad.txt:2: the position is out of range' "${inch[@]}" --type 0
refused 'bad.txt:2: the position is out of range' "${inch[@]}" --type 1
printf '0 0 0\n1 0 -1e308\n' >"$bad"
refused 'bad.txt:2: the error is out of range' "${inch[@]}" --type 0
refused 'bad.txt:2: the error is out of range' "${inch[@]}" --type 1
printf '0 0 0\n1e-7 0 0\n' >"$bad"
refused 'bad.txt:2: positions nearer than 1e-05 mm are one in a run file' "${inch[@]}" --type 1
printf '0 0 0\n5e-4 0 0\n' >"$bad"
refused 'bad.txt:2: positions nearer than 1e-05 rad are one in a run file' "${turns[@]}" --type 1
# From a pipe, too.
printf '0 0 0\n1 x 0\n' >"$bad"
expect 2 'standard input:2: "x" is not a number' "${read_comp[@]}" - <"$bad"
expect 2 'standard input: the file holds one error motion' "${comp[@]}" --axis X --type 0 --unit mm - <"$examples/linuxcnc_x.comp"
expect 2 'standard input: axis C lacks EXC' "$volcomp" import isg-csv --sign actual-minus-nominal --out "$work/out" - <"$examples/isg_volumetric.csv"

# Files that are none of it: empty, other encodings, binary, endless, a million lines.
for import in isg etalon read_comp; do
  declare -n command=$import
  : >"$bad"
  refused 'bad.txt' "${command[@]}"
  printf 'X EXX\n\xb5\xff 1\n' >"$bad"
  refused 'bad.txt' "${command[@]}"
  noise 3000 >"$bad"
  refused 'bad.txt' "${command[@]}"
  head -c 200000 /dev/zero >"$bad"
  refused 'bad.txt' "${command[@]}"
  for path in "$work/none" "$work"; do
    expect 2 'cannot be opened' "${command[@]}" "$path"
  done
  expect 2 '/dev/zero' "${command[@]}" /dev/zero
done
iconv -t UTF-16 "$examples/isg_volumetric.csv" >"$bad"
refused 'bad.txt:1: the file is UTF-16' "${isg[@]}"
refused 'bad.txt:1: the file is UTF-16' "${read_comp[@]}"
awk 'BEGIN {print "X EXX"; for (i = 0; i < 1000000; ++i) print i, 0}' >"$bad"
refused 'bad.txt:514: more than 512 positions' "${isg[@]}"
awk 'BEGIN {for (i = 0; i < 1000000; ++i) print i, 0, 0}' >"$bad"
refused 'bad.txt:257: more than 256 entries' "${read_comp[@]}"
awk 'BEGIN {print "[EXY]\nGridpoints = {"; for (i = 0; i < 1000000; ++i) print i, 0}' >"$bad"
refused 'bad.txt:515: more than 512 positions' "${etalon[@]}"

diff -r "$work/before" "$work/out" || { echo 'FAILED: a refused import touched the folder'; failed=1; }
leftover=$(find "$work" -name '*.tmp')
[ -z "$leftover" ] || { echo "FAILED: left behind: $leftover"; failed=1; }
exit "$failed"
