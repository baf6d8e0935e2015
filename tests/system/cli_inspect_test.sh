#!/usr/bin/env bash
# volcomp inspect: reference cases of traces and pitches with their grades, points on an involute of textbooks, and gears
# that cannot be graded.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
cd "$work" || exit 1
cp "$source_dir/docs/examples/gear.toml" gear.toml

# --- deviations: the cases of tests/data/cases, computed by another program
cat >cases.py <<'PYTHON'
import json, subprocess, sys
volcomp, source = sys.argv[1:]
count = 0
for case in json.load(open(f"{source}/tests/data/cases/seed-000.json"))["cases"]:
    kind = case["kind"].removeprefix("s0.").removesuffix("_eval")
    if kind not in ("profile", "lead", "pitch"):
        continue
    count += 1
    given, wanted = case["in"], case["out"]
    at = given.get("roll_length" if kind == "profile" else "x", [])
    with open("points.csv", "w") as file:
        file.write("deviation [mm],trace,flank,tooth,at [mm]\n")
        if kind == "pitch":
            for tooth, mm in enumerate(given["position_dev"], 1):
                file.write(f"{mm!r},pitch,right,{tooth},\n")
        else:
            for place, mm in zip(at, given["f"]):
                file.write(f"{mm!r},{kind},left,3,{place!r}\n")
    ran = subprocess.run([volcomp, "inspect", "points.csv", "--gear", "gear.toml", "--json", "-"], stdout=subprocess.PIPE,
                         stderr=subprocess.DEVNULL, check=True)
    trace, = json.loads(ran.stdout)["traces"]
    names = {"profile": {"F_a": "F", "f_fa": "f_f", "f_Ha": "f_H"}, "lead": {"F_b": "F", "f_fb": "f_f", "f_Hb": "f_H"},
             "pitch": {"f_pt": "f_pt", "F_p": "F_p"}}[kind]
    greek = {"profile": "alpha", "lead": "beta"}.get(kind, "")
    for symbol, name in names.items():
        value = wanted[name if kind == "pitch" else f"{name}{'_' if name == 'F' else ''}{greek}"]
        figure = trace["figures"][symbol]
        # The margin at the ends of the range is part of its length: 2e-5 of 20 mm.
        slack = 1e-9 + (2e-6 * abs(1e3 * value) if name == "f_H" else 0)
        assert abs(figure["iso1328_1995"]["um"] - 1e3 * value) < slack, (case["id"], symbol, figure, value)
        assert figure["iso1328_1995"]["grade"] == wanted["grades_1995"][name], (case["id"], symbol, figure)
        if kind == "lead":
            assert figure["iso1328_2013"]["grade"] == wanted["grades_2013"][name], (case["id"], symbol, figure)
assert count == 17, count
PYTHON
/usr/bin/python3 cases.py "$volcomp" "$source_dir" || { echo 'FAILED: reference cases'; failed=1; }

# --- points: an involute as textbooks have it, with excess that grows by 5 µm along the roll, a lead with 2 µm of crown
# points FILE [HELIX]: and teeth that are round the gear as on an eccentric one, 3 µm.
points() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import math, sys
path, helix = sys.argv[1], math.radians(float(sys.argv[2]) if len(sys.argv) > 2 else 0)
z, m, alpha, tip, width = 31, 4.0, math.radians(20), 132.0, 30.0
r = m * z / 2 / math.cos(helix)
alpha_t = math.atan(math.tan(alpha) / math.cos(helix))
rb = r * math.cos(alpha_t)
beta_b = math.atan(math.tan(helix) * math.cos(alpha_t))
begin, end = r * math.sin(alpha_t) - m / math.sin(alpha_t), math.sqrt(tip * tip / 4 - rb * rb)
def point(side, tooth, roll, x, excess):
    """Excess normal to the flank is excess / cos beta_b along the base tangent, which is a turn."""
    theta = roll / rb
    half = math.pi / (2 * z) + math.tan(alpha_t) - alpha_t  # of the tooth at the base circle
    phi = 2 * math.pi * (tooth - 1) / z + math.tan(helix) * x / r + side * (half - (theta - math.atan(theta)) + excess / math.cos(beta_b) / rb)
    rho = rb * math.sqrt(1 + theta * theta)
    return f"{x!r},{rho * math.cos(phi)!r},{rho * math.sin(phi)!r}"
