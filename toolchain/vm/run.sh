# Sourced by toolchain/with-vcan: boots the test VM for one command.
# shellcheck shell=bash
#
# A folder of its own, shared with the guest, holds the command, its output and its exit code, so that
# several machines do not meet. Input and a terminal go through a device. The other side is toolchain/vm/init.
# shellcheck source=toolchain/vm/prepare.sh
. toolchain/vm/prepare.sh

# run_in_vm FOLDER COMMAND...: ends the script with the exit code of the command.
run_in_vm() {
  local limit_s attempt ended
  find_input
  limit_s=${VOLCOMP_VM_TIMEOUT:-$([ "$input" = terminal ] && echo 86400 || echo 600)}
  [[ $limit_s =~ ^[1-9][0-9]*$ ]] || die "VOLCOMP_VM_TIMEOUT must be a whole number of seconds, not \"$limit_s\"."
  run=$(mktemp -d "$PWD/$vm_folder/run-XXXXXX")
  trap end_run EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM HUP
  write_orders "$@"
  take_input

  for attempt in 1 2 3; do
    boot_machine "$limit_s" &
    machine=$!
    watch_machine &
    pass_on "$run/output" &
    [ ! -e "$run/errors" ] || pass_on "$run/errors" >&2 &
    ended=0
    wait "$machine" || ended=$?
    wait
    if [ -e "$run/up" ] || [ ! -e "$run/hung" ]; then break; fi
    rm "$run/hung"
    printf 'with-vcan: the virtual machine did not come up within %s s (%s of 3)\n' "$boot_limit_s" "$attempt" >&2
  done
  machine=
  finish "$ended" "$limit_s"
}

# An emulated machine now and then hangs before its command begins or after it has ended: the one is booted again, the
# other switched off.
readonly boot_limit_s=120 off_limit_s=60
watch_machine() {
  local left=$boot_limit_s
  while kill -0 "$machine" 2> /dev/null; do
    [ ! -e "$run/over" ] || [ -e "$run/off" ] || { : > "$run/off"; left=$off_limit_s; }
    if [ ! -e "$run/up" ] || [ -e "$run/over" ]; then
      left=$((left - 1))
      [ "$left" -gt 0 ] || { : > "$run/hung"; kill "$machine" 2> /dev/null || true; }
    fi
    sleep 1
  done
}

# find_input: "terminal" for a person who types and reads, "stream" for a pipe or file, "none" where nothing can be
# read: a closed input, or a terminal that is another's to read from or shows nothing of this.
find_input() {
  input=none
  if [ -t 0 ] && [ -t 1 ] && in_foreground; then
    input=terminal
  elif [ -e /proc/self/fd/0 ] && [ ! -t 0 ]; then
    input=stream
  fi
}

# The process group of this script is the one that the terminal listens to: fields 5 and 8 of proc(5).
in_foreground() {
  local stat
  read -r -a stat < "/proc/$$/stat"
  [ "${stat[4]}" = "${stat[7]}" ]
}

# Descriptors 3 and 4 are what the machine reads and writes as its standard streams.
take_input() {
  exec 3< /dev/null 4> "$run/machine"
  [ "$input" = none ] || exec 3<&0
  if [ "$input" = terminal ]; then
    exec 4>&1
    terminal_settings=$(stty -g)
  fi
}

# One file of output and errors, if they go to one place here: so their order is kept.
write_orders() {
  printf '%s\n' "$PWD" > "$run/project"
  printf '%s\n' "$input" > "$run/input"
  [ "$input" != terminal ] || stty size > "$run/size"
  guest_script "$@" > "$run/command"
  : > "$run/output"
  [ /dev/stdout -ef /dev/stderr ] || : > "$run/errors"
}

guest_script() {
  local folder=$1 name terminal=dumb
  shift
  [ "$input" != terminal ] || terminal=${TERM:-dumb}
  printf 'export PATH=%q HOME=/tmp LANG=C.UTF-8 TERM=%q\n' "/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin:$PATH" "$terminal"
  for name in "${!VOLCOMP_@}"; do
    printf 'export %s=%q\n' "$name" "${!name}"
  done
  printf 'cd %q 2> /dev/null || cd %q\n' "$folder" "$PWD"
  printf '%q ' "$@"
  printf '\n'
}

# QEMU splits its options at commas; a doubled one stands for itself.
share() {
  printf 'local,id=%s,path=%s,security_model=none,multidevs=remap%s' "$1" "${2//,/,,}" "${3:-}"
}

# Keys that mean something to a terminal, Ctrl+C above all, are the guest's.
input_device() {
  local device=virtserialport
  [ "$input" != none ] || return 0
  [ "$input" != terminal ] || device=virtconsole
  printf '%s\n' -chardev stdio,id=input,signal=off -device virtio-serial-pci -device "$device,chardev=input"
}

# Emulation, even where /dev/kvm exists: nested in another virtual machine it is not to be relied on. On a busy
# computer the kernel's check of its timer fails and would stop it.
boot_machine() {
  local image devices
  image=$(vm_image)
  mapfile -t devices < <(input_device)
  # In a process group of its own it could not read the terminal.
  exec timeout --foreground --kill-after=5 "$1" qemu-system-x86_64 \
    -nodefaults -no-user-config -no-reboot -display none -machine q35,hpet=off \
    -accel tcg,thread=multi -cpu max -smp 2 -m 1024 -serial "file:$run/console" \
    -kernel "$image/kernel" -initrd "$image/initramfs" \
    -append 'console=ttyS0 quiet panic=-1 mitigations=off nokaslr random.trust_cpu=on tsc=reliable no_timer_check' \
    -fsdev "$(share host / ,readonly=on)" -device virtio-9p-pci,fsdev=host,mount_tag=host \
    -fsdev "$(share project "$PWD")" -device virtio-9p-pci,fsdev=project,mount_tag=project \
    -fsdev "$(share run "$run")" -device virtio-9p-pci,fsdev=run,mount_tag=run \
    "${devices[@]}" <&3 >&4 2>> "$run/machine"
}

# Prints what the file gets until the machine has ended.
pass_on() {
  exec tail -q -c +1 -s 0.1 -f --pid="$machine" "$1"
}

# timeout(1) ends with 124 when it had to act, or 137 when it had to act twice.
finish() {
  [ ! -s "$run/status" ] || exit "$(cat "$run/status")"
  case $1 in
    124 | 137) die "the command did not end within $2 s and was stopped (VOLCOMP_VM_TIMEOUT sets the limit)." ;;
  esac
  cat "$run/machine" "$run/console" > "$vm_folder/last-failure.txt" 2> /dev/null || true
  die "the virtual machine gave no exit code of the command; its last words are in $vm_folder/last-failure.txt."
}

end_run() {
  trap '' INT TERM HUP
  if [ -n "${machine:-}" ]; then
    kill "$machine" 2> /dev/null || true
    wait
  fi
  # The terminal may be gone.
  [ -z "${terminal_settings:-}" ] || stty "$terminal_settings" 2> /dev/null || true
  rm -rf "$run"
}
