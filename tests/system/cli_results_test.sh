#!/usr/bin/env bash
# Where the results of a command go: whatever stands there, all of them or none, and never over an input.
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$(realpath "$1")
source_dir=$(realpath "$2")
examples=$source_dir/docs/examples
maps=$source_dir/tests/data/tables-002
cd "$work" || exit 1

# everything: all files and folders here with their kinds and modes, and what is in them.
everything() {
  find . -printf '%p %y %m %l\n' | sort
  find . -type f -exec sha256sum {} + | sort
}

# changes_nothing CODE TEXT COMMAND…: as expect, and every file and folder is as it was.
changes_nothing() {
  local before after
  before=$(everything)
  expect "$@"
  after=$(everything)
  [ "$before" = "$after" ] || { printf 'FAILED: %s changed:\n%s\n' "${*:3}" "$(diff <(echo "$before") <(echo "$after"))"; failed=1; }
}

# holds SENTENCE COMMAND…: the sentence says what is true if the command succeeds.
holds() {
  "${@:2}" || { echo "FAILED: $1"; failed=1; }
}

# is_json FILE: valid, and UTF-8.
# shellcheck disable=SC2317  # through holds
is_json() {
  /usr/bin/python3 -c 'import json, sys; json.load(open(sys.argv[1], encoding="utf-8"))' "$1"
}

cp "$source_dir/host_sim/machines/xyfz.toml" m.toml
cp "$maps/table5_omm_left_um.csv" a.csv
cp "$maps/table7_gmc_left_um.csv" b.csv
cp "$examples/linuxcnc_x.comp" x.comp
expect 0 'runs_Z.csv' "$volcomp" simulate runs --perfect --runs 1 --out runs
build=("$volcomp" build-tables --machine m.toml --runs runs/runs_X.csv runs/runs_Y.csv runs/runs_Z.csv)
expect 0 'CRC-32' "${build[@]}" --out t.vct
expect 0 'diagonals' "$volcomp" simulate diagonals --perfect --points 5 --runs 1 --out before.csv
expect 0 'diagonals' "$volcomp" simulate diagonals --perfect --points 5 --runs 1 --tables t.vct --out after.csv
verify=("$volcomp" verify before.csv after.csv)
import=("$volcomp" import linuxcnc --axis X --unit mm --type 0 --absent zero)
compare=("$volcomp" compare a.csv b.csv)

# --- the last of several results cannot be written: none is there, the earlier ones are as they were
changes_nothing 2 'none/x: cannot be written' "${build[@]}" --stamp other --out t.vct --json none/x
changes_nothing 2 'none/x: cannot be written' "${import[@]}" --out imported x.comp --json none/x
changes_nothing 2 'none/x: cannot be written' "${verify[@]}" --report report --csv none/x
changes_nothing 2 'none/x: cannot be written' "${verify[@]}" --json v.json --csv none/x
changes_nothing 2 'none/x: cannot be written' "$volcomp" device-files --eds e.eds --dbc none/x
changes_nothing 2 'none/x: cannot be written' "$volcomp" simulate runs --seed 9 --out runs --json none/x
changes_nothing 2 'none/x: cannot be written' "$volcomp" export-tables --image t.vct --out controller --format isg --entries 5 --json none/x
changes_nothing 2 'none/x: cannot be written' "${compare[@]}" --report report --json none/x
changes_nothing 2 'none/x: cannot be written' "$volcomp" run machine --places 10 --report report --json none/x
# ... and a node on a bus is not asked, nor a run of minutes begun: there is no such bus
changes_nothing 2 'none/x: cannot be written' "$volcomp" download t.vct --can pipe:none --json none/x
changes_nothing 2 'm.toml: cannot be created' "$volcomp" run xyfz --can pipe:none --report m.toml
mkdir -p controller/kept
changes_nothing 2 'm.toml: cannot be created' "${verify[@]}" --json v.json --report m.toml
changes_nothing 2 'standard output: cannot be written' bash -c '"$@" >/dev/full' - "${verify[@]}" --json - --csv v.csv
# What is written into a folder that comes with another result.
expect 0 'PASS' "${verify[@]}" --report in_one --json in_one/v.json --csv in_one/v.csv
for file in report.html report.json v.json v.csv; do
  holds "$file is in the folder" test -s "in_one/$file"
done

