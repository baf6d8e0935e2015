#!/usr/bin/env bash
# Completion in bash, zsh and fish, the manual pages and the exit codes: each asked of the shell or tool that reads it.
#
#   cli_shell_test.sh VOLCOMP VOLCOMP_NODE SOURCE_FOLDER
# shellcheck source=tests/system/cli_common.sh
. "$(dirname "$0")/cli_common.sh"
volcomp=$(realpath "$1")
node=$(realpath "$2")
source_dir=$(realpath "$3")
export PATH="${volcomp%/*}:$PATH"

for tool in zsh fish man mandoc; do
  command -v "$tool" >/dev/null || { echo "FAILED: $tool is not installed (toolchain/setup.sh)"; exit 1; }
done
for shell in bash zsh fish; do
  "$volcomp" completion "$shell" >"$work/volcomp.$shell" || failed=1
done
expect 2 'SHELL' "$volcomp" completion tcsh
touch "$work/machine.toml" "$work/machine.csv"
cd "$work" || exit 1

# complete_bash LINE: what Tab offers at the end of the line, without the names of files.
complete_bash() {
  bash --norc -c '
    set -u
    source "$1/volcomp.bash"
    COMP_LINE=$2 COMP_POINT=${#2}
    read -ra COMP_WORDS <<<"$2"
    [[ $2 == *" " ]] && COMP_WORDS+=("")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    compopt() { :; }
    _volcomp
    printf "%s\n" "${COMPREPLY[@]}"' bash "$work" "$1"
}

# shellcheck disable=SC2317  # called by offers
complete_fish() {
  fish --no-config -c "source $work/volcomp.fish; complete -C '$1'" | cut -f 1
}

# A terminal, since zsh completes nowhere else; what it lists for Tab is between two marks.
# shellcheck disable=SC2317
complete_zsh() {
  /usr/bin/python3 - "$work" "$1" <<'PYTHON'
import os, pty, re, select, sys, time
work, line = sys.argv[1:]
pid, terminal = pty.fork()
if pid == 0:
    os.execvpe("zsh", ["zsh", "-f", "-i"], {**os.environ, "TERM": "dumb", "HOME": work, "PS1": "", "COLUMNS": "400", "LINES": "200"})
def until(mark, limit=60):
    text, end = "", time.time() + limit
    while mark not in text and time.time() < end:
        if select.select([terminal], [], [], 0.1)[0]:
            text += os.read(terminal, 65536).decode("utf-8", "replace")
    return text
def say(text):
    os.write(terminal, text.encode())
say("stty cols 400 rows 200; PS1=; unsetopt zle_bracketed_paste; LISTMAX=1000; autoload -Uz compinit && compinit -D -u; "
    f"source {work}/volcomp.zsh; zstyle ':completion:*' list-separator '--'; "
    # Offered words, told by the function that adds them.
    "compadd() { local -a found; builtin compadd -O found \"$@\"; print -rl -- $found >>offered; builtin compadd \"$@\" }; "
    "echo re''ady\n")
until("ready")
say(line + "\t")
time.sleep(0.3)
say("\x15echo do''ne\n")
until("done")
say("exit\n")
time.sleep(0.1)
os.kill(pid, 9)
os.waitpid(pid, 0)
if os.path.exists("offered"):
    print(open("offered").read())
    os.remove("offered")
PYTHON
}

# offers SHELL LINE WORD…: all of these words are offered.
offers() {
  local shell=$1 line=$2 offered word
  shift 2
  offered=$("complete_$shell" "$line")
  for word in "$@"; do
    grep -qxF -- "$word" <<<"$offered" ||
      { printf 'FAILED: %s offers for "%s":\n%s\n  without %s\n' "$shell" "$line" "$offered" "$word"; failed=1; }
  done
}

# not_offered SHELL LINE WORD
not_offered() {
  ! grep -qxF -- "$3" <<<"$("complete_$1" "$2")" || { echo "FAILED: $1 offers $3 for \"$2\""; failed=1; }
}

zsh -n "$work/volcomp.zsh" || { echo 'FAILED: zsh does not understand its script'; failed=1; }
fish --no-execute "$work/volcomp.fish" || { echo 'FAILED: fish does not understand its script'; failed=1; }
for shell in bash fish zsh; do
  offers "$shell" 'volcomp ' run build-tables download verify monitor completion man
  offers "$shell" 'volcomp ver' verify
  offers "$shell" 'volcomp run ' xyfz l300g
  offers "$shell" 'volcomp run xyfz --vol' --volume-points
  offers "$shell" 'volcomp build-tables --slope ' lsq end
  offers "$shell" 'volcomp run l300g --path ' fixed-a generate
  offers "$shell" 'volcomp completion ' bash zsh fish
  offers "$shell" 'volcomp machine check --js' --json
  offers "$shell" 'volcomp run l300g --path=' --path=fixed-a --path=generate
  [ -z "$("complete_$shell" 'volcomp run xyfz --draws ')" ] || { echo "FAILED: $shell offers words or files for a number"; failed=1; }
  not_offered "$shell" 'volcomp verify --' --can
  not_offered "$shell" 'volcomp run ' build-tables
done
# Where a file belongs, bash falls back to the names of files: nothing else is offered.
[ -z "$(complete_bash 'volcomp build-tables --machine ')" ] || { echo 'FAILED: bash offers words for a file'; failed=1; }
grep -q '^complete -o default -F _volcomp volcomp$' "$work/volcomp.bash" || { echo 'FAILED: bash does not complete files'; failed=1; }
offers fish 'volcomp build-tables --machine ' machine.toml
offers zsh 'volcomp build-tables --machine ' machine.toml

# fish shows what each is for, and the program is found as it was typed.
fish --no-config -c "source $work/volcomp.fish; complete -C 'volcomp run xyf'" | grep -q $'^xyfz\tThree-axis machine' ||
  { echo 'FAILED: fish shows no descriptions'; failed=1; }
(PATH=/usr/bin:/bin && offers bash "$volcomp run " xyfz l300g && offers fish "$volcomp run " xyfz l300g && exit "$failed") || failed=1

# Every command and every option that the help knows.
options_of() { grep -oE '(^| |,)--[a-z][A-Za-z0-9-]+' <<<"$1" | grep -oE -- '--[A-Za-z0-9-]+' | sort -u; }
for command in 'run xyfz' build-tables verify monitor 'simulate diagonals' download compare; do
  # shellcheck disable=SC2086  # a command in one word
  mapfile -t options < <(options_of "$(sed -n '/^Options/,$p' <<<"$("$volcomp" $command --help)" | grep -E '^  -')")
  [ "${#options[@]}" -gt 2 ] || { echo "FAILED: no options in the help of $command"; failed=1; }
  offers bash "volcomp $command --" "${options[@]}"
done

# --- manual pages: no warning of either formatter, and nothing missing
"$volcomp" man >"$work/volcomp.1" || failed=1
for page in "$work/volcomp.1" "$source_dir/firmware/posix/volcomp-node.1"; do
  warnings=$(LC_ALL=C.UTF-8 MANROFFSEQ='' man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null)
  [ -z "$warnings" ] || { printf 'FAILED: groff about %s:\n%s\n' "$page" "$warnings"; failed=1; }
  # Pages without a date are the same whenever they are built.
  warnings=$(mandoc -T lint -W warning "$page" | grep -v 'missing date')
  [ -z "$warnings" ] || { printf 'FAILED: mandoc about %s:\n%s\n' "$page" "$warnings"; failed=1; }
done
shown=$(MANWIDTH=200 man -E UTF-8 -l "$work/volcomp.1" | col -b)
for text in '--misalignment-mm' 'volcomp run xyfz' 'EXIT STATUS' 'volcomp download m.vct --can can0 --store' 'lsq|end'; do
  grep -qF -- "$text" <<<"$shown" || { echo "FAILED: the manual page lacks $text"; failed=1; }
done
shown=$(MANWIDTH=200 man -E UTF-8 -l "$source_dir/firmware/posix/volcomp-node.1" | col -b)
mapfile -t options < <(options_of "$("$node" --help)")
[ "${#options[@]}" -gt 3 ] || { echo "FAILED: no options in the help of volcomp-node"; failed=1; }
for option in "${options[@]}"; do
  grep -qF -- "$option" <<<"$shown" || { echo "FAILED: volcomp-node(1) lacks $option"; failed=1; }
done

# --- exit codes: the help, the manual page and docs/command-line.md say the same, and every code occurs
for code in 0 1 2; do
  meaning=$(sed -n "s/^  $code  //p" <<<"$("$volcomp" --help)")
  [ -n "$meaning" ] || { echo "FAILED: the help does not explain exit code $code"; failed=1; }
  grep -qxF "| $code | $meaning |" "$source_dir/docs/command-line.md" || { echo "FAILED: docs/command-line.md about exit code $code"; failed=1; }
  sed 's/[\]//g' "$work/volcomp.1" | grep -qF "$meaning" || { echo "FAILED: the manual page about exit code $code"; failed=1; }
done
expect 0 'good' "$volcomp" machine check "$source_dir/host_sim/machines/xyfz.toml"
printf 'diagonal,target [mm],run,direction,deviation [um]\nPPP,0,1,up,0\nPPP,100,1,up,9\n' >"$work/before.csv"
expect 1 'FAIL' "$volcomp" verify "$work/before.csv" "$work/before.csv"
expect 2 'cannot be opened' "$volcomp" verify "$work/before.csv" "$work/none.csv"
expect 2 'only one file can come from standard input' "$volcomp" verify - - <"$work/before.csv"
expect 2 'only one result' "$volcomp" verify "$work/before.csv" "$work/before.csv" --csv - --json -

# --- machine files and images through pipes; a full disk is noticed
expect 0 'good' "$volcomp" machine check - <"$source_dir/host_sim/machines/xyfz.toml"
expect 2 'standard input:1: not valid TOML' "$volcomp" machine check - <<<'name ='
expect 2 'no such machine file' "$volcomp" machine example nothing
expect 2 'not the name of a machine' "$volcomp" machine example ../machines/xyfz
while read -r file; do
  [ -s "$file" ] || { echo "FAILED: volcomp list names $file, which is not there"; failed=1; }
done < <("$volcomp" list --json - 2>/dev/null | /usr/bin/python3 -c 'import json, sys
for machine in json.load(sys.stdin)["machines"]: print(machine["file"])')
"$volcomp" machine example xyfz | cmp - "$source_dir/host_sim/machines/xyfz.toml" || { echo 'FAILED: machine example'; failed=1; }
"$volcomp" simulate runs --out "$work/runs" >/dev/null || failed=1
build=("$volcomp" build-tables --machine "$source_dir/host_sim/machines/xyfz.toml" --runs "$work"/runs/*.csv)
"${build[@]}" --out - 2>"$work/words.txt" >"$work/piped.vct"
"${build[@]}" --out "$work/file.vct" --json "$work/file.json" >"$work/said.txt"
# The time it was built is in it.
[ "$(wc -c <"$work/piped.vct")" -eq "$(wc -c <"$work/file.vct")" ] || { echo 'FAILED: another image in the pipe'; failed=1; }
grep -q 'CRC-32' "$work/words.txt" || { echo 'FAILED: no words on standard error'; failed=1; }
crc=$(sed -n 's/.*"crc32": "\([0-9A-F]*\)".*/\1/p' "$work/file.json")
grep -q "CRC-32 $crc\$" "$work/said.txt" || { echo 'FAILED: JSON and words name different CRCs'; failed=1; }
/usr/bin/python3 - "$work/file.json" "$work/file.vct" <<'PYTHON' || failed=1
import json, sys, zlib
figures, image = json.load(open(sys.argv[1])), open(sys.argv[2], "rb").read()
assert figures["bytes"] == len(image) and figures["crc32"] == f"{zlib.crc32(image[:-4]):08X}", figures
assert [axis["axis"] for axis in figures["axes"]] == ["X", "Y", "Z"], figures
assert all(axis["unit"] == "um" and axis["iso230_2"]["A"] >= axis["iso230_2"]["E"] for axis in figures["axes"]), figures
PYTHON
"${build[@]}" --out - 2>/dev/null >/dev/full && { echo 'FAILED: a full disk was not noticed'; failed=1; }
head -c 1000000 /dev/zero >"$work/large.vct"
expect 2 'is larger' "$volcomp" download - --can no-such-can0 <"$work/large.vct"
exit "$failed"
