#!/usr/bin/env bash
# volcomp calibrate-probe as a user meets it: a ball with known lobes on a sphere and in a ring, and touches that cannot
# be used.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
cd "$work" || exit 1

# touches FILE sphere|ring [CHANGE]: a ball of 1.5 mm with three lobes of 2 µm, 25 mm sphere or 50 mm ring at 10 -20 30.
touches() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import math, random, sys
path, shape, change = sys.argv[1], sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else ""
noise = random.Random(7)
lines = []
for level in ([-30, 0, 30, 60, 80] if shape == "sphere" else [0]):
    for i in range(24):
        e, a = math.radians(level), math.radians(15 * i + level)
        n = (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))  # pushes the ball, out of the part
        radius = 1.5 + 2e-3 * n[1] * (3 * n[0] ** 2 - n[1] ** 2)
        if change == "noisy":
            radius += noise.gauss(0, 3e-4)
        off = 12.5 + radius if shape == "sphere" else radius - 25.0
        at = [p + off * d for p, d in zip((10, -20, 30), n)]
        unit = 1e3 if change == "um" else 1.0
        row = [f"{x * unit!r}" for x in at]
        if change == "normal":
            row += [f"{3 * d!r}" for d in n]
        if change == "approach":
            row += [f"{-d!r}" for d in n]
        lines.append(",".join(row))
head = "X [mm],Y [mm],Z [mm]" + {"normal": ",NX,NY,NZ", "approach": ",AX,AY,AZ"}.get(change, "")
open(path, "w").write("\n".join([head.replace("mm", "um") if change == "um" else head] + lines) + "\n")
PYTHON
}

# --- a sphere, with and without directions; a ring
calibrate=("$volcomp" calibrate-probe)
for change in plain normal approach um; do
  touches points.csv sphere "$change"
  expect 0 'effective radius  1.500000 mm' "${calibrate[@]}" points.csv --sphere 25 --out probe.toml --json probe.json
  /usr/bin/python3 - sphere "$change" <<'PYTHON' || { echo "FAILED: sphere, $change"; failed=1; }
import json, sys, tomllib
found = json.load(open("probe.json", encoding="utf-8"))
wanted = [1.5] + 15 * [0]
wanted[10] = 2e-3
assert all(abs(a - b) < 1e-8 for a, b in zip(found["lobing_mm"], wanted)), found["lobing_mm"]
assert all(abs(a - b) < 1e-8 for a, b in zip(found["centre_mm"], (10, -20, 30))), found["centre_mm"]
assert found["touches"] == 120 and found["parameters"] == 16 and found["repeatability_um"] < 1e-6, found
assert found["coverage_factor"] == 2
settings = tomllib.load(open("probe.toml", "rb"))["setting"]
assert [s["object"] for s in settings] == [f"2302h:{k:02X}" for k in range(1, 17)] + ["2304h:01", "2304h:04"], settings
assert abs(settings[0]["value"] - 1.5e6) < 1e-2 and abs(settings[10]["value"] - 2000) < 1e-2
assert all(s["unit"] == "nm" and s["name"] for s in settings)
PYTHON
done
touches points.csv ring
expect 0 'coefficients that stay 0' "${calibrate[@]}" points.csv --ring 50 --json probe.json
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: ring'; failed=1; }
import json
found = json.load(open("probe.json", encoding="utf-8"))
assert abs(found["effective_radius_mm"] - 1.5) < 1e-8 and abs(found["lobing_mm"][10] - 2e-3) < 1e-8, found
assert found["parameters"] == 7 and abs(found["lobing_range_um"] - 4) < 1e-6, found
PYTHON
# The same ring upright: its axis along Y.
awk -F, 'NR == 1 || NF == 3 { print $1 "," $3 "," $2 }' points.csv | sed '1s/.*/X [mm],Y [mm],Z [mm]/' >upright.csv
expect 0 'effective radius  1.500000 mm' "${calibrate[@]}" upright.csv --ring 50 --ring-axis Y

