# Sourced after common.sh: a fresh Debian 12 in a temporary folder, forgotten at the end. Needs root and a network.
# shellcheck shell=bash

# make_root: fills $root.
make_root() {
  local log
  need debootstrap
  [ "$(id -u)" = 0 ] || die "making a fresh Debian needs root."
  root=$(mktemp -d /var/tmp/volcomp-root.XXXXXX)
  trap drop_root EXIT
  chmod 755 "$root"  # not every user in there is root
  log=$root.log
  debootstrap --variant=minbase bookworm "$root" "${VOLCOMP_MIRROR:-http://deb.debian.org/debian}" > "$log" 2>&1 ||
    { tail -n 5 "$log"; die "debootstrap could not make a fresh Debian."; }
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mount -t proc proc "$root/proc"
  mount -t devpts -o mode=620,gid=5 devpts "$root/dev/pts"  # terminals of its own
}

drop_root() {
  umount "$root/proc" "$root/dev/pts" 2> /dev/null || true
  rm -rf --one-file-system "$root" "$root.log"
}

# in_root COMMAND...
in_root() {
  chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
}

# copy_to_root FILE_OR_FOLDER...: below /source, at the same place as in the project.
copy_to_root() {
  mkdir -p "$root/source"
  cp -r --parents "$@" "$root/source"
}