# --- a result that is an input, or two with one place
taken='a result cannot take the place of an input'
twice='two results cannot have one place'
ln -s m.toml link.toml
changes_nothing 2 "m.toml: $taken" "${build[@]}" --out m.toml
changes_nothing 2 "link.toml: $taken" "${build[@]}" --out t.vct --json link.toml
changes_nothing 2 "runs/../runs/runs_Y.csv: $taken" "${build[@]}" --out runs/../runs/runs_Y.csv
changes_nothing 2 "same: $twice" "${build[@]}" --out same --json same
changes_nothing 2 "./same: $twice" "${build[@]}" --out same --json ./same
changes_nothing 2 "m.toml: $taken" "$volcomp" machine check m.toml --json m.toml
changes_nothing 2 "before.csv: $taken" "${verify[@]}" --json before.csv
changes_nothing 2 "t.vct: $taken" "${verify[@]}" --machine m.toml --tables t.vct --csv t.vct
changes_nothing 2 "v: $twice" "${verify[@]}" --json v --csv v
changes_nothing 2 "in_one/report.json: $twice" "${verify[@]}" --json in_one/report.json --report in_one
changes_nothing 2 "a.csv: $taken" "${compare[@]}" --json a.csv
changes_nothing 2 "same: $twice" "$volcomp" device-files --eds same --dbc same
changes_nothing 2 'only one result can go to standard output' "$volcomp" device-files --eds - --dbc -
changes_nothing 2 "x.comp: $taken" "${import[@]}" --out imported x.comp --json x.comp
changes_nothing 2 "t.vct: $taken" "$volcomp" export-tables --image t.vct --out controller --format isg --json t.vct
changes_nothing 2 "m.toml: $taken" "$volcomp" run xyfz --one-diagonal --machine m.toml --json m.toml
changes_nothing 2 "same: $twice" "$volcomp" run xyfz --one-diagonal --can loopback --log same --json same
# Names that are known only when the input has been read.
changes_nothing 2 "runs/runs_X.csv: $twice" "$volcomp" simulate runs --seed 9 --out runs --json runs/runs_X.csv
expect 0 'runs_X.csv' "${import[@]}" --out imported x.comp
cp x.comp imported/runs_X.csv
changes_nothing 2 "imported/runs_X.csv: $taken" "${import[@]}" --out imported imported/runs_X.csv
# Before anything is read.
changes_nothing 2 "m.toml: $taken" "$volcomp" build-tables --machine m.toml --runs none.csv --out m.toml
# There is room for any number.
ln -s /dev/null nothing
changes_nothing 0 'PASS' "${verify[@]}" --json nothing --csv nothing

# --- what stands where a result goes
expect 0 '' bash -c '"$@" && echo written' - "$volcomp" device-files --eds e.eds
mkfifo pipe
timeout 20 cat pipe >got.eds &
expect 0 'written' bash -c '"$@" && echo written' - timeout 20 "$volcomp" device-files --eds pipe
holds 'a pipe stays' test -p pipe
wait
holds 'a pipe gets the result' cmp got.eds e.eds
echo old >real.eds
ln -s real.eds link.eds
"$volcomp" device-files --eds link.eds
holds 'a link stays' test -L link.eds
holds 'the file behind a link is replaced' cmp real.eds e.eds
"$volcomp" device-files --eds nothing
holds 'a device stays' test -c nothing
ln -s /dev/fd/1 output
"$volcomp" device-files --eds output >got.eds
holds 'a descriptor stays' test -L output
holds 'a descriptor gets the result' cmp got.eds e.eds
echo old >secret.eds
chmod 600 secret.eds
"$volcomp" device-files --eds secret.eds
holds 'the mode of a file is kept' test "$(stat -c %a secret.eds)" = 600
holds 'a file that others may not read is replaced' cmp secret.eds e.eds
echo old >kept.eds
chmod 444 kept.eds
changes_nothing 2 'kept.eds: cannot be written' "$volcomp" device-files --eds kept.eds
changes_nothing 2 'kept.eds: cannot be written' "$volcomp" device-files --dbc new.dbc --eds kept.eds

# --- a run into a pipe: the figures or the log, words beside them
one=("$volcomp" run xyfz --one-diagonal --can loopback --cycle-hz 50)
"${one[@]}" --json - >figures.json 2>words.txt
holds 'the figures of a run go to standard output' is_json figures.json
holds 'the words of a run go beside its figures' grep -q 'transport: ' words.txt
"${one[@]}" --log - >bus.log 2>words.txt
holds 'the words of a run go beside its log' grep -q 'transport: ' words.txt
expect 0 'the node did the same again' "$volcomp" replay bus.log
expect 2 'only one result can go to standard output' "${one[@]}" --json - --log -
holds 'no file has the name of standard output' test ! -e -

