#!/usr/bin/env bash
# measure.sh VOLCOMP FOLDER IMAGE
#
# What the owner of the simulated machine measures without and with these tables, for `volcomp verify` and `evaluate-ballbar`;
# for `plan` the plan of a ball plate, and for `identify` readings of a case of an independent implementation.
set -euo pipefail
volcomp=$1 folder=$2 image=$3

rm -rf "$folder"
mkdir -p "$folder"
here=$(cd "$(dirname "$0")" && pwd)
"$volcomp" machine example xyfz > "$folder/xyfz.toml"
grep -v '^file = "touches' "$here/../data/plan_plate.toml" > "$folder/plate.toml"
mkdir "$folder/tracers"
python3 "$here/../system/identification_files.py" "$here/../data/cases/identification.json" id_solve_noisy_00 "$folder/tracers"
"$volcomp" simulate diagonals --points 5 --runs 5 --out "$folder/before.csv"
"$volcomp" simulate diagonals --points 5 --runs 5 --seed 2 --tables "$image" --out "$folder/after.csv"
"$volcomp" simulate ball-bar --out "$folder/circles.csv"
"$volcomp" simulate volume --points 50 --out "$folder/volume_before.csv"
"$volcomp" simulate volume --points 50 --tables "$image" --out "$folder/volume_after.csv"