with open(path, "w") as file:
    file.write("# simulated\ntrace,flank,tooth,X [mm],Y [mm],Z [mm]\n")
    for name, side in (("left", 1), ("right", -1)):
        for tooth in (1, 12):
            for i in range(101):
                roll = begin + (end - begin) * i / 100
                file.write(f"profile,{name},{tooth},{point(side, tooth, roll, 10, 5e-3 * i / 100)}\n")
        for i in range(101):
            x = 30 * i / 100
            file.write(f"lead,{name},1,{point(side, 1, 21.2, x, 2e-3 * (1 - (x / 15 - 1) ** 2))}\n")
        for tooth in range(1, z + 1):
            arc = 3e-3 * math.cos(2 * math.pi * (tooth - 1) / z)
            file.write(f"pitch,{name},{tooth},{point(side, tooth, 21.2, 15, arc * rb / r * math.cos(beta_b))}\n")
PYTHON
}
for helix in 0 15; do
  points points.csv "$helix"
  sed "s/^helix_angle_deg = .*/helix_angle_deg = $helix/" gear.toml >helical.toml
  expect 0 'ISO 1328-1:2013' "$volcomp" inspect points.csv --gear helical.toml --json gear.json --csv gear.csv
  /usr/bin/python3 - <<'PYTHON' || { echo "FAILED: points, helix $helix"; failed=1; }
import csv, json, math
gear = json.load(open("gear.json", encoding="utf-8"))
traces = gear["traces"]
assert [(t["trace"], t["flank"], t["tooth"]) for t in traces] == \
    [("profile", f, k) for f in ("left", "right") for k in (1, 12)] + [("lead", f, 1) for f in ("left", "right")] + \
    [("pitch", f, None) for f in ("left", "right")], traces
def near(figure, um, slack=0.06):
    assert abs(figure["iso1328_1995"]["um"] - um) < slack, (figure, um)
for t in traces:
    f = t["figures"]
    if t["trace"] == "profile":
        near(f["F_a"], 0.92 * 5), near(f["f_fa"], 0, 1e-6), near(f["f_Ha"], 0.92 * 5, 5e-3)
        assert abs(f["F_a"]["iso1328_2013"]["um"] - 0.95 * 5) < 0.06, f
        assert f["F_a"]["iso1328_1995"]["grade"] == 3, f
    elif t["trace"] == "lead":
        near(f["F_b"], 2 * 0.9 ** 2, 0.01), near(f["f_Hb"], 0, 1e-3)
    else:
        near(f["F_p"], 3 * (1 + math.cos(math.pi / 31)), 1e-3)
        near(f["f_pt"], 3 * 2 * math.sin(math.pi / 31), 1e-2)
worst = max(f["iso1328_1995"]["grade"] for t in traces for s, f in t["figures"].items() if s in ("F_a", "F_b", "f_pt", "F_p"))
assert gear["grade"]["iso1328_1995"] == {"covered": True, "grade": worst}, gear["grade"]
assert not gear["warnings"] and gear["filtered"] is False and gear["run_out"] is None
teeth = {(t["flank"], t["figure"]): t for t in gear["teeth"]}
assert len(gear["teeth"]) == len(teeth) == 6 and all(t["trace"] == "profile" and t["teeth"] == 2 for t in gear["teeth"]), gear["teeth"]
for (flank, figure), t in teeth.items():
    both = [u["figures"][figure]["iso1328_1995"]["um"] for u in traces if u["trace"] == "profile" and u["flank"] == flank]
    assert abs(t["iso1328_1995"]["mean_um"] - sum(both) / 2) < 1e-9, (t, both)
    assert t["iso1328_1995"]["worst_um"] == max(both, key=abs), (t, both)
rows = list(csv.DictReader(open("gear.csv")))
assert len(rows) == 4 * 3 + 2 * 3 + 2 * 2 and rows[0]["figure"] == "F_a" and rows[-1]["tooth"] == "all", rows
PYTHON
done

# --- the filter of 2013: a wave as long as the cut-off, a thirtieth of the range, keeps half its height, a slope stays;
# places that were touched twice count as their mean
/usr/bin/python3 - "$volcomp" <<'PYTHON' || { echo 'FAILED: filter'; failed=1; }
import json, math, subprocess, sys
begin, end = 62 * math.sin(math.radians(20)) - 4 / math.sin(math.radians(20)), math.sqrt(66 ** 2 - (62 * math.cos(math.radians(20))) ** 2)
length = 0.95 * (end - begin)
# A trace that begins and ends 1 mm beyond the range, where a filter has no data on one side.
def places(count):
    return [begin - 1 + (length + 2) * i / (count - 1) for i in range(count)]
