#!/usr/bin/env bash
# Builds volcomp and shows it at work: a simulated three-axis machine, its error along the space
# diagonals without and with compensation. Results go to build/demo.
#
#   toolchain/demo.sh                    run the demonstration
#   toolchain/demo.sh --update-picture   and refresh host_sim/host/report/page/xyfz-diagonals.svg
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

readonly output=build/demo
readonly committed_picture=host_sim/host/report/page/xyfz-diagonals.svg

update_picture=no
case "${1:-}" in
  '') ;;
  --update-picture) update_picture=yes ;;
  -h | --help) usage; exit 0 ;;
  *) die "unknown argument \"$1\" (try --help)." ;;
esac

step() {
  printf '\n[%s/4] %s\n' "$1" "$2"
}

show_report() {
  local report=$PWD/$output/report.html
  [ -f "$report" ] || die "the run wrote no $output/report.html."
  printf '\nThe report: file://%s\nThe picture: file://%s\n' "$report" "$PWD/$output/xyfz-diagonals.svg"
  if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && command -v xdg-open > /dev/null; then
    xdg-open "$report" > /dev/null 2>&1 || true
  fi
}

step 1 'Installing what is missing'
bash toolchain/setup.sh --demo

step 2 'Building (the first time takes a few minutes)'
need cmake ninja node
mkdir -p "$output"
cmake --preset host > "$output/configure.log" 2>&1 ||
  { cat "$output/configure.log"; die "configuring failed."; }
cmake --build --preset host --target volcomp -j "$(jobs_allowed)" || die "building failed."

step 3 'Measuring, compensating and verifying a simulated machine, 50 noisy campaigns'
build/host/host_sim/volcomp run xyfz --draws 50 --seed 1 --report "$output" --json "$output/xyfz.json" ||
  die "the simulation failed."

step 4 'Drawing the picture'
node host_sim/host/report/page/render-svg.mjs "$output/report.json" diagonals > "$output/xyfz-diagonals.svg" ||
  die "the picture could not be drawn."
if [ "$update_picture" = yes ]; then
  cp "$output/xyfz-diagonals.svg" "$committed_picture"
  printf 'refreshed %s\n' "$committed_picture"
fi
show_report
