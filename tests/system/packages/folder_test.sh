#!/usr/bin/env bash
# The folder comp alone, copied into the project of a user: no other file of volcomp is near it.
#
#   folder_test.sh SOURCE_FOLDER VOLCOMP_SERVO
source_dir=$1
# shellcheck source=tests/system/packages/common.sh
. "$source_dir/tests/system/packages/common.sh"
reference=$("$2" "$image")

mkdir "$work/third_party"
cp -r "$source_dir/comp" "$work/third_party/comp"
# Not optimized, headers parsed once: only that it builds matters, and the bits are the same.
build_user folder "-DCOMP=$work/third_party/comp" -DVOLCOMP_PRECOMPILE=ON
if grep -qF "$source_dir/comp" "$work/build-folder/build.ninja"; then
  fail 'the copied folder looks into the project it was copied from'
fi
same_offsets 'copied folder' "$work/build-folder/consumer"
