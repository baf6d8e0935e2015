#!/usr/bin/env bash
# The HAL component wired as volcomp.hal shows it, in the whole of LinuxCNC: interpreter, motmod, homing, a machine whose
# errors are known. After homing the tool is where it is told to be, and an operator reads it when an axis is far beyond its
# table. With the command of the motor in the place of that of the joint, the same test finds the errors of another place.
#
#   motion_test.sh SOURCE_FOLDER IMAGE     after hal_test.sh; an image of the machine of motion/known_errors.h
set -euo pipefail
motion=$1/tests/system/linuxcnc/motion
image=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C.UTF-8

fail() {
  printf 'FAILED: %s\n' "$*"
  cat "$work/read" "$work/said" 2>/dev/null || true
  exit 1
}

# operate: what the operator reads, in $work/read. LinuxCNC wants an ordinary user and a terminal.
operate() {
  rm -f "$work/read"
  chown -R 1000:1000 "$work"
  (cd "$work" && timeout 300 setpriv --reuid=1000 --regid=1000 --clear-groups env HOME="$work" \
    script -qec 'linuxcnc machine.ini' said </dev/null >/dev/null) || true
  grep -qx end "$work/read" || fail 'LinuxCNC did not come to the end'
}

# worst NOTE: of all places with this note, µm.
worst() {
  awk -v note="$1" '$1 == "place" && $6 == note && $5 > worst { worst = $5 } END { print worst + 0 }' "$work/read"
}

# is TEST: of numbers that have decimals.
is() {
  awk "BEGIN { exit !($1) }"
}

make -C "$motion" install >"$work/make.txt" 2>&1 || { cat "$work/make.txt"; fail 'the machine cannot be built'; }
cp "$motion"/{machine.ini,machine.hal,drives.hal,operate.py} /usr/share/volcomp/linuxcnc/volcomp.hal "$work"
cp "$image" "$work/machine.vct"
: >"$work/machine.tbl"
chmod 755 "$work/operate.py"

operate
[ "$(grep -c '^place' "$work/read")" = 6 ] || fail 'places are missing'
is "$(worst '') <= 2.0" || fail "the tool is $(worst '') um from where it was told to be"
is "$(worst uncorrected) > 40.0" || fail "there is nothing to correct: $(worst uncorrected) um"
[ "$(grep '^pins' "$work/read" | tr '\n' ' ')" = 'pins TRUE FALSE pins TRUE TRUE ' ] || fail 'beyond the table the pins say otherwise'
[ "$(grep '^message' "$work/read")" = 'message X is far beyond its compensation table and corrected as at its end' ] ||
  fail 'the operator reads something else'
printf 'as documented: %s um left of %s; far beyond its table said once\n' "$(worst '')" "$(worst uncorrected)"

# Only that the test can tell.
sed -i 's/^net \([xyz]\)-place joint.*/net \1-command volcomp.\1.position/' "$work/volcomp.hal"
operate
is "$(worst '') > 8.0" || fail "with the command of the motor: $(worst '') um"
printf 'with the command of the motor: %s um left\n' "$(worst '')"
