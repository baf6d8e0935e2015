# Sourced by the tests of the packages: users' programs, and what they have to put out.
#
# Needs source_dir, and reference: what volcomp-servo prints for the image of firmware/embed/cpp.
# shellcheck shell=bash disable=SC2034,SC2154
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
example=$source_dir/firmware/embed/c/example.c
image=$source_dir/firmware/embed/cpp/xyfz.vct
users=$source_dir/tests/system/packages

fail() {
  printf 'FAILED: %s\n' "$*"
  exit 1
}

# build_user FOLDER CMAKE_ARGUMENT…: the project of a user, with whatever compiler cmake finds.
build_user() {
  local folder=$1
  shift
  if ! { cmake -S "$users/$folder" -B "$work/build-$folder" -G Ninja "$@" &&
    cmake --build "$work/build-$folder" -j "${VOLCOMP_JOBS:-2}"; } >"$work/log" 2>&1; then
    tail -n 30 "$work/log"
    fail "the project $folder cannot be built"
  fi
}

# same_offsets WHAT PROGRAM: the offsets and status words of 40 000 servo periods are those of volcomp-servo.
same_offsets() {
  local wanted got
  wanted=$(grep fingerprint <<<"$reference")
  got=$("$2" "$image" | grep fingerprint) || got=nothing
  [ "$got" = "$wanted" ] || fail "$1: wanted \"$wanted\", got \"$got\""
  printf '%s: the same offsets\n' "$1"
}

# all_users PREFIX: programs that use what is installed there, by find_package and pkg-config, in C++ and in C alone.
all_users() {
  local prefix=$1
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix/lib" -name volcomp.pc)")
  export PKG_CONFIG_PATH
  build_user installed "-DCMAKE_PREFIX_PATH=$prefix"
  same_offsets 'find_package, C++' "$work/build-installed/consumer"
  build_user installed_c "-DCMAKE_PREFIX_PATH=$prefix" "-DEXAMPLE=$example"
  same_offsets 'find_package, C' "$work/build-installed_c/consumer"
  # shellcheck disable=SC2046  # words
  c++ -std=c++17 -Wall -Wextra -Werror -o "$work/cpp" "$users/consumer.cpp" $(pkg-config --cflags --libs volcomp)
  same_offsets 'pkg-config, C++' "$work/cpp"
  # shellcheck disable=SC2046
  cc -std=c99 -pedantic -Wall -Wextra -Werror -o "$work/c" "$example" $(pkg-config --cflags --libs volcomp_c)
  same_offsets 'pkg-config, C' "$work/c"

  # Every header needs only what is installed with it.
  find "$prefix/include/volcomp" -name '*.hpp' -printf '#include "%P"\n' | sort >"$work/all.cpp"
  [ "$(wc -l <"$work/all.cpp")" -gt 100 ] || fail 'headers are missing'
  # shellcheck disable=SC2046
  c++ -std=c++17 -fsyntax-only $(pkg-config --cflags volcomp) "$work/all.cpp"
  printf 'every header: complete\n'
}

# tools_run PREFIX: the tools start and know the machines that came with them.
tools_run() {
  "$1/bin/volcomp" machine check "$1/share/volcomp/machines/xyfz.toml" | grep -q good || fail 'volcomp machine check'
  "$1/bin/volcomp" run xyfz --draws 0 | grep -q PASS || fail 'volcomp run xyfz'
  "$1/bin/volcomp-node" --help | grep -q store || fail 'volcomp-node --help'
  local name=share/man/man1/volcomp
  grep -q '^\.TH VOLCOMP 1' "$1/$name.1" || fail "$name.1 is no manual page"
  grep -q '^\.TH VOLCOMP-NODE 1' "$1/$name-node.1" || fail "$name-node.1 is no manual page"
  "$1/bin/volcomp" __complete '' | grep -q build-tables || fail 'the completions know no command'
  for name in bash-completion/completions/volcomp zsh/vendor-completions/_volcomp fish/vendor_completions.d/volcomp.fish; do
    grep -q __complete "$1/share/$name" || fail "$name completes nothing"
  done
  printf 'tools: they run\n'
}
