#!/usr/bin/env bash
# Installs into a temporary folder, moves it, and builds users' programs against it.
#
#   installed_test.sh SOURCE_FOLDER BUILD_FOLDER VOLCOMP_SERVO
source_dir=$1
# shellcheck source=tests/system/packages/common.sh
. "$source_dir/tests/system/packages/common.sh"
reference=$("$3" "$image")

DESTDIR='' cmake --install "$2" --prefix "$work/first" >"$work/log" || { cat "$work/log"; exit 1; }
mv "$work/first" "$work/prefix"
all_users "$work/prefix"
tools_run "$work/prefix"

# They are its own: without them it does not run.
mv "$work/prefix/share/volcomp/machines/xyfz.toml" "$work"
answer=$("$work/prefix/bin/volcomp" run xyfz --draws 0 2>&1) && fail 'volcomp takes its machines from elsewhere'
grep -q 'share/volcomp/machines/xyfz.toml: no such machine file' <<<"$answer" || fail "volcomp says: $answer"