# --- a run that is interrupted leaves the earlier log
echo old >bus.log
"$volcomp" run xyfz --draws 0 --can loopback --log bus.log >/dev/null 2>&1 &
run=$!
while kill -0 "$run" 2>/dev/null && [ ! -s "bus.log.$run.tmp" ]; do
  sleep 0.05
done
kill -TERM "$run"
wait "$run"
holds 'a run that is interrupted ends by the signal' test "$?" = 143
holds 'an interrupted run leaves the earlier log' grep -qx old bus.log

# --- and leaves nothing where its campaign was
mkdir tmp
TMPDIR=$PWD/tmp "$volcomp" run xyfz --draws 10000 >/dev/null 2>&1 &
run=$!
while kill -0 "$run" 2>/dev/null && [ -z "$(ls tmp)" ]; do
  sleep 0.05
done
kill -TERM "$run"
wait "$run"
holds 'a run without a bus ends by the signal' test "$?" = 143
holds 'an interrupted run leaves no temporary folder' rmdir tmp

# --- nobody reads: a signal ends the command, and no draft is left
"${build[@]}" --out t.vct --json - >words.txt 2>&1
mkfifo unread
exec 8<>unread
dd if=/dev/zero of=unread bs=4096 oflag=nonblock status=none 2>/dev/null  # full

# drafts PID: of the results of a command, with something in them.
drafts() { find . -name "*.$1.tmp" -size +0; }

# leaves_no_draft SIGNAL NUMBER COMMAND…: which writes a file and, to standard output, what is not read.
leaves_no_draft() {
  local before blocked
  before=$(everything)
  /usr/bin/python3 -c 'import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)  # a shell ignores it in the background
os.execvp(sys.argv[1], sys.argv[1:])' "${@:3}" >unread 2>/dev/null &
  blocked=$!
  while kill -0 "$blocked" 2>/dev/null && [ -z "$(drafts "$blocked")" ]; do
    sleep 0.05
  done
  kill -"$1" "$blocked"
  wait "$blocked"
  holds "SIG$1 ends ${*:3:2}, which nobody reads" test "$?" = $((128 + $2))
  holds "${*:3:2} leaves everything as it was" test "$before" = "$(everything)"
}
leaves_no_draft INT 2 "${build[@]}" --stamp other --out t.vct --json -
leaves_no_draft TERM 15 "${build[@]}" --stamp other --out new.vct --json -
leaves_no_draft INT 2 "${verify[@]}" --csv figures.csv --json -
leaves_no_draft TERM 15 "${verify[@]}" --report new_report --json -
leaves_no_draft INT 2 "$volcomp" export-tables --image t.vct --out new_controller --format isg --entries 5 --json -
leaves_no_draft TERM 15 "$volcomp" export-tables --image t.vct --out new_controller --format isg --entries 5 --json -
leaves_no_draft INT 2 "$volcomp" simulate runs --seed 9 --out runs --json -
leaves_no_draft TERM 15 "$volcomp" simulate runs --seed 9 --out new_runs --json -
exec 8<&-

# --- what stands is said when only the words about it cannot be written
# shellcheck disable=SC2317  # through expect
no_words() { "$@" >&-; }
# shellcheck disable=SC2317  # through expect
nothing_heard() { "$@" 2>/dev/full; }
rm t.vct
expect 2 'standard output: cannot be written; the results stand: t.vct' no_words "${build[@]}" --out t.vct
holds 'a result stands without words' test -s t.vct
expect 2 '' nothing_heard "$volcomp" machine check missing

# --- names that are not UTF-8
odd=$'odd\xff'
expect 0 'runs_X.csv' "${import[@]}" --out "$odd" x.comp --json odd.json
holds 'import tells of any name' is_json odd.json
cp m.toml "$odd.toml"
expect 0 'good' "$volcomp" machine check "$odd.toml" --json odd.json
holds 'machine check tells of any name' is_json odd.json
cp before.csv "$odd.csv"
expect 0 'PASS' "$volcomp" verify "$odd.csv" after.csv --json odd.json --report odd_report
holds 'verify tells of any name' is_json odd.json
holds 'a report tells of any name' is_json odd_report/report.json

# --- what cannot be read is not taken for its end
expect 2 '/proc/self/mem: cannot be read' "$volcomp" machine check /proc/self/mem
expect 2 '/proc/self/mem: cannot be read' "$volcomp" export-tables --image /proc/self/mem --out controller --format isg

leftover=$(find . -name '*.tmp')
[ -z "$leftover" ] || { echo "FAILED: left behind: $leftover"; failed=1; }
exit "$failed"
