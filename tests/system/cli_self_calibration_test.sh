#!/usr/bin/env bash
# A machine that identifies itself, as a user meets it: by touching, over the bus as integrated, by tracers; and the tables
# of a plan with every kind of set-up, made by the simulated machine and taken by identify.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
cd "$work" || exit 1
run=("$volcomp" run self-calibration)

# value FILE KEY…: a figure of a JSON file.
value() {
  /usr/bin/python3 -c '
import json, sys
at = json.load(open(sys.argv[1]))
for key in sys.argv[2:]: at = at[key]
print(at)' "$@"
}
# holds SENTENCE EXPRESSION: of numbers, in Python.
holds() {
  /usr/bin/python3 -c "import sys; sys.exit(not ($2))" || { echo "FAILED: $1: $2"; failed=1; }
}

# --- four tracer stations: what is left is what was predicted, a tenth of what was there
expect 0 'PASS' "${run[@]}" --instrument tracer --seed 5 --json tracer.json
holds 'tracers' "$(value tracer.json after p95_um) < 1.5 * $(value tracer.json predicted p95_um)"
holds 'tracers' "$(value tracer.json after p95_um) < 0.15 * $(value tracer.json before p95_um)"
expect 0 'PASS' "${run[@]}" --instrument tracer --seed 5 --noise-free --json perfect.json
holds 'perfect instruments leave less' "$(value perfect.json after p95_um) < $(value tracer.json after p95_um)"

# --- many machines, on one processor as on several
expect 0 'of 4 machines are good' "${run[@]}" --instrument tracer --draws 4 --places 100 --json four.json
expect 0 'of 4 machines are good' taskset -c 0 "${run[@]}" --instrument tracer --draws 4 --places 100 --json one.json
cmp four.json one.json || { echo 'FAILED: another number of threads, other figures'; failed=1; }

# --- touched over the bus: what identify makes of the latches is, byte for byte, what the run made of them
small=$source_dir/tests/data/plan_small.toml
expect 0 "touches.csv" "$volcomp" simulate observations "$small" --out integrated
"${run[@]}" --plan "$small" --can loopback --places 20 --out bus --report report --json bus.json >bus.txt 2>&1
[ $? -le 1 ] || { echo "FAILED: over the bus: $(cat bus.txt)"; failed=1; }
grep -q 'CAN loopback' bus.txt || { echo 'FAILED: no word of the bus'; failed=1; }
[ -s report/report.html ] || { echo 'FAILED: no report'; failed=1; }
sed "s#../../host_sim#$source_dir/host_sim#" "$small" >bus/plan.toml
expect 0 'chi-square' "$volcomp" identify bus/plan.toml --out again.vct
cmp bus/tables.vct again.vct || { echo 'FAILED: identify makes other tables of the same touches'; failed=1; }
# Computed instead of moved: latches differ by what the edge comes late, 50 nm, and by the reversal of axes that arrived
# from another side.
"${run[@]}" --plan "$small" --places 20 --out computed --json computed.json >/dev/null 2>&1
/usr/bin/python3 - <<'PYTHON' || { echo 'FAILED: touches over the bus and computed ones'; failed=1; }
import csv
rows = [list(csv.DictReader(l for l in open(folder + "/touches.csv") if l[0] != "#")) for folder in ("bus", "computed")]
assert len(rows[0]) == len(rows[1]) > 200
worst = 0.0
for a, b in zip(*rows):
    assert all(a[k] == b[k] for k in ("setup", "sphere", "tip")), (a, b)
    worst = max(worst, *(abs(float(a[k]) - float(b[k])) for k in ("X [mm]", "Y [mm]", "Z [mm]")))
assert worst < 2e-3, worst
PYTHON

# --- every kind of set-up as files that identify takes
"$volcomp" plan --example every_kind | sed "s#trunnion.toml#$source_dir/host_sim/machines/trunnion.toml#" >all.toml
expect 0 'is planned at usual places' "$volcomp" plan all.toml
expect 0 'runs_X.csv' "$volcomp" simulate observations all.toml --out measured --perfect
cp all.toml measured/plan.toml
expect 0 'chi-square' "$volcomp" identify measured/plan.toml --out measured/tables.vct --json measured/found.json
holds 'perfect instruments fit' "$(value measured/found.json chi2) < 0.5 * $(value measured/found.json dof)"
for file in tracer bar diagonal step rtest touches runs_X; do
  [ -s "measured/$file.csv" ] || { echo "FAILED: no $file.csv"; failed=1; }
