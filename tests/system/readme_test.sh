#!/usr/bin/env bash
# The table of the README is what the command beside it prints.
set -euo pipefail
volcomp=$1
readme=$2/README.md
printed=$("$volcomp" run xyfz --draws 0)
failed=0
rows=0
while read -r line; do
  rows=$((rows + 1))
  numbers=$(grep -oE '[0-9]+\.[0-9]+' <<<"$line" | tr '\n' ' ')
  found=no
  while read -r candidate; do
    [ "$(tr -d '*' <<<"$candidate" | grep -oE '[0-9]+\.[0-9]+' | tr '\n' ' ')" = "$numbers" ] && found=yes
  done < <(grep '^|' "$readme")
  [ "$found" = yes ] || { echo "FAILED: the README lacks the row: $line"; failed=1; }
done < <(grep -E '^(uncompensated|naive model|Abbe model)' <<<"$printed")
[ "$rows" -eq 4 ] || { echo "FAILED: $rows rows printed instead of 4"; failed=1; }
exit "$failed"
