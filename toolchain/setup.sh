#!/usr/bin/env bash
# Installs what is missing to build, run and test volcomp on Debian or Ubuntu.
# What is there is left alone: a second run does nothing and needs neither root nor network.
#
#   toolchain/setup.sh          everything, for toolchain/test.sh
#   toolchain/setup.sh --demo   only what building and running needs
script_folder=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=toolchain/common.sh
. "$script_folder/common.sh"

build_packages=(g++ cmake ninja-build binutils ca-certificates pkg-config libeigen3-dev libfmt-dev libcli11-dev
  libinih-dev libtomlplusplus-dev libutfcpp-dev nlohmann-json3-dev libssl-dev libcpp-httplib-dev libgtest-dev libgmock-dev libbenchmark-dev)
check_packages=(ccache chromium doxygen fish git clang clang-format clang-tidy cppcheck liborocos-kdl-dev lld llvm man-db mandoc parallel python3
  python3-pyelftools shellcheck systemd valgrind zsh)
bus_packages=(can-utils iproute2 python3-can python3-canmatrix)
board_packages=(gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib g++-aarch64-linux-gnu
  qemu-system-arm gdb-multiarch)
vm_packages=(qemu-system-x86 busybox-static cpio kmod xz-utils)
report_folder=host_sim/host/report/page
eds_parser_folder=tests/system/eds_parser

installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2> /dev/null)" = installed ]
}

# Packages that carry clang's version in their names: its fuzzer and sanitizer libraries, and what a plugin of clang-tidy
# is compiled with (own_code.cpp).
clang_packages() {
  local version
  version=$(dpkg-query -W -f='${Version}' clang 2> /dev/null) || version=
  [ -n "$version" ] || version=$(apt-cache policy clang 2> /dev/null | awk '/Candidate:/ { print $2 }')
  version=${version#*:}
  version=${version%%.*}
  printf '%s\n' "libclang-rt-$version-dev" "libclang-$version-dev" "llvm-$version-dev"
}

# Node may come from elsewhere than Debian and bring its own npm, with which Debian's npm conflicts:
# so the commands decide, not the packages.
missing_packages() {
  local package
  local wanted=("${build_packages[@]}")
  if [ "$mode" = all ]; then
    mapfile -t -O "${#wanted[@]}" wanted < <(clang_packages)
    wanted+=("${check_packages[@]}" "${bus_packages[@]}" "${board_packages[@]}"
      "${vm_packages[@]}")
  fi
  for package in "${wanted[@]}"; do
    installed "$package" || printf '%s\n' "$package"
  done
  command -v node > /dev/null || printf 'nodejs\n'
  command -v npm > /dev/null || printf 'npm\n'
}

can_use_sudo() {
  command -v sudo > /dev/null && { sudo -n true 2> /dev/null || [ -t 0 ]; }
}

install_packages() {
  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    can_use_sudo ||
      die "these packages are missing and installing them needs root: $*."
    as_root=(sudo)
  fi
  printf 'installing: %s\n' "$*"
  "${as_root[@]}" apt-get update -qq ||
    die "the package lists could not be fetched (is there a network?); still missing: $*."
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "$@" > /dev/null ||
    die "apt-get could not install all of these packages: $*."
}

# install_node_modules FOLDER: the copy of the lock file beside the modules identifies their state.
install_node_modules() {
  local folder=$1
  local lock=$folder/package-lock.json
  local done_mark=$folder/node_modules/.installed-package-lock.json
  [ -f "$lock" ] || return 0
  cmp -s "$lock" "$done_mark" && return 0
  printf 'installing the JavaScript packages of %s\n' "$folder"
  (cd "$folder" && npm ci --no-audit --no-fund --loglevel=error) ||
    die "npm could not install the packages of $folder (is there a network?)."
  mkdir -p "$folder/node_modules"
  cp "$lock" "$done_mark"
}

mode=all
case "${1:-}" in
  '') ;;
  --demo) mode=demo ;;
  -h | --help) usage; exit 0 ;;
  *) die "unknown argument \"$1\" (try --help)." ;;
esac

{ command -v dpkg-query && command -v apt-get; } > /dev/null ||
  die "this script knows Debian and Ubuntu only; elsewhere install by hand what it lists at its top."

missing=$(missing_packages)
if [ -n "$missing" ]; then
  mapfile -t packages <<< "$missing"
  install_packages "${packages[@]}"
fi
install_node_modules "$report_folder"
[ "$mode" = demo ] || install_node_modules "$eds_parser_folder"
printf 'everything needed is installed\n'
