#!/usr/bin/env bash
# volcomp evaluate-ballbar and simulate ball-bar as a user meets them: known squareness and reversal, a file of the
# simulated machine, tables closed by circles, and what is refused.
#
#   cli_ball_bar_test.sh VOLCOMP SOURCE_FOLDER
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2

# circles FILE A_URAD REVERSAL_UM PLANE: two circles each way of 72 readings whose axes are out of square by the slope sum
# A_URAD, with reversal of the first axis and noise.
circles() {
  /usr/bin/python3 - "$@" <<'PY'
import math, random, sys
path, a, reversal, plane = sys.argv[1], float(sys.argv[2]) * 1e-6, float(sys.argv[3]) * 1e-3, sys.argv[4]
noise = random.Random(1)
lines = [f"# plane {plane}", "# radius_mm 100", "# feed_mm_min 1000", "angle [deg],radial [um],direction"]
for run in (1, 2):
    lines.append(f"# run {run}")
    for sense, name in ((1, "ccw"), (-1, "cw")):
        for i in range(72):
            theta = sense * math.radians(5 * i)
            rising = -sense * math.sin(theta)
            first = a * 100 * math.sin(theta) + (math.copysign(reversal / 2, rising) if abs(rising) > 1e-9 else 0)
            r = math.hypot(100 * math.cos(theta) + first, 100 * math.sin(theta)) - 100
            lines.append(f"{math.degrees(theta):.3f},{1e3 * r + noise.gauss(0, 0.05):.4f},{name}")
open(path, "w").write("\n".join(lines) + "\n")
PY
}

# part JSON NAME: the value of a part of the form.
part() {
  /usr/bin/python3 -c 'import json, sys
print(next(p["value"] for p in json.load(open(sys.argv[1]))["parts"] if p["part"] == sys.argv[2]))' "$1" "$2"
}

# near NAME VALUE WANTED TOLERANCE
near() {
  /usr/bin/python3 -c 'import sys; sys.exit(abs(float(sys.argv[1]) - float(sys.argv[2])) > float(sys.argv[3]))' "$2" "$3" "$4" || {
    printf 'FAILED: %s is %s, not %s ± %s\n' "$1" "$2" "$3" "$4"
    failed=1
  }
}

# The slope sum a_xy is −EC0Y.
circles "$work/xy.csv" 25 3 XY
expect 0 'EC0Y' "$volcomp" evaluate-ballbar "$work/xy.csv" --json "$work/xy.json" --draws 200
near EC0Y "$(part "$work/xy.json" EC0Y)" -25 1
near 'reversal X' "$(part "$work/xy.json" 'reversal X')" 3 0.2
# In the plane ZX the slope sum is a_xz = EB0Z.
circles "$work/zx.csv" 25 0 ZX
expect 0 'EB0Z' "$volcomp" evaluate-ballbar "$work/zx.csv" --json "$work/zx.json" --draws 200
near EB0Z "$(part "$work/zx.json" EB0Z)" 25 1

# A file of the simulated machine, through a pipe.
"$volcomp" simulate ball-bar --plane YZ --circles 1 --out - 2> "$work/words" > "$work/yz.csv" || failed=1
expect 0 'one circle each way' "$volcomp" evaluate-ballbar "$work/yz.csv"
expect 0 '1 circle each way' cat "$work/words"
expect 2 'the circle leaves the travel of X' "$volcomp" simulate ball-bar --radius-mm 400 --out "$work/big.csv"

# Three circles of the simulated machine make the [squareness] of a file whose tables are closed by circles.
for plane in XY ZX YZ; do
  "$volcomp" simulate ball-bar --perfect --plane "$plane" --out "$work/$plane.csv" > /dev/null || failed=1
  "$volcomp" evaluate-ballbar "$work/$plane.csv" --json "$work/$plane.json" > /dev/null || failed=1
done
/usr/bin/python3 - "$source_dir/host_sim/machines/xyfz.toml" "$work" <<'PY' || failed=1
import json, pathlib, re, sys
text, work = pathlib.Path(sys.argv[1]).read_text(), pathlib.Path(sys.argv[2])
angle = {plane: json.loads((work / f"{plane}.json").read_text())["squareness_urad"] for plane in ("XY", "ZX", "YZ")}
for key, value in (("a_xy_rad", -angle["XY"]), ("a_xz_rad", angle["ZX"]), ("a_yz_rad", angle["YZ"])):
    text = re.sub(rf"{key} = .*", f"{key} = {value}e-6", text)
(work / "circles.toml").write_text(text.replace("at_mm = [-250.0", "circle_radius_mm = 100.0\nat_mm = [-250.0"))
PY
"$volcomp" simulate runs --perfect --out "$work/runs" > /dev/null || failed=1
tables=("$volcomp" build-tables --runs "$work"/runs/*.csv --machine)
expect 0 'by circles less along lines' "${tables[@]}" "$work/circles.toml" --out "$work/circles.vct" --json "$work/circles.tables"
expect 0 'squareness in the model' "${tables[@]}" "$source_dir/host_sim/machines/xyfz.toml" --out "$work/lines.vct" --json "$work/lines.tables"
# The machine is the same one, so the parameters of the model are, too: within what 11 targets leave.
/usr/bin/python3 - "$work/circles.tables" "$work/lines.tables" <<'PY' || failed=1
import json, sys
circles, lines = (json.load(open(name))["squareness_urad"] for name in sys.argv[1:])
for key, value in circles.items():
    if abs(value - lines[key]) > 2.0:
        sys.exit(f"FAILED: {key}: {value} µrad by circles, {lines[key]} by lines")
PY

expect 2 'leaves the travel of X' "$volcomp" machine check <(sed 's/^at_mm = \[-250.0/circle_radius_mm = 300.0\n&/' "$source_dir/host_sim/machines/xyfz.toml")
expect 2 'circle_radius_mm' "$volcomp" machine check <(sed 's/^at_mm = \[-250.0/circle_radius_mm = 0.1\n&/' "$source_dir/host_sim/machines/xyfz.toml")
sed -i '1d' "$work/xy.csv"
expect 2 "xy.csv: 'plane'" "$volcomp" evaluate-ballbar "$work/xy.csv"
one_line "$volcomp" evaluate-ballbar "$work/xy.csv"
expect 2 'nowhere.csv' "$volcomp" evaluate-ballbar "$work/nowhere.csv"
exit "$failed"
