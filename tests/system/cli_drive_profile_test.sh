#!/usr/bin/env bash
# volcomp run with drives as their data sheets have them: each that the node can correct, three different ones on one machine, and what is refused.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$(realpath "$1")
source_dir=$(realpath "$2")
cd "$work" || exit 1
run=("$volcomp" run xyfz --one-diagonal --can loopback --drive-profile)

# --- way 0
for drives in elmo_gold epos4_0150 epos4_0170 nanotec_cl4e elmo_gold,epos4_0170,nanotec_cl4e; do
  expect 0 'PASS 99.9' "${run[@]}" "$drives"
  expect 0 "drives $drives" "${run[@]}" "$drives"
done
cp "$source_dir/host_sim/drives/epos4_0170.eds" own.eds
expect 0 'PASS 99.9' "${run[@]}" ./own.eds
expect 0 'PASS ' "$volcomp" run machine --noise-free --places 10 --can loopback --drive-profile elmo_gold,epos4_0150,nanotec_cl4e,epos4_0170,elmo_gold
# --- targets from the node, where the drive has no offset; three ways on one machine
for drives in trinamic_tmcm1270 novanta_eve_net_c eyou elmo_gold,elmo_gold,eyou; do
  expect 0 'PASS 99.9' "${run[@]}" "$drives"
done
expect 0 'PASS ' "$volcomp" run machine --noise-free --places 10 --can loopback --drive-profile eyou
# A probe: 60D1h is in none of them, 60D5h in one.
expect 0 'PASS ' "$volcomp" run l300g --noise-free --drive-profile elmo_gold,epos4_0170,epos4_0170,elmo_gold
expect 2 'the machine has a touch probe, and the drive epos4_0150 no input for it' "$volcomp" run l300g --drive-profile epos4_0150

# --- in a machine file, by name and as a file beside it
"$volcomp" machine example xyfz | sed '0,/^name = "X"/s//name = "X"\ndrive = "epos4_0170"\nunits_per_mm = [1048576, 10]/' >machine.toml
grep -q '^drive = ' machine.toml || { echo 'FAILED: machine.toml names no drive'; failed=1; }
expect 0 'epos4_0170, way "offset", cannot report its offset' "$volcomp" machine show machine.toml
expect 0 'PASS 99.9' "$volcomp" run xyfz --one-diagonal --can loopback --machine machine.toml
mkdir -p folder
cp own.eds folder/mine.eds
sed 's/"epos4_0170"/"mine.eds"/' machine.toml >folder/machine.toml
expect 0 'mine.eds, way "offset"' "$volcomp" machine show folder/machine.toml

# --- refused
expect 2 "no such drive, did you mean 'epos4_0170'?; there are elmo_gold, epos4_0150" "${run[@]}" epos4_017
expect 2 '2 drives are named for 3 axes' "${run[@]}" elmo_gold,elmo_gold
expect 2 '--drive-profile requires --can' "$volcomp" run xyfz --one-diagonal --drive-profile elmo_gold
expect 2 '--drive-profile requires --can' "$volcomp" run internal-helical --drive-profile elmo_gold
one_line "${run[@]}" epos4_017
sed 's/"epos4_0170"/"eyou"/' machine.toml >eyou.toml
expect 2 'eyou.toml: axis X: the drive eyou cannot be corrected by way "offset": 60B0h is missing' "$volcomp" machine check eyou.toml
sed 's/^drive = .*/drive = "trinamic_tmcm1270"/' machine.toml >trinamic.toml
expect 2 '60B0h cannot be mapped into a receive PDO' "$volcomp" machine check trinamic.toml
for way in forwarded controller; do
  sed "s/^drive = .*/drive = \"epos4_0170\"\nway = \"$way\"/" machine.toml >"$way.toml"
  expect 0 "way \"$way\"" "$volcomp" machine show "$way.toml"
  expect 0 'PASS 99.9' "$volcomp" run xyfz --one-diagonal --can loopback --machine "$way.toml"
done
sed 's/^drive = .*/way = "sideways"/' machine.toml >way.toml
expect 2 'must be one of: offset, forwarded, controller, none' "$volcomp" machine check way.toml

exit "$failed"
