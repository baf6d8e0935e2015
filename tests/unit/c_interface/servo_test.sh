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

# refused TEXT FILE: exit 2 and one line with this text.
refused() {
  local output status
  output=$("$servo_c" "$2" 2>&1)
  status=$?
  if [ "$status" -ne 2 ] || [ "$output" != "volcomp-servo-c: $2: $1" ]; then
    printf 'FAILED: wanted exit 2 and "%s", got exit %s:\n%s\n' "$1" "$status" "$output"
    failed=1
  fi
}
head -c 1000 "$image" >"$work/short"
refused 'The image is shorter or longer than its header says.' "$work/short"
{ head -c 5000 "$image"; printf '~'; tail -c +5002 "$image"; } >"$work/damaged"
refused 'The checksum is wrong; the image is damaged.' "$work/damaged"
refused 'This is not a volcomp table image.' "$0"
refused 'This is not a volcomp table image.' "$work/none"
exit "$failed"
