#!/usr/bin/env bash
# Builds the HAL component in a fresh Debian 12 with LinuxCNC and proves in its simulated realtime that it puts out what
# volcomp.h computes, and with the whole controller that its wiring leaves a machine of known errors within 2 um. Not part of toolchain/test.sh: it needs root, debootstrap and 250 MB of packages.
#
#   toolchain/test-linuxcnc.sh
#
# VOLCOMP_MIRROR is the Debian archive (default http://deb.debian.org/debian).
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"
# shellcheck source=toolchain/fresh-root.sh
. toolchain/fresh-root.sh

case "${1:-}" in
  '') ;;
  -h | --help) usage; exit 0 ;;
  *) die "unknown argument \"$1\" (try --help)." ;;
esac
build_preset package --target volcomp volcomp_c
make_root
in_root apt-get install -y -qq --no-install-recommends linuxcnc-uspace linuxcnc-uspace-dev gcc make pkg-config \
  > build/log/linuxcnc.txt 2>&1 || { tail -n 5 build/log/linuxcnc.txt; die "LinuxCNC could not be installed."; }
copy_to_root firmware/embed/cpp/xyfz.vct tests/system/linuxcnc

# build_image MACHINE_FILE IMAGE BUILD_TABLES_ARGUMENT...: from the run files in the folder of the sources.
build_image() {
  local machine=$1 image=$root/source/$2
  shift 2
  build/package/host_sim/volcomp build-tables --machine "$machine" --out "$image" "$@" > "build/log/$(basename "$image").txt"
}

(cd "$root/source" && awk -f tests/system/linuxcnc/gear_runs.awk)
build_image host_sim/machines/l300g.toml gear.vct --runs "$root"/source/{X,Y,B,A}.csv
motion=tests/system/linuxcnc/motion
in_root gcc -std=c99 -o /source/known_runs "/source/$motion/known_runs.c" -lm
in_root bash -c 'cd /source && ./known_runs'
build_image "$motion/machine.toml" known.vct --runs "$root"/source/{X,Y,Z}.csv

DESTDIR=$root cmake --install build/package --prefix /usr --component dev > build/log/install.txt
in_root bash /source/tests/system/linuxcnc/hal_test.sh /source /source/gear.vct
in_root bash /source/tests/system/linuxcnc/motion_test.sh /source /source/known.vct