def inspect(count, um, *options):
    with open("wave.csv", "w") as file:
        file.write("trace,flank,tooth,at [mm],deviation [um]\n")
        for at in reversed(places(count)):
            for deviation in um(at - begin):
                file.write(f"profile,left,1,{at!r},{deviation!r}\n")
    ran = subprocess.run([sys.argv[1], "inspect", "wave.csv", "--gear", "gear.toml", "--json", "-", *options],
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return json.loads(ran.stdout) if ran.returncode == 0 else ran.stderr
def figure(gear, symbol):
    return gear["traces"][0]["figures"][symbol]["iso1328_2013"]["um"]
wave = lambda x: [3 * math.sin(2 * math.pi * 30 * x / length) + 4 * x / length]
for options, height in ((), 6), (("--filter",), 3):
    gear = inspect(1501, wave, *options)
    # The mean line takes part in the wave: 30 waves of amplitude 1 tilt it by 6/(30 π).
    assert abs(figure(gear, "f_fa") / height - 1) < 0.04, (options, figure(gear, "f_fa"))
    assert abs(figure(gear, "f_Ha") - 4 + height / 2 * 6 / (30 * math.pi)) < 0.03 and gear["filtered"] is bool(options) and not gear["warnings"], (options, gear)
twice = inspect(301, lambda x: [1 + 2 * x / length, -1 + 2 * x / length], "--filter")
assert figure(twice, "f_fa") < 1e-9 and abs(figure(twice, "f_Ha") - 2) < 1e-3, twice
few = inspect(101, wave, "--filter")
assert few["warnings"] == [f"wave.csv: profile of tooth 1, left flank: {sum(begin <= at <= begin + length for at in places(101))} places in "
                           "the evaluation range, the edition of 2013 asks for 150"], few
far = inspect(41, wave, "--filter")
assert "wave.csv: profile of tooth 1, left flank: filter: " in far and "[gap]" in far, far
PYTHON

# --- run-out: a gear that stands 10 µm beside its axis, seen by a ball that touches where the pitch is measured
points points.csv
/usr/bin/python3 - >ball.txt <<'PYTHON'
import math
z, m, alpha = 31, 4.0, math.radians(20)
inv = lambda a: math.tan(a) - a
low, high = 0.0, 10.0
for _ in range(100):
    d = (low + high) / 2
    centre = math.atan((m * z / 2 * math.sin(alpha) + d / 2) / (m * z / 2 * math.cos(alpha)))  # roll of the contact and half the ball
    low, high = (d, high) if inv(centre) > inv(alpha) + d / (z * m * math.cos(alpha)) - math.pi / (2 * z) else (low, d)
print(d)
lines = open("points.csv").read().splitlines()
with open("beside.csv", "w") as file:
    file.write(lines[1] + "\n")
    r, rb = m * z / 2, m * z / 2 * math.cos(alpha)
    for name, side in (("left", 1), ("right", -1)):
        for tooth in range(1, z + 1):
            phi = 2 * math.pi * (tooth - 1) / z + side * math.pi / (2 * z)
            file.write(f"pitch,{name},{tooth},15,{r * math.cos(phi) + 0.010!r},{r * math.sin(phi)!r}\n")
PYTHON
expect 0 'F_r 19.9' "$volcomp" inspect beside.csv --gear gear.toml --ball-mm "$(cat ball.txt)" --json gear.json
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: run-out'; failed=1; }
import json, math
out = json.load(open("gear.json"))["run_out"]
# Spaces stand half a pitch from the teeth: one of 31 exactly opposite to the offset.
assert abs(out["F_r_um"] - 10 * (1 + math.cos(math.pi / 31))) < 0.01 and abs(out["eccentricity_um"] - 10) < 0.01, out
PYTHON

# --- a part of a trace is graded, and said
points points.csv
grep -v '^profile,left,12' points.csv >whole.csv
(head -n 2 points.csv && grep '^profile,left,1,' points.csv | sed -n 20,80p) >part.csv
expect 0 'warning: part.csv: profile of tooth 1, left flank: points from' "$volcomp" inspect part.csv --gear gear.toml
expect 0 'profile' "$volcomp" inspect - --gear gear.toml <part.csv
# A gear outside the tables of one edition.
sed 's/^width_mm = .*/width_mm = 1100/' gear.toml >wide.toml
grep -v '^lead' points.csv >wide.csv
expect 0 'ISO 1328-1:1995: has no grades for a gear of this size' "$volcomp" inspect wide.csv --gear wide.toml

# --- what cannot be used
refused() {
  expect 2 "$@" --csv never.csv --json never.json
  one_line "${@:2}" --csv never.csv --json never.json
}
bad() { refused "$1" "$volcomp" inspect bad.csv --gear gear.toml; }
damage() { sed "$1" whole.csv >bad.csv; }
damage '2s/,tooth//'
bad 'bad.csv:2: the header lacks the column tooth [missing_field]'
damage '2s/Z \[mm\]/Z [urad]/'
bad 'bad.csv:2: column "Z [urad]" has a unit of the wrong kind'
damage '2s/Z \[mm\]/Q [mm]/'
bad 'bad.csv:2: unknown column "Q [mm]"'
damage '2s/Z \[mm\]/at [mm]/'
bad 'bad.csv:2: X Y Z and at, deviation say the same'
damage '9s/left/upper/'
bad 'bad.csv:9: flank is "upper"'
damage '9s/profile/helix/'
bad 'bad.csv:9: trace is "helix"'
damage '9s/left,1,/left,0,/'
bad 'bad.csv:9: tooth "0" must be'
damage '9s/left,1,/left,32,/'
bad 'bad.csv:9: tooth 32: the gear has 31 teeth'
damage '9s/left,1,/left,2,/'
bad 'bad.csv:9: '
damage '9s/left,1,/right,1,/'
bad 'bad.csv:9: '
damage '9s/[^,]*$/nan/'
bad 'bad.csv:9: Z: "nan" must be finite'
damage '9s/,[^,]*$//'
bad 'bad.csv:9: 5 cells instead of 6'
grep -v '^pitch,left,7,' whole.csv >bad.csv
bad 'pitch of the left flanks'
refused 'bad.csv: pitch of the left flanks' "$volcomp" inspect bad.csv --gear gear.toml --ball-mm 7
grep -v '^pitch,left' whole.csv >bad.csv
refused 'bad.csv: run-out needs the pitch of both sides' "$volcomp" inspect bad.csv --gear gear.toml --ball-mm 7
refused 'whole.csv: a ball of 2 mm: ' "$volcomp" inspect whole.csv --gear gear.toml --ball-mm 2
expect 2 'ball-mm: -7 is not a number from 0.01' "$volcomp" inspect whole.csv --gear gear.toml --ball-mm -7
expect 0 'F_pk over 3 pitches, right flanks: ' "$volcomp" inspect whole.csv --gear gear.toml
(cat whole.csv && tail -n 1 whole.csv) >bad.csv
bad 'the pitch of tooth 31 is there twice'
(head -n 2 points.csv && grep '^profile,left,1,' points.csv | head -n 2) >bad.csv
bad 'bad.csv: profile of tooth 1, left flank: '
: >bad.csv
bad 'bad.csv: the file is empty'
head -n 2 points.csv >bad.csv
bad 'bad.csv: there is no point'
noise 2000 >bad.csv
bad 'bad.csv'
refused 'none.csv: cannot be opened' "$volcomp" inspect none.csv --gear gear.toml
refused 'none.toml: cannot be opened' "$volcomp" inspect whole.csv --gear none.toml
wrong_gear() {
  sed "$2" gear.toml >bad.toml
  refused "$1" "$volcomp" inspect whole.csv --gear bad.toml
}
wrong_gear 'module_mm' '/^module_mm/d'
wrong_gear 'bad.toml:' 's/^teeth = .*/teeth = 3/'
wrong_gear 'bad.toml:' 's/^width_mm = .*/width_mm = nan/'
wrong_gear 'bad.toml:' 's/^tip_diameter_mm = .*/tip_diameter_mm = 12/'
wrong_gear 'bad.toml:' 's/^teeth/tooth/'
wrong_gear 'not valid TOML' 's/=/:/'
refused 'whole.csv' "$volcomp" inspect whole.csv --gear whole.csv
expect 2 'cannot take the place of an input' "$volcomp" inspect whole.csv --gear gear.toml --json gear.toml
for file in never.csv never.json; do
  [ ! -e "$file" ] || { echo "FAILED: $file was written"; failed=1; }
done
exit "$failed"
