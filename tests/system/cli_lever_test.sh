#!/usr/bin/env bash
# volcomp check-lever as a user meets it: runs of one axis at two places with known angles, the classical mistakes, and
# runs that cannot tell.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
machine=$source_dir/host_sim/machines/xyfz.toml

# runs FILE LY LZ [CHANGE]: X with waves of angle, seen at the lever (., LY, LZ): EXX = head + EBX·LZ − ECX·LY.
runs() {
  /usr/bin/python3 - "$@" <<'PY'
import math, sys
path, ly, lz = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
change = sys.argv[4] if len(sys.argv) > 4 else ""
lines = ["target [mm],run,direction,EXX [mm],EYX [mm],EZX [mm],EAX [rad],EBX [rad],ECX [rad]"]
targets = 3 if change == "few" else 11
for i in range(targets):
    q = -500 + 500 * i / (targets - 1)
    b, c = 2e-5 * math.sin(0.011 * q), 1.5e-5 * math.cos(0.017 * q)
    if change == "straight":
        b = c = 0.0
    x = 1e-5 * q + b * lz - c * ly
    if change == "sign":
        b = -b
    if change == "arcsec":
        b, c = (math.degrees(a) * 3600 * 1e-6 for a in (b, c))
    if change == "swap":
        b, c = c, b
    lines.append(f"{q + (1 if change == 'shift' else 0)!r},1,up,{x!r},0,0,0,{b!r},{c!r}")
if change == "nan":
    lines[4] = lines[4].replace(",0,0,0,", ",nan,0,0,")
open(path, "w").write("\n".join(lines) + "\n")
PY
}
check=("$volcomp" check-lever --machine "$machine" --second-point 250 -90 900)

# The sensed point of X is 250 0 550: levers 350 mm for EBX and 90 mm for ECX.
runs "$work/first.csv" 0 550
runs "$work/second.csv" -90 900
expect 0 'PASS' "${check[@]}" --first "$work/first.csv" --second "$work/second.csv"
expect 0 'EBX: lever 350.0 mm expected, 350.0 found' "${check[@]}" --first "$work/first.csv" --second "$work/second.csv"
expect 0 'ECX: lever 90.0 mm expected, 90.0 found' "${check[@]}" --first "$work/first.csv" --second "$work/second.csv"

mistake() {
  runs "$work/first.csv" 0 550 "$1"
  runs "$work/second.csv" -90 900 "$1"
  expect "$2" "$3" "${check[@]}" --first "$work/first.csv" --second "$work/second.csv"
}
mistake sign 1 'EBX: lever 350.0 mm expected, -350.0 found, 18.1 allowed: wrong, as if a sign were the other way round'
expect 1 'FAIL' "${check[@]}" --first "$work/first.csv" --second "$work/second.csv"
mistake arcsec 1 'as if arc seconds were called urad'
mistake swap 1 'as if the two angles were exchanged'
mistake straight 2 'lever_spread_too_small'
mistake few 2 'too_few_points'
mistake nan 2 'not finite'
one_line "${check[@]}" --first "$work/first.csv" --second "$work/second.csv"

runs "$work/first.csv" 0 550
runs "$work/second.csv" -90 900 shift
expect 2 'the targets are not the same' "${check[@]}" --first "$work/first.csv" --second "$work/second.csv"
sed 's/\(E.\)X/\1Y/g' "$work/second.csv" >"$work/other.csv"
expect 2 'is of axis X' "${check[@]}" --first "$work/first.csv" --second "$work/other.csv"
sed 's/\(E.\)X/\1W/g' "$work/second.csv" >"$work/other.csv"
expect 2 'there is no axis W' "${check[@]}" --first "$work/other.csv" --second "$work/other.csv"
sed 's/\(E.\)X/\1B/g; s/target \[mm\]/target [deg]/' "$work/first.csv" >"$work/other.csv"
expect 2 'axis B is not linear' "$volcomp" check-lever --machine "$source_dir/host_sim/machines/l300g.toml" \
  --second-point 0 0 9 --first "$work/other.csv" --second "$work/other.csv"
expect 2 '--second-point' "$volcomp" check-lever --machine "$machine" --first "$work/first.csv" --second "$work/second.csv"
expect 2 'cannot be opened' "${check[@]}" --first "$work/none.csv" --second "$work/second.csv"
exit "$failed"
