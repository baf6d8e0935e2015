#!/usr/bin/env bash
# The systemd unit of the node, by systemd's own judgement: valid, and exposed no more than 3.0 of 10.
set -u
node=$1 source_dir=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unit=$work/volcomp-node@can0.service
sed "s|^ExecStart=/usr/bin/volcomp-node|ExecStart=$node|" "$source_dir/firmware/posix/volcomp-node@.service" > "$unit"
failed=0
if ! said=$(systemd-analyze verify --man=no "$unit" 2>&1) || [ -n "$said" ]; then
  printf 'FAILED: the unit is not valid:\n%s\n' "$said"
  failed=1
fi
said=$(systemd-analyze security --offline=true --threshold=30 "$unit" 2>&1) ||
  { printf 'FAILED: the unit is exposed:\n%s\n' "$(tail -n 3 <<< "$said")"; failed=1; }
# Its options are options of the program.
"$node" --help > "$work/help"
while read -r option; do
  grep -q -- "$option " "$work/help" || { echo "FAILED: the program has no $option"; failed=1; }
done < <(grep '^ExecStart=' "$unit" | grep -oE -- '--[a-z-]+')
exit "$failed"
