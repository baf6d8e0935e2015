#!/usr/bin/env bash
# Inside a fresh Debian: the packages install with what they depend on, serve, and leave nothing behind. Called by
# toolchain/test-package.sh.
#
#   deb_test.sh SOURCE_FOLDER PACKAGE_FOLDER REFERENCE_FILE
source_dir=$1
# shellcheck source=tests/system/packages/common.sh
. "$source_dir/tests/system/packages/common.sh"
reference=$(cat "$3")

apt-get install -y -qq --no-install-recommends "$2"/volcomp_*.deb >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
tools_run /usr
apt-get install -y -qq --no-install-recommends "$2"/libvolcomp-dev_*.deb >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
apt-get install -y -qq --no-install-recommends g++ cmake ninja-build pkg-config >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
all_users /usr
apt-get purge -y -qq volcomp libvolcomp-dev >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
left=$(find /usr -name '*volcomp*' ! -path "$source_dir/*")
[ -z "$left" ] || fail "purging leaves: $left"
printf 'purged: nothing is left\n'