# --- noise comes out as repeatability, and in the uncertainty with the certificate of the sphere: U(diameter)/2
touches points.csv sphere noisy
expect 0 'k = 2, from the residuals, 120 touches less 16 parameters; left out: that of the diameter' "${calibrate[@]}" points.csv --sphere 25 --json free.json
expect 0 'diameter of the artefact ± 0.4 µm' "${calibrate[@]}" points.csv --sphere 25 --artefact-um 0.4 --json stated.json
expect 0 'One radius' "${calibrate[@]}" --help
"${calibrate[@]}" points.csv --sphere 25 --constant --json constant.json >/dev/null
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: uncertainty'; failed=1; }
import json, math
free, stated, constant = (json.load(open(f + ".json", encoding="utf-8")) for f in ("free", "stated", "constant"))
s = free["repeatability_um"]
assert 0.25 < s < 0.35, s
assert math.isclose(free["lobing_U_um"], 2 * s * math.sqrt(16 / 120)), free
assert math.isclose(stated["effective_radius_U_um"], math.hypot(free["effective_radius_U_um"], 0.2)), stated
assert abs(free["effective_radius_mm"] - 1.5) < 1e-3 * free["effective_radius_U_um"], free
assert constant["lobing_range_um"] == 0 and constant["parameters"] == 4 and constant["repeatability_um"] > 0.8, constant
PYTHON
"${calibrate[@]}" points.csv --sphere 25 --out - 2>/dev/null | /usr/bin/python3 -c 'import sys, tomllib
assert len(tomllib.load(sys.stdin.buffer)["setting"]) == 18' || { echo 'FAILED: --out -'; failed=1; }
expect 0 'effective radius' "${calibrate[@]}" - --sphere 25 <points.csv

# --- what cannot be used
refused() {
  expect 2 "$@" --out never.toml --json never.json
  one_line "${@:2}" --out never.toml --json never.json
}
bad() {
  refused "$1" "${calibrate[@]}" bad.csv "${@:2}"
}
refused 'give --sphere or --ring' "${calibrate[@]}" points.csv
refused 'none.csv: cannot be opened' "${calibrate[@]}" none.csv --sphere 25
damage() { sed "$1" points.csv >bad.csv; }
damage '1s/Z \[mm\]/W [mm]/'
bad 'bad.csv:1: unknown column "W [mm]"' --sphere 25
cut -d , -f 1,2 points.csv >bad.csv
bad 'bad.csv:1: the header lacks the column Z [mm] [missing_field]' --sphere 25
damage '1s/X \[mm\]/X [deg]/'
bad 'bad.csv:1: column "X [deg]" has a unit of the wrong kind' --sphere 25
damage '1s/X \[mm\]/X/'
bad 'bad.csv:1: column "X" needs its unit' --sphere 25
damage '5s/^[^,]*/nan/'
bad 'bad.csv:5: X: "nan" must be finite' --sphere 25
damage '7s/,/;/'
bad 'bad.csv:7: 2 cells instead of 3' --sphere 25
: >bad.csv
bad 'bad.csv: the file is empty' --sphere 25
head -n 1 points.csv >bad.csv
bad 'bad.csv: there is no touch' --sphere 25
noise 2000 >bad.csv
bad 'bad.csv' --sphere 25
touches plane.csv ring
sed 1,2d plane.csv | cat <(head -n 1 points.csv) - >bad.csv
bad 'in a plane' --sphere 25
awk 'NR % 7 == 1' points.csv >bad.csv
bad '17 touches, 16 parameters need at least 20; a constant radius needs fewer [too_few_points]' --sphere 25
(head -n 1 points.csv && tail -n 23 points.csv && sed -n 2p points.csv) >bad.csv
bad 'the touches cover too little of the artefact' --sphere 25
sed -n '1,25p' points.csv >bad.csv
bad 'the touches cover too little of the artefact' --sphere 25
damage '9s/^[^,]*/23.9/'
bad 'bad.csv:9: the touch is' --sphere 25
damage ''
bad 'is the diameter of the artefact right' --sphere 30
bad 'mm off the fit, more than 0.05 mm [residuals_too_large]' --ring 25
touches points.csv sphere normal
damage '4s/\([^,]*,[^,]*,[^,]*\),.*/\1,0,0,0/'
bad 'bad.csv:4: the direction has no length [zero_normal]' --sphere 25
damage '1s/NZ/AZ/'
bad 'only one of them' --sphere 25
damage '1s/NX/NX [mm]/'
bad 'is a direction and has no unit' --sphere 25
expect 2 '--sphere: nan' "${calibrate[@]}" points.csv --sphere nan
expect 2 'excludes' "${calibrate[@]}" points.csv --sphere 25 --ring 50
expect 2 'cannot take the place of an input' "${calibrate[@]}" points.csv --sphere 25 --out points.csv
for file in never.toml never.json; do
  [ ! -e "$file" ] || { echo "FAILED: $file was written"; failed=1; }
done
exit "$failed"
