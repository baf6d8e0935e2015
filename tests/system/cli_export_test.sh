#!/usr/bin/env bash
# volcomp export-tables as a user meets it: tables of known errors as files of controllers, read and evaluated by a
# reader of its own, and everything that cannot be exported.
# shellcheck disable=SC2016  # the dollars are those of sed and of Siemens
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$1
source_dir=$2
python=/usr/bin/python3

# The machine of the XYFZ paper without its squareness; X is longer than a steel rule says, bent in Y and Z, and
# 4 um apart in its two directions. Y and Z are without error.
machine=$work/machine.toml
sed '/^\[squareness\]/,$d' "$source_dir/host_sim/machines/xyfz.toml" >"$machine"
"$python" "$source_dir/tests/system/export_oracle.py" write "$work"
runs=("$work/runs_X.csv" "$work/runs_Y.csv" "$work/runs_Z.csv")

formats=(--format siemens linuxcnc isg)
expect 0 'entries X 81 Y 81 Z 81' "$volcomp" export-tables --machine "$machine" --runs "${runs[@]}" --out "$work/a" "${formats[@]}" \
  --json "$work/a.json"
"$python" "$source_dir/tests/system/export_oracle.py" check "$work/a" "$work/a.json" || failed=1

# What is not represented is looked for at every place where entries meet: fewer from here on.
few=(--entries 11)
from_runs=("$volcomp" export-tables --machine "$machine" --runs "${runs[@]}" --out "$work/few" "${few[@]}")
expect 0 'an entry is actual minus setpoint' "${from_runs[@]}" --format isg
expect 0 'they differ by up to 4.000 0.000 0.000 µm' "${from_runs[@]}" --format siemens
expect 0 '15 files' "${from_runs[@]}" "${formats[@]}"

# From the image of the same runs: the same files.
expect 0 'CRC-32' "$volcomp" build-tables --machine "$machine" --runs "${runs[@]}" --out "$work/tables.vct"
expect 0 '15 files' "$volcomp" export-tables --image "$work/tables.vct" --out "$work/b" "${few[@]}" "${formats[@]}"
diff -r "$work/few" "$work/b" || { echo 'FAILED: image and runs give different files'; failed=1; }

# Options of the controllers.
export=("$volcomp" export-tables --image "$work/tables.vct" --out "$work/c")
expect 0 '9 files' "${export[@]}" --format siemens "${few[@]}" --axis-names MX1 MY1 MZ1 --first-table 10 --cec-sign -1
grep -qx '$AN_CEC_INPUT_AXIS\[10\]=(MX1)' "$work/c/siemens_cec_x_to_y.ini" || { echo 'FAILED: --axis-names, --first-table'; failed=1; }
[ "$(grep -c 'AA_ENC_COMP\[0,' "$work/c/siemens_enc_comp_x.ini")" -eq 11 ] || { echo 'FAILED: --entries'; failed=1; }
expect 0 'nominal minus the offset' "${export[@]}" "${few[@]}" --format linuxcnc --comp-type 0
expect 0 'isg_ssfk_z.lis' "${export[@]}" "${few[@]}" --format isg --axis-numbers 4 5 9
grep -qx 'kopf.log_achs_nr 9' "$work/c/isg_ssfk_z.lis" || { echo 'FAILED: --axis-numbers'; failed=1; }
"${export[@]}" "${few[@]}" --format isg isg --json - 2>/dev/null | "$python" -c 'import json, sys
assert len(json.load(sys.stdin)["formats"]) == 1' || { echo 'FAILED: --json -'; failed=1; }

# What cannot be exported: exit 2, one sentence, the folder as it was.
cp -r "$work/c" "$work/before"
refused() {
  local text=$1
  shift
  expect 2 "$text" "$volcomp" export-tables --out "$work/c" --format siemens "$@"
  one_line "$volcomp" export-tables --out "$work/c" --format siemens "$@"
}
refused 'give --image' --machine "$machine"
refused 'give --image'
refused 'none.vct: cannot be opened' --image "$work/none.vct"
head -c 3000 "$work/tables.vct" >"$work/bad.vct"
refused 'image_truncated' --image "$work/bad.vct"
sed 's/\x00/\x01/' "$work/tables.vct" >"$work/bad.vct"
refused 'bad.vct:' --image "$work/bad.vct"
# A whole image of numbers that nobody means: every sum of it is right, and no node would take it.
"$python" - "$work/tables.vct" "$work/bad.vct" <<'PYTHON'
import struct, sys, zlib
image = bytearray(open(sys.argv[1], "rb").read())
knots, header = 81, 54  # of the last axis
end = len(image) - 4
block = end - 4 - knots * 48 - header
struct.pack_into("<f", image, block + header + 48, 3e38)
crc = 0xFFFFFFFF
for byte in image[block:end - 4]:
    crc ^= byte
    for _ in range(8):
        crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
struct.pack_into("<I", image, end - 4, crc ^ 0xFFFFFFFF)
struct.pack_into("<I", image, end, zlib.crc32(image[:end]))
open(sys.argv[2], "wb").write(image)
PYTHON
refused 'These tables can ask for more than the tick can represent. [bound_exceeded]' --image "$work/bad.vct"
expect 2 'bad.vct: ' "$volcomp" export-tables --out "$work/c" --format linuxcnc isg --image "$work/bad.vct"
expect 2 'standard input: ' "$volcomp" export-tables --out "$work/c" --format isg --image - <"$work/bad.vct"
refused 'larger than any table image' --image /dev/zero
refused 'bad_magic' --image "$machine"
: >"$work/empty.vct"
refused 'empty.vct: is empty' --image "$work/empty.vct"
sed 's/"Z"/"W"/; s/^moves_along = "W"/moves_along = "Z"/' "$machine" >"$work/other.toml"
sed 's/\(E[XYZABC]\)Z/\1W/g' "${runs[2]}" >"$work/runs_W.csv"
refused 'the axes are XYW' --machine "$work/other.toml" --runs "${runs[0]}" "${runs[1]}" "$work/runs_W.csv"
sed '0,/^sign = -1/s//sign = 1/' "$machine" >"$work/other.toml"
refused 'axis Y does not move the tool along +Y' --machine "$work/other.toml" --runs "${runs[@]}"
expect 2 '--entries' "${export[@]}" --format isg --entries 1
expect 2 '--format' "${export[@]}"
expect 2 '--format' "${export[@]}" --format fanuc
expect 2 'letters, digits' "${export[@]}" --format siemens --axis-names 'X 1' Y1 Z1
expect 2 '--image' "${export[@]}" --format isg --machine "$machine"
diff -r "$work/before" "$work/c" || { echo 'FAILED: a refused export touched the folder'; failed=1; }
touch "$work/file"
expect 2 'cannot be created' "$volcomp" export-tables --image "$work/tables.vct" --out "$work/file" --format isg
mkdir -p "$work/blocked/isg_ssfk_z.lis"
expect 2 'isg_ssfk_z.lis: cannot be written' "$volcomp" export-tables --image "$work/tables.vct" --out "$work/blocked" "${few[@]}" --format isg
[ ! -e "$work/blocked/isg_ssfk_x.lis" ] || { echo 'FAILED: partial output'; failed=1; }
leftover=$(find "$work" -name '*.tmp')
[ -z "$leftover" ] || { echo "FAILED: left behind: $leftover"; failed=1; }
exit "$failed"
