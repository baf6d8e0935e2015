#!/usr/bin/env bash
# The HAL component in LinuxCNC's simulated realtime: every offset, status and range pin of thousands of servo periods is what
# volcomp.h computes for the same table image, and a bad image is refused. Installs the component, so only for a
# root to throw away: toolchain/test-linuxcnc.sh.
#
#   hal_test.sh SOURCE_FOLDER GEAR_IMAGE     with LinuxCNC and volcomp installed; an image of the L300G
set -euo pipefail
source_dir=$1
gear_image=$2
image=$source_dir/firmware/embed/cpp/xyfz.vct
periods=5000
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C.UTF-8

fail() {
  printf 'FAILED: %s\n' "$*"
  exit 1
}

# hal NAME: runs NAME.hal. LinuxCNC does not want to be run by root.
hal() {
  chown -R 1000:1000 "$work"
  timeout 120 setpriv --reuid=1000 --regid=1000 --clear-groups env HOME="$work" halrun -f "$work/$1.hal"
}

# write_hal IMAGE LETTER…: one row of the file is one servo period, from the first one on.
write_hal() {
  local vct=$1 letter in=0 out=0
  shift
  local rows='' samples='' nets=''
  for letter in "$@"; do
    rows+=fbb samples+=fubb
    nets+="net $letter-position streamer.0.pin.$in volcomp.$letter.position
net $letter-valid streamer.0.pin.$((in + 1)) volcomp.$letter.valid
net $letter-homed streamer.0.pin.$((in + 2)) volcomp.$letter.homed
net $letter-offset volcomp.$letter.offset sampler.0.pin.$out
net $letter-status volcomp.$letter.status sampler.0.pin.$((out + 1))
net $letter-out volcomp.$letter.out-of-range sampler.0.pin.$((out + 2))
net $letter-far volcomp.$letter.far-out-of-range sampler.0.pin.$((out + 3))
"
    in=$((in + 3)) out=$((out + 4))
  done
  cat >"$work/periods.hal" <<HAL
loadrt threads name1=servo period1=1000000
loadrt streamer depth=$((periods + 1)) cfg=${rows}b
loadrt sampler depth=$((periods + 1000)) cfg=${samples}b
loadrt volcomp image=$vct period_us=1000 limit_um=60 rate_um_per_s=5000 limit_urad=1000 rate_urad_per_s=50000 ramp_ms=100
${nets}net enable streamer.0.pin.$in volcomp.enable
net compensating volcomp.compensating sampler.0.pin.$out
addf streamer.0 servo
addf volcomp.update servo
addf sampler.0 servo
loadusr -w halstreamer $work/rows
start
loadusr -w halsampler -n $periods $work/got
getp volcomp.image-crc
getp volcomp.x.lag
HAL
}

# different COLUMN: how many different values it has.
different() {
  cut -d' ' -f"$1" "$work/got" | sort -u | wc -l
}

# same_as_c IMAGE LETTERS LOWER UPPER…: where each axis wanders to and fro.
same_as_c() {
  local vct=$1 letters=$2
  shift 2
  # shellcheck disable=SC2086  # several letters
  write_hal "$vct" $letters
  "$work/reference" "$vct" "$periods" "$work/rows" "$work/wanted" "$@"
  rm -f "$work/got"
  hal periods >"$work/halrun.txt" 2>&1 || { cat "$work/halrun.txt"; fail "$letters: halrun"; }
  diff -Z "$work/wanted" "$work/got" >"$work/differences" ||
    { head -n 12 "$work/differences"; fail "$letters: offsets, status or range differ (wanted <, got >)"; }
  [ "$(wc -l <"$work/got")" = "$periods" ] || fail "$letters: servo periods are missing"
  { [ "$(different 1)" -gt 1000 ] && [ "$(different 9)" -gt 1000 ]; } || fail "$letters: the offsets hardly change"
  [ "$(different 2)" -gt 5 ] || fail "$letters: the status hardly changes"
  awk '{ for (i = 4; i <= NF; i += 4) far += $i } END { exit !(far > 0 && far < NR) }' "$work/got" ||
    fail "$letters: never far beyond a table, or always"
  grep -qx "$(tail -c 4 "$vct" | od -An -tu4 | tr -d ' ')" "$work/halrun.txt" ||
    { cat "$work/halrun.txt"; fail "$letters: image-crc is not that of the file"; }
  awk '/^[0-9.e-]+$/ { if ($1 > 0 && $1 < 0.2) lag = 1 } END { exit !lag }' "$work/halrun.txt" ||
    { cat "$work/halrun.txt"; fail "$letters: no lag of X"; }
  printf '%s: offsets, status words and range of %s servo periods are the same\n' "$letters" "$periods"
}

# refused TEXT LOADRT_ARGUMENT…: the module does not load and says why.
refused() {
  local text=$1 answer
  shift
  printf 'loadrt volcomp %s\n' "$*" >"$work/bad.hal"
  if answer=$(hal bad 2>&1) || ! grep -qF -- "$text" <<<"$answer"; then
    fail "loadrt volcomp $*: wanted a refusal with \"$text\", got: $answer"
  fi
}

cp /usr/share/volcomp/linuxcnc/* "$work"
make -C "$work" install >"$work/make.txt" 2>&1 || { cat "$work/make.txt"; fail 'the component cannot be built'; }
# shellcheck disable=SC2046  # words
gcc -std=c99 -pedantic -Wall -Wextra -Werror -o "$work/reference" "$source_dir/tests/system/linuxcnc/reference.c" \
  $(pkg-config --cflags --libs volcomp_c)

same_as_c "$image" 'x y z' -510 5 -305 5 -405 5
same_as_c "$gear_image" 'x y b a' 150 600 145 350 -62 3 0 1000

head -c 3000 "$image" >"$work/short.vct"
refused 'volcomp: image=FILE is missing' ''
refused "volcomp: $work/none: the file cannot be opened." "image=$work/none"
refused "volcomp: $work/short.vct: The image is shorter or longer than its header says." "image=$work/short.vct"
refused 'volcomp: settings: axis X: limit: A setting is outside its range.' "image=$image" limit_um=5000
refused 'volcomp: settings: axis X: acceleration: A setting is outside its range.' "image=$image" max_acceleration=fast
refused 'volcomp: settings: axis Y: acceleration: The acceleration of an offset is less than one unit' \
  "image=$image" max_acceleration=4000,0.5
printf 'bad files and settings: refused\n'
