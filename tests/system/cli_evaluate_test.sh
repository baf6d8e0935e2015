#!/usr/bin/env bash
# volcomp dump and volcomp evaluate: what an image holds, byte by byte, and what its tables say about positions.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
machines=$source_dir/host_sim/machines
cd "$work" || exit 1

for machine in xyfz trunnion; do
  cp "$machines/$machine.toml" "$machine.toml"
  expect 0 'runs_Z.csv' "$volcomp" simulate runs --machine "$machine.toml" --runs 2 --out "$machine"
  expect 0 'CRC-32' "$volcomp" build-tables --machine "$machine.toml" --runs "$machine"/runs_*.csv --out "$machine.vct" \
    --stamp somebody --expires 10
done

# --- the tables are those of the bytes, read by their layout (comp/tables/image.hpp)
for machine in xyfz trunnion; do
  "$volcomp" dump "$machine.vct" >"$machine.csv" || { echo "FAILED: dump $machine.vct"; failed=1; }
  expect 0 'chain w-' "$volcomp" dump "$machine.vct" --csv second.csv --json "$machine.json"
  cmp "$machine.csv" second.csv || { echo 'FAILED: the pipe holds other tables than the file'; failed=1; }
  /usr/bin/python3 - "$machine" <<'PYTHON' || { echo "FAILED: the dump of $machine is not its image"; failed=1; }
import csv, json, math, struct, sys, zlib
name = sys.argv[1]
data = open(name + ".vct", "rb").read()
text = open(name + ".csv", encoding="utf-8").read().splitlines()
dump = json.load(open(name + ".json", encoding="utf-8"))
axes, bodies = data[6], data[7]
crc = f"{zlib.crc32(data[:-4]):08X}"
assert dump["crc32"] == crc and f"CRC-32 {crc}" in text[0], (crc, text[0])
assert dump["provenance"]["machine_id"] == struct.unpack_from("<I", data, 12)[0]
assert dump["provenance"]["stamp"] == "somebody" and "expires_utc" in dump["provenance"]
assert dump["bytes"] == len(data) and len(dump["axes"]) == axes and len(dump["machine"]["bodies"]) == bodies
rows = list(csv.reader(line for line in text if not line.startswith("#")))
assert rows[0][:5] == ["axis", "knot", "direction", "position [mm]", "position [rad]"], rows[0]
assert rows[0][5:] == ["EX [um]", "EY [um]", "EZ [um]", "EA [urad]", "EB [urad]", "EC [urad]"], rows[0]
rows, at = iter(rows[1:]), 56 + 33 + 150 * bodies
for axis in dump["axes"]:
    q0, pitch, knots, periodic = struct.unpack_from("<qqIB", data, at)
    at += 54
    values = struct.unpack_from(f"<{12 * knots}f", data, at)
    at += 48 * knots + 4
    assert axis["periodic"] == bool(periodic) and len(axis["up"]) == len(axis["position"]) == knots
    turn = axis["unit"] == "rad"
    for k in range(knots):
        for travel, direction in enumerate(("up", "down")):
            row = next(rows)
            assert row[:3] == [axis["axis"], str(k + 1), direction], row
            place = (q0 + k * pitch) * (2 * math.pi / 2**40 if turn else 1e-6)
            assert row[3 + (not turn)] == "" and abs(float(row[3 + turn]) - place) < 1e-6, (row, place)
            held = values[6 * (travel * knots + k):][:6]
            for c in range(6):
                wanted = held[c] * (1e-3 if c < 3 else 1e6)
                assert math.isclose(float(row[5 + c]), wanted, rel_tol=2e-8, abs_tol=1e-12), (row, wanted)
                assert math.isclose(axis[direction][k][c], wanted, rel_tol=1e-12, abs_tol=1e-15)
assert next(rows, None) is None and at + 4 == len(data)
PYTHON
done

# --- image, and machine file with runs, are the same tables
evaluate=("$volcomp" evaluate xyfz.vct)
expect 0 'Z -200 mm' "${evaluate[@]}" --at -250,-150,-200 --csv image.csv --json image.json
expect 0 'built for this evaluation' "$volcomp" evaluate --machine xyfz.toml --runs xyfz/runs_*.csv --at -250,-150,-200 --csv runs.csv
cmp <(grep -v '^#' image.csv) <(grep -v '^#' runs.csv) || { echo 'FAILED: image and runs give different errors'; failed=1; }
grep -q '^# tables: xyfz.vct, CRC-32' image.csv || { echo 'FAILED: the CSV does not say where it comes from'; failed=1; }

# --- tick and model: within a nanometre of each other, all over the travel; 2^-32 turn is 1.5 nrad
for machine in xyfz:7 trunnion:3; do
  for direction in up down mean; do
    expect 0 'tick within' "$volcomp" evaluate "${machine%:*}.vct" --machine "${machine%:*}.toml" --grid "${machine#*:}" \
      --direction "$direction" --json grid.json --csv grid.csv
    /usr/bin/python3 - "$direction" <<'PYTHON' || { echo "FAILED: tick of $machine, $direction"; failed=1; }
