#!/usr/bin/env bash
# Balls touched with the node as firmware on the M7: every latch and every table is that of the loopback, bit for bit.
# shellcheck source=tests/system/firmware/common.sh
. "$(dirname "$0")/common.sh"

# touched NAME PLACE…: ends with 1, as so small a plan leaves too much.
touched() {
  local name=$1
  shift
  "$volcomp" run self-calibration --plan tests/data/plan_small.toml --places 10 --cycle-hz 100 "$@" \
    --out "$work/$name" --json "$work/$name.json" > "$work/$name.txt" 2>&1
  [ $? -le 1 ] || {
    printf 'FAILED: %s: %s\n' "$name" "$(cat "$work/$name.txt")"
    failed=1
  }
}
touched loopback --can loopback
touched m7 --firmware m7 --firmware-image "$(image_of m7)"
holds 'the latches of the M7 are those of the loopback' cmp "$work/m7/touches.csv" "$work/loopback/touches.csv"
holds 'its tables, too' cmp "$work/m7/tables.vct" "$work/loopback/tables.vct"
holds 'and its figures' diff <(grep -v '"transport"' "$work/m7.json") <(grep -v '"transport"' "$work/loopback.json")
exit "$failed"
