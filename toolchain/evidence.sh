#!/usr/bin/env bash
# Measures the images of the Cortex-M boards in QEMU, proves what they promise and compares both with the budgets.
#
#   toolchain/evidence.sh              builds, measures, judges; docs/evidence.md must show the same figures
#   toolchain/evidence.sh --write      the same, and renews the figures in docs/evidence.md
#   toolchain/evidence.sh --self-test  proves on small programs that the checks measure right and find each offence
#
# Results: build/evidence/evidence.json, build/evidence/evidence.md.
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

# What the nodes are given to store: measured tables, as large as the board has room for.
make_tables() {
  local volcomp=build/host/host_sim/volcomp out=build/evidence board runs
  "$volcomp" run xyfz --draws 0 --volume-points 10 --report "$out/report" > /dev/null
  runs=("$out"/report/campaign/noise_free/runs_*.csv)
  for board in m7:128 m4:64; do
    "$volcomp" build-tables --machine host_sim/machines/xyfz.toml --runs "${runs[@]}" --knots "${board#*:}" \
      --out "$out/tables-${board%:*}.vct" > /dev/null
  done
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
esac
need python3 c++filt arm-none-eabi-g++ arm-none-eabi-objdump
if [ "${1:-}" != --self-test ]; then
  need cmake ninja qemu-system-arm llvm-mca aarch64-linux-gnu-g++
  for board in m7 m4; do
    build_preset "$board" --target volcomp-node volcomp-servo volcomp-ticks volcomp-services volcomp-touches
  done
  build_preset m7 --target volcomp-grinder volcomp-strokes
  build_preset host --target volcomp
  make_tables
  build_preset a53 --target volcomp-node
fi
exec python3 toolchain/evidence "$@"
