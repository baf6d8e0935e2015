#!/usr/bin/env bash
# Makes the Debian packages and proves in a fresh Debian 12 that they install and serve: users' programs in C++ and C,
# the tools, and nothing left behind. Not part of toolchain/test.sh: it needs root, a network and debootstrap.
#
#   toolchain/test-package.sh            the packages are in build/package/packages afterwards
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
need dpkg-shlibdeps cpack
build_preset host --target volcomp-servo
build_preset package
rm -rf build/package/packages
cpack --config build/package/CPackConfig.cmake > build/log/cpack.txt 2>&1 || { cat build/log/cpack.txt; exit 1; }
make_root
copy_to_root tests/system/packages firmware/embed/c/example.c firmware/embed/cpp/xyfz.vct
cp build/package/packages/*.deb "$root/source"
build/host/firmware/volcomp-servo firmware/embed/cpp/xyfz.vct > "$root/source/reference"
in_root bash /source/tests/system/packages/deb_test.sh /source /source /source/reference
