#!/usr/bin/env bash
# Proves what is promised of all code that runs beside a machine, and measures the images of the Cortex-M boards.
#
#   toolchain/evidence.sh --proofs     links all libraries whole for this computer and every board, and proves from these images and
#                                      those of the products: no heap, exceptions, globals, recursion ... (evidence/promises.py)
#   toolchain/evidence.sh              measures sizes, stack and instructions in QEMU and compares them with the budgets;
#                                      docs/evidence.md must show the same figures
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

build_whole() {
  build_preset host --target volcomp-whole
  build_preset m7 --target volcomp-whole volcomp-node volcomp-plain volcomp-servo volcomp-grinder
  build_preset m4 --target volcomp-whole volcomp-node volcomp-plain volcomp-servo
  build_preset a53 --target volcomp-whole volcomp-node
}

build_measured() {
  local board
  need qemu-system-arm llvm-mca
  for board in m7 m4; do
    build_preset "$board" --target volcomp-node volcomp-plain volcomp-servo volcomp-ticks volcomp-worst volcomp-latency volcomp-services volcomp-touches
  done
  build_preset m7 --target volcomp-grinder volcomp-strokes volcomp-trace
  build_preset host --target volcomp
  make_tables
  build_preset a53 --target volcomp-node
}

[[ ${1:-} != -h && ${1:-} != --help ]] || { usage; exit 0; }
need c++filt ar objdump g++ arm-none-eabi-g++ arm-none-eabi-objdump aarch64-linux-gnu-g++ aarch64-linux-gnu-objdump
case "${1:-}" in
  --self-test) ;;
  --proofs) build_whole ;;
  *) build_measured ;;
esac
# pyelftools is a package of Debian, and so for its python3.
exec /usr/bin/python3 toolchain/evidence "$@"
