#!/usr/bin/env bash
# The table of docs/papers/xyfz.md is what its command prints, and README.md quotes the diagonal from it.
set -euo pipefail
volcomp=$1
readme=$2/README.md
page=$2/docs/papers/xyfz.md
printed=$("$volcomp" run xyfz --draws 0)
failed=0
rows=0
pnp=()
while read -r line; do
  rows=$((rows + 1))
  numbers=$(grep -oE '[0-9]+\.[0-9]+' <<<"$line" | tr '\n' ' ')
  pnp+=("$(cut -d ' ' -f 3 <<<"$numbers")")
  found=no
  while read -r candidate; do
    [ "$(tr -d '*' <<<"$candidate" | grep -oE '[0-9]+\.[0-9]+' | tr '\n' ' ')" = "$numbers" ] && found=yes
  done < <(grep '^|' "$page")
  [ "$found" = yes ] || { echo "FAILED: $page lacks the row: $line"; failed=1; }
done < <(grep -E '^ *(uncompensated|naive model|Abbe model)' <<<"$printed")
[ "$rows" -eq 4 ] || { echo "FAILED: $rows rows printed instead of 4"; failed=1; }
quoted="| ${pnp[0]} → ${pnp[-1]} µm |"
grep -qF "$quoted" "$readme" || { echo "FAILED: README.md does not quote the diagonal: $quoted"; failed=1; }
exit "$failed"