import csv, json, sys
grid = json.load(open("grid.json", encoding="utf-8"))
assert grid["tick_within_1nm_promised"] and all(a["direction"] == sys.argv[1] for a in grid["axes"]), grid["axes"]
assert 0 < grid["tick_from_model_max"]["nm"] < 1 and grid["tick_from_model_max"]["nrad"] < 2.5, grid["tick_from_model_max"]
assert 0 < grid["model_from_exact_max"]["nm"] < 50, grid["model_from_exact_max"]
points = len(grid["points"])
assert points == (343 if len(grid["axes"]) == 3 else 243), points
rows = list(csv.reader(line for line in open("grid.csv", encoding="utf-8") if not line.startswith("#")))
assert len(rows) == points + 1 and len(set(map(len, rows))) == 1
assert len({tuple(row[:len(grid["axes"])]) for row in rows[1:]}) == points
PYTHON
  done
done
for direction in up down; do
  "${evaluate[@]}" --at -250,-150,-200 --direction "$direction" --csv - 2>/dev/null | grep -v '^#' >"$direction.csv"
done
if cmp -s up.csv down.csv; then echo 'FAILED: both directions give the same error'; failed=1; fi

# --- beyond the tables: held at the end, and said
expect 0 'X beyond the table' "${evaluate[@]}" --at 250,-150,-200 --csv beyond.csv
"${evaluate[@]}" --at 0,-150,-200 --csv end.csv >/dev/null
# The first column is the position, the last one the axes beyond.
values() { tail -n 1 "$1" | cut -d , -f 2- | rev | cut -d , -f 2- | rev; }
[ "$(values beyond.csv)" = "$(values end.csv)" ] || { echo 'FAILED: beyond the table it is not its end'; failed=1; }
[ "$(tail -n 1 beyond.csv | rev | cut -d , -f 1)" = X ] || { echo 'FAILED: the CSV does not name X'; failed=1; }
expect 0 'C 90 deg' "$volcomp" evaluate trunnion.vct --at 10,20,-30,-40,90 --at 0,0,0,0,0

# --- what cannot be used: one sentence, nothing written
refused() {
  expect 2 "$@" --csv never.csv --json never.json
  one_line "${@:2}" --csv never.csv --json never.json
}
refused 'give --at or --grid' "${evaluate[@]}"
refused 'give an image, or --machine and --runs' "$volcomp" evaluate --machine xyfz.toml --at 0,0,0
refused '--at 1,2: 2 positions, the machine has the axes X Y Z' "${evaluate[@]}" --at 1,2
refused '--at 1,nan,2: "nan" is not a number' "${evaluate[@]}" --at 1,nan,2
refused '--at 1,,2: "" is not a number' "${evaluate[@]}" --at 1,,2
refused '--at 1,2mm,2: "2mm" is not a number' "${evaluate[@]}" --at 1,2mm,2
refused '--at 1,2,1e9: "1e9" is not a number' "${evaluate[@]}" --at 1,2,1e9
refused 'has more than 100000 points' "${evaluate[@]}" --grid 47
refused 'trunnion.vct: tables of machine' "$volcomp" evaluate trunnion.vct --machine xyfz.toml --at 0,0,0,0,0
sed 's/EXX/EXA/; s/E\(.\)X/E\1W/g; s/EXA/EXW/' xyfz/runs_X.csv >w.csv
refused 'no runs given for axis X' "$volcomp" evaluate --machine xyfz.toml --runs w.csv xyfz/runs_Y.csv xyfz/runs_Z.csv --at 0,0,0
expect 2 'excludes' "${evaluate[@]}" --machine xyfz.toml --runs xyfz/runs_X.csv --at 0,0,0
for command in dump 'evaluate --at 0,0,0'; do
  read -ra words <<<"$command"
  run=("$volcomp" "${words[@]}")
  head -c 500 xyfz.vct >short.vct
  refused 'short.vct: ' "${run[@]}" short.vct
  refused 'xyfz.toml: ' "${run[@]}" xyfz.toml
  : >empty.vct
  refused 'empty.vct: ' "${run[@]}" empty.vct
  noise 3000 >noise.vct
  refused 'noise.vct: ' "${run[@]}" noise.vct
  refused 'none.vct: cannot be opened' "${run[@]}" none.vct
  /usr/bin/python3 -c 'import sys
data = bytearray(open("xyfz.vct", "rb").read())
data[-100] ^= 4
sys.stdout.buffer.write(data)' >flipped.vct
  refused 'axis Z' "${run[@]}" flipped.vct
  expect 2 'cannot take the place of an input' "${run[@]}" xyfz.vct --csv xyfz.vct
  expect 2 'only one result' "${run[@]}" xyfz.vct --csv - --json -
done
for file in never.csv never.json; do
  [ ! -e "$file" ] || { echo "FAILED: $file was written"; failed=1; }
done
exit "$failed"
