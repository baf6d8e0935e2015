#!/usr/bin/env bash
# The servo loop in C puts out what the one in C++ does, to the last bit, and says what is wrong with an image.
set -u
servo_c=$1
servo=$2
image=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

"$servo" "$image" >"$work/wanted" || { echo 'FAILED: the loop in C++ does not run'; failed=1; }
"$servo_c" "$image" >"$work/got" || { echo 'FAILED: the loop in C does not run'; failed=1; }
grep -q 'fingerprint' "$work/wanted" || { echo 'FAILED: there is nothing to compare with'; failed=1; }
diff "$work/wanted" "$work/got" || { echo 'FAILED: the loop in C puts out something else'; failed=1; }

# says LINE COMMAND…: exit 2 and nothing but this line.
says() {
  local line=$1 output status
  shift
  output=$("$@" 2>&1)
  status=$?
  if [ "$status" -ne 2 ] || [ "$output" != "$line" ]; then
    printf 'FAILED: wanted exit 2 and "%s", got exit %s:\n%s\n' "$line" "$status" "$output"
    failed=1
  fi
}
# refused TEXT FILE: by both, with this text.
refused() {
  says "volcomp-servo-c: $2: $1" "$servo_c" "$2"
  says "volcomp-servo: $2: $1" "$servo" "$2"
}
says 'usage: volcomp-servo-c TABLE_IMAGE' "$servo_c"
says 'usage: volcomp-servo TABLE_IMAGE' "$servo" one two
head -c 1000 "$image" >"$work/short"
refused 'The image is shorter or longer than its header says.' "$work/short"
{ head -c 5000 "$image"; printf '~'; tail -c +5002 "$image"; } >"$work/damaged"
refused 'The checksum is wrong; the image is damaged.' "$work/damaged"
refused 'This is not a volcomp table image.' "$0"
refused 'This is not a volcomp table image.' "$work/none"
exit "$failed"