done
# Another seed, other readings; the same seed, the same bytes.
expect 0 'tracer.csv' "$volcomp" simulate observations all.toml --out again --perfect
diff -r -x plan.toml -x '*.vct' -x '*.json' measured again >/dev/null || { echo 'FAILED: the same seed, other readings'; failed=1; }
expect 0 'tracer.csv' "$volcomp" simulate observations all.toml --out other --machine-seed 2 --perfect
cmp -s measured/tracer.csv other/tracer.csv && { echo 'FAILED: another machine, the same readings'; failed=1; }
expect 0 'tracer.csv' "$volcomp" simulate observations all.toml --out seeded --seed 2 --perfect
for kind in tracer touches; do
  cmp -s <(grep -v '^#' "measured/$kind.csv") <(grep -v '^#' "seeded/$kind.csv") &&
    { echo "FAILED: another seed, the same $kind"; failed=1; }
done
head -n 1 measured/tracer.csv | grep -q '^# Simulated' || { echo 'FAILED: no word that it is simulated'; failed=1; }

# --- a step diagonal beside tracers: the tilt of its mirror does not make the work frame seen
{
  sed "s#../machines#$source_dir/host_sim/machines#" "$source_dir/host_sim/plans/xyfz_tracer.toml"
  cat <<'END'
[[setup]]
name = "step"
kind = "step"
along = "PPP"
beam_mm = [0, 0, 300]
file = "step.csv"
u_um = 0.1
machine_um = 0.7
END
} >step.toml
expect 0 'step.csv' "$volcomp" simulate observations step.toml --out step
cp step.toml step/plan.toml
expect 0 'chi-square' "$volcomp" identify step/plan.toml --no-leave-out

# --- an artefact that is not calibrated is as large as its known length
sed -e "s#../../host_sim#$source_dir/host_sim#" -e '/^u_um = 0.25/d' -e '/^scale_ppm = 0.71/d' \
  -e 's/^calibrated = true/calibrated = false\nlengths = [{ a = 0, b = 8, mm = 339.5, u_um = 0.5 }]/' "$small" >length.toml
expect 0 'touches.csv' "$volcomp" simulate observations length.toml --out length --perfect
cp length.toml length/plan.toml
expect 0 'chi-square' "$volcomp" identify length/plan.toml --no-leave-out

# --- readings and machine of a plan are never replaced
cp -r bus own
cp "$source_dir/host_sim/machines/xyfz.toml" own/machine.toml
sed -i "s#^file = \".*xyfz.toml\"#file = \"machine.toml\"#" own/plan.toml
cp -r own kept
expect 2 'cannot take the place of an input' "${run[@]}" --plan own/plan.toml --places 10 --json own/machine.toml
expect 2 'cannot take the place of an input' "${run[@]}" --plan own/plan.toml --places 10 --out own
expect 2 'cannot take the place of an input' "$volcomp" simulate observations own/plan.toml --out own
diff -r own kept || { echo 'FAILED: an input was replaced'; failed=1; }

# --- refused
sed 's/^tips = .*/tips = []/' step.toml >one_tip.toml
expect 1 'Seen only together: EAZ, EBZ, ECZ, EXZ' "$volcomp" plan one_tip.toml
sed 's/^tips = .*/tips = []/' length.toml >tips.toml
expect 2 'no sphere of set-up "flat" is within reach' "$volcomp" plan tips.toml
expect 2 'no sphere of set-up "flat" is within reach' "$volcomp" simulate observations tips.toml --out nothing
sed '/^radius_mm = 10.0/d' length.toml >radius.toml
expect 2 'has no radius_mm' "$volcomp" simulate observations radius.toml --out nothing
sed 's/^name = "flat"/name = "flat, left"/' length.toml >comma.toml
expect 2 "comma.toml:51: 'name' must have" "$volcomp" plan comma.toml
sed 's#^file = "step.csv"#file = "../step.csv"#' step.toml >outside.toml
expect 2 'outside the folder' "$volcomp" simulate observations outside.toml --out nothing
sed 's/^reference = true//; s/^u_mm = 0.1/&/' step.toml | sed '0,/^offset_mm.*/s//&\nu_mm = 0.1/' >tip.toml
expect 2 'reference_stylus' "$volcomp" plan tip.toml
[ ! -e nothing ] || { echo 'FAILED: something half written'; failed=1; }
expect 2 'no plan for l300g' "${run[@]}" --machine l300g
expect 2 'no plan for trunnion with tracer' "${run[@]}" --machine trunnion --instrument tracer
expect 2 'cannot be opened' "${run[@]}" --plan none.toml
expect 2 'excludes' "${run[@]}" --draws 3 --can loopback
sed '/^file = "bar.csv"/d' all.toml >nameless.toml
expect 2 'names no file' "$volcomp" simulate observations nameless.toml --out nameless
sed 's/^turns_deg = { A = \[-50/turns_deg = { A = [-95/' all.toml >far.toml
expect 2 'A does not turn to -95 degrees' "$volcomp" plan far.toml
sed 's/^turns_deg = { A/turns_deg = { X/' all.toml >slide.toml
expect 2 'X is a linear axis' "$volcomp" plan slide.toml
expect 2 'cannot be opened' "$volcomp" identify all.toml
[ ! -e nameless ] || { echo 'FAILED: something half written'; failed=1; }
exit "$failed"
