#!/usr/bin/env bash
# volcomp learn as a user meets it: a log with a known error gives the opposite offset, a lag that Z and C have in common
# gives none, and what is no log of strokes is refused with its place.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
machine=$source_dir/host_sim/machines/internal_grinder.toml

# strokes FILE [CHANGE]: twelve slots in turns up and down at 13.4 mm/s, every 5 ms. Z and C lag their commands by 12 ms;
# C is 20 µrad · sin(2π z / 15 mm) off upwards and half of that, the other way, downwards.
strokes() {
  /usr/bin/python3 - "$@" <<'PY'
import math, sys
path, change = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else ""
teeth, beta, m_n, v, dt, lag = 79, math.radians(15), 2.0, 13.4, 5e-3, 0.012
p = m_n * teeth / (2 * math.sin(beta))  # mm/rad
head = ["t [s]", "Z command [mm]", "Z actual [mm]", "C command [deg]", "C actual [deg]"]
if change == "unit":
    head[1] = "Z command [deg]"
if change == "column":
    head[4] = "C real [deg]"
lines, t = [",".join(head)], 0.0
for k in range(12):
    up = k % 2 == 0
    for i in range(900):
        s = v * dt * i - 30
        if s > 30:
            break
        z = s if up else -s
        c = -z / p - 2 * math.pi * k / teeth
        moving = v if up else -v
        wave = math.sin(2 * math.pi * z / 15)
        e = 0 if change == "lag" else 20e-6 * wave if up else -10e-6 * wave
        za, ca = z - lag * moving, c + lag * moving / p + e
        t += dt
        if change == "gap" and k == 3 and i % 20 == 0:
            continue
        lines.append(f"{t!r},{z!r},{za!r},{math.degrees(c)!r},{math.degrees(ca)!r}")
if change == "nan":
    lines[7] = lines[7].replace(lines[7].split(",")[2], "nan")
if change == "back":
    lines[9] = lines[8]
if change == "part":  # begins and ends within the face
    lines = lines[:1] + lines[400:-400]
if change == "us":
    lines[0] = lines[0].replace("[s]", "[us]")
if change == "slot":
    lines = [lines[0] + ",slot"] + [l + ",79" for l in lines[1:]]
if change == "outside":
    lines = lines[:2] + [l for l in lines[2:] if abs(float(l.split(",")[1])) > 23]
open(path, "w").write("\n".join(lines) + "\n")
PY
}
learn=("$volcomp" learn --machine "$machine")

strokes "$work/strokes.csv"
expect 0 '6 passes upwards, 6 downwards, 0 discarded' "${learn[@]}" "$work/strokes.csv" --weight 1 --json "$work/learned.json" \
  -o "$work/learned.bin" --tables "$work/tables"
# Smoothed by [1/4 1/2 1/4] over nodes of 0.25 mm a wave of 15 mm keeps cos²(π 0.25/15) = 0.9973 of its size; the error of
# Z by its lag is v · 12 ms = 160.8 µm.
/usr/bin/python3 - "$work/learned.json" <<'PY' || failed=1
import json, math, sys
r = json.load(open(sys.argv[1]))
kept = math.cos(math.pi * 0.25 / 15) ** 2
l = r["learned"]
for name, size in (("upwards_rad", -20e-6), ("downwards_rad", 10e-6)):
    for j, found in enumerate(l[name]):
        z = l["z0_mm"] + j * l["pitch_mm"]
        if abs(z) < 22:
            assert abs(found - size * kept * math.sin(2 * math.pi * z / 15)) < 0.4e-6, (name, z, found)
assert max(abs(s) for s in l["slots_rad"]) < 0.3e-6
assert abs(r["feed_mm_per_s"] - 13.4) < 1e-6 and r["passes"] == {"upwards": 6, "downwards": 6}
t = {row["table"]: row for row in r["tables"]}
up = t["C along the stroke, Z upwards"]
assert up["after_um"] < 0.05 * up["before_um"], up
e = {row["what"]: row for row in r["errors"]}
assert abs(e["Z"]["flank_max_um"] / e["C"]["flank_max_um"] - 1) < 0.1
# 20 µrad of v · 12 ms / p, p = 305.23 mm/rad
assert abs(e["Z and C out of step"]["flank_max_um"] / e["Z"]["flank_max_um"] - 20e-6 / (13.4 * 0.012 / 305.23)) < 1e-3
PY
[ "$(head -c 8 "$work/learned.bin")" = VCSTROKE ] || { echo 'FAILED: no image for 2526h'; failed=1; }
[ -s "$work/tables/linuxcnc_z.comp" ] || { echo 'FAILED: no table for LinuxCNC'; failed=1; }

# With the tables in force nothing comes back: half as much again is not learned a second time.
strokes "$work/lag.csv" lag
expect 0 'learned' "${learn[@]}" "$work/lag.csv" --before "$work/learned.bin" --json "$work/again.json"
/usr/bin/python3 - "$work/learned.json" "$work/again.json" <<'PY' || failed=1
import json, sys
a, b = (json.load(open(f))["learned"] for f in sys.argv[1:])
for name in ("upwards_rad", "downwards_rad", "slots_rad"):
    assert max(abs(x - y) for x, y in zip(a[name], b[name])) < 1e-8, name
PY

expect 0 'report' "${learn[@]}" "$work/strokes.csv" --report "$work/out"
[ -s "$work/out/report.html" ] || { echo 'FAILED: no report'; failed=1; }
expect 0 'JSON' bash -c "\"$volcomp\" learn --machine \"$machine\" - --json - < \"$work/strokes.csv\" 2> /dev/null | /usr/bin/python3 -c 'import json,sys; json.load(sys.stdin); print(\"JSON\")'"

# A pass with lost cycles is not learned from, the others are.
strokes "$work/gap.csv" gap
expect 0 'pass_discarded' "${learn[@]}" "$work/gap.csv"
expect 0 '6 passes upwards, 5 downwards, 1 discarded' "${learn[@]}" "$work/gap.csv"

# Nor from a part of a pass.
strokes "$work/part.csv" part
expect 0 '5 passes upwards, 5 downwards, 2 discarded' "${learn[@]}" "$work/part.csv"
expect 0 'lines 2 to' "${learn[@]}" "$work/part.csv"

for wrong in 'us is the unit of the time right' 'slot slot 79, but the gear has 79 teeth' 'unit wrong kind' 'column unknown column' 'nan not_finite' 'back does not go on'; do
  strokes "$work/wrong.csv" "${wrong%% *}"
  expect 2 "${wrong#* }" "${learn[@]}" "$work/wrong.csv"
  one_line "${learn[@]}" "$work/wrong.csv"
done
strokes "$work/wrong.csv" outside
expect 2 'no whole pass' "${learn[@]}" "$work/wrong.csv"
expect 2 'xyfz.toml: has no [gear]' "$volcomp" learn --machine "$source_dir/host_sim/machines/xyfz.toml" "$work/strokes.csv"
printf '(1700000000.000000) can0 080#01\n' > "$work/frames.log"
expect 2 'xyfz.toml: has no [gear]' "$volcomp" learn --machine "$source_dir/host_sim/machines/xyfz.toml" "$work/frames.log"
expect 2 'bad_magic' "${learn[@]}" "$work/strokes.csv" --before "$machine"
expect 2 '--weight' "${learn[@]}" "$work/strokes.csv" --weight 2
expect 2 'two cycles' "${learn[@]}" "$work/frames.log"
expect 2 'no-such.csv' "${learn[@]}" no-such.csv
exit "$failed"
