#!/usr/bin/env bash
# However a run with firmware ends: it says why in a sentence, nothing hangs and nothing stays behind.
# shellcheck source=tests/system/firmware/common.sh
. "$(dirname "$0")/common.sh"

export TMPDIR=$work/tmp
mkdir "$TMPDIR"
run=("$volcomp" run xyfz --draws 0 --volume-points 10 --cycle-hz 50 --firmware m7)

# start_run: in the background until the machine moves; its process in $process, that of QEMU in $qemu.
start_run() {
  "${run[@]}" --firmware-image "$(image_of m7)" --log "$work/run.log" > "$work/run.txt" 2>&1 &
  process=$!
  # The log takes its place at the end.
  wait_for 'the machine moves' lines_are_more_than 20000 "$work/run.log.$process.tmp"
  qemu=$(pgrep -P "$process" qemu-system-arm)
}

# ends_with STATUS TEXT: the run ends so, and leaves neither QEMU nor files behind.
ends_with() {
  local status=0
  wait "$process" || status=$?
  if [ "$status" -ne "$1" ] || [ "$(head -n 1 "$work/run.txt")" != "$2" ]; then
    printf 'FAILED: wanted exit %s and "%s", got exit %s:\n' "$1" "$2" "$status"
    cat "$work/run.txt"
    failed=1
  fi
  holds 'QEMU is gone' test ! -e "/proc/$qemu"
  holds 'no file stays behind' test -z "$(ls "$TMPDIR")$(find "$work" -name 'run.log*')"
}

# --- QEMU is killed in the middle of the run
start_run
kill -KILL "$qemu"
ends_with 2 'volcomp: firmware m7: QEMU was ended by signal 9 (Killed)'

# --- the run is ended by the user
for signal in HUP TERM; do
  start_run
  kill "-$signal" "$process"
  ends_with "$((128 + $(kill -l "$signal")))" ''
done

# --- the run itself is killed: QEMU goes with it
start_run
kill -KILL "$process"
wait "$process" 2> /dev/null
wait_for 'QEMU ends with its host' test ! -e "/proc/$qemu"
rm -rf "${TMPDIR:?}"/*

# --- an image for another processor, and one that is none
expect 2 'firmware m4: QEMU ended with exit code 98; the firmware said:' \
  "$volcomp" run xyfz --draws 0 --firmware m4 --firmware-image "$(image_of m7)"
printf 'nonsense' > "$work/nonsense.elf"
expect 2 'firmware m7: ' "${run[@]}" --firmware-image "$work/nonsense.elf"
holds 'no file stays behind' test -z "$(ls "$TMPDIR")"
exit "$failed"
