#!/usr/bin/env bash
# What a program says, to compare two versions of it: help of every command, files about the node, and every call that the
# tests of the command line make, with its output, exit code and JSON files. Times, temporary names
# and checksums of images are left out: an image holds the moment it was built.
#
#   tests/system/transcript.sh BUILD_FOLDER FOLDER    then compare two FOLDERs: diff -r BEFORE AFTER
set -euo pipefail
build=$(realpath "$1")
project=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
mkdir -p "$2"
folder=$(realpath "$2")
program=$build/host_sim/volcomp
node=$(find "$build/firmware" -name volcomp-node -type f -perm -u+x | head -1)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# help_of WORD…: of this command and of those below it.
help_of() {
  local command
  "$program" "$@" --help > "$folder/help/${*:-volcomp}.txt"
  awk '/^Subcommands:/ { on = 1; next } /^$/ { on = 0 } on && /^  [a-z]/ { print $1 }' "$folder/help/${*:-volcomp}.txt" |
    while read -r command; do help_of "$@" "$command"; done
}

# same_every_time: without temporary folders, times, speeds and process numbers.
same_every_time() {
  sed -E -e "s#$work#WORK#g; s#$build#BUILD#g; s#/tmp/tmp\.[A-Za-z0-9]+#WORK#g" \
    -e 's/[0-9.]+ (ns|ms|s)\b/T \1/g; s/"(elapsed|seconds|duration|median|ns)[^"]*": [0-9.e+-]+/"T"/g' \
    -e 's/CRC-32 [0-9A-F]{8}/CRC-32 C/g; s/"crc32": "[0-9A-F]{8}"/"crc32": C/g' \
    -e 's/20[0-9]{2}-[0-9]{2}-[0-9]{2}[T ][0-9:.]+Z?/DATE/g; s/process [0-9]+/process P/g'
}

mkdir -p "$folder/help" "$folder/node" "$folder/calls"
help_of
"$program" man > "$folder/help/man.txt"
for shell in bash zsh fish; do "$program" completion "$shell" > "$folder/help/completion.$shell"; done
"$program" explain > "$folder/node/explain.txt"
"$program" device-files --eds "$folder/node/volcomp.eds" --dbc "$folder/node/volcomp.dbc" \
  --objects "$folder/node/objects.md" --reasons "$folder/node/reasons.md" > "$folder/node/device-files.txt"
cp "$project/firmware/embed/c/volcomp.h" "$folder/node"

# Each call in its file, numbered within its test: the program under another name in its place.
cat > "$work/volcomp" << 'EOF'
#!/usr/bin/env bash
number=$(($(cat "$TRANSCRIPT.count") + 1))
printf '%s\n' "$number" > "$TRANSCRIPT.count"
record=$TRANSCRIPT/$(printf '%04d' "$number")
printf '%s ' "$@" > "$record"
# In the background, so that a signal to this script reaches the program; with job control, so that the program heeds it.
set -m
"$PROGRAM" "$@" <&0 > >(tee "$record.out") 2> >(tee "$record.err" >&2) &
child=$!
for signal in TERM INT HUP; do
  # shellcheck disable=SC2064 # of this signal
  trap "interrupted=yes; kill -$signal $child" "$signal"
done
while :; do
  interrupted=
  wait "$child" && status=0 || status=$?
  [ -n "$interrupted" ] || break
done
wait
printf '\nexit code %s\n' "$status" >> "$record"
while [ $# -gt 0 ]; do
  case $1 in --json | --csv | --out) [ ! -f "${2:-}" ] || cp "$2" "$record.file.${1#--}" ;; esac
  shift
done
exit "$status"
EOF
chmod +x "$work/volcomp"
export PROGRAM=$program
for test in "$project"/tests/system/cli_*_test.sh "$project/tests/system/cli_test.sh"; do
  name=$(basename "$test" .sh)
  case $name in
    cli_pipe_test | cli_can_test) continue ;; # bytes of a bus, in the order of the moment
    cli_setup_test | cli_shell_test) arguments=("$node" "$project") ;;
    cli_drive_test) arguments=("$project" "$build/tests/system/volcomp_drive_on_pipe") ;;
    *) arguments=("$project") ;;
  esac
  export TRANSCRIPT=$work/$name
  mkdir -p "$TRANSCRIPT"
  printf '0\n' > "$TRANSCRIPT.count"
  bash "$test" "$work/volcomp" "${arguments[@]}" > "$work/$name.log" 2>&1 || { printf '%s:\n' "$name"; tail -n 4 "$work/$name.log"; }
  mkdir -p "$folder/calls/$name"
  for record in "$TRANSCRIPT"/*; do
    # shellcheck disable=SC2094 # two folders
    same_every_time < "$record" > "$folder/calls/$name/$(basename "$record")"
  done
done
printf '%s files in %s\n' "$(find "$folder" -type f | wc -l)" "$folder"
