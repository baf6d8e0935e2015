# Sourced by toolchain/vm/run.sh: makes the kernel and the first file system of the test VM in build/vm.
# shellcheck shell=bash
#
# Debian's kernel package is downloaded and unpacked, never installed; that needs no root.

readonly vm_folder=build/vm
readonly vm_modules=(virtio_pci virtio_console 9pnet_virtio 9p vcan can-raw can-bcm slcan)

# vm_image: the folder with "kernel" and "initramfs"; its name changes with the files that make it.
vm_image() {
  local fingerprint
  fingerprint=$(cat toolchain/vm/prepare.sh toolchain/vm/init | sha256sum)
  printf '%s/image-%s\n' "$vm_folder" "${fingerprint:0:12}"
}

# prepare_vm: returns at once if the image is there; waits if another process is making it.
prepare_vm() {
  local image
  image=$(vm_image)
  need qemu-system-x86_64
  [ -d "$image" ] && return
  [ "$(uname -m)" = x86_64 ] || die "the virtual machine is made for x86_64 only."
  need apt-get dpkg-deb flock busybox cpio modprobe depmod xz
  mkdir -p "$vm_folder"
  (
    flock 9
    [ -d "$image" ] || make_image "$image"
  ) 9> "$vm_folder/lock"
}

make_image() {
  local work=$vm_folder/new
  printf 'with-vcan: preparing the virtual machine in %s\n' "$vm_folder" >&2
  rm -rf "$work"
  mkdir -p "$work/package" "$work/image"
  fetch_kernel_package "$work"
  dpkg-deb -x "$vm_folder/linux-image.deb" "$work/package" || die "the kernel package cannot be unpacked."
  uncompress_kernel "$work/package/boot"/vmlinuz-* "$work/image/kernel"
  make_initramfs "$work/package" "$work/image/initramfs"
  rm -rf "$vm_folder"/image-*
  mv "$work/image" "$1"
  rm -rf "$work"
}

# The package is kept, so that a change of our own files needs no network.
fetch_kernel_package() {
  local name
  [ -f "$vm_folder/linux-image.deb" ] && return
  name=$(apt-cache depends linux-image-amd64 2> /dev/null |
    awk '/Depends: linux-image-[0-9]/ { name = $2 } END { print name }') || true
  [ -n "$name" ] || die "apt knows no Debian kernel package (is this Debian? run apt-get update)."
  (cd "$1" && apt-get download "$name" > download.log 2>&1) ||
    die "the package $name could not be downloaded (no network, or apt-get update is due): see $1/download.log."
  mv "$1/$name"_*.deb "$vm_folder/linux-image.deb"
}

# An uncompressed kernel is started by QEMU without a boot loader (PVH, an ELF note of the kernel),
# which halves the time to boot. In a vmlinuz it is one xz stream behind the code that unpacks it.
uncompress_kernel() {
  local start
  start=$(LC_ALL=C grep -abo -m 1 -P '\xfd7zXZ\x00' "$1" | awk -F : 'NR == 1 { print $1 }') || true
  [ -n "$start" ] || die "the kernel package holds no kernel compressed with xz."
  xz -dc --single-stream < <(tail -c "+$((start + 1))" "$1") > "$2" || die "the kernel could not be uncompressed."
}

# make_initramfs PACKAGE FILE: busybox, the modules in the order of their dependencies, and our init.
make_initramfs() {
  local package=$1 root version module
  root=$(mktemp -d "$package/initramfs-XXXXXX")
  version=$(basename "$package"/lib/modules/*)
  mkdir "$root"/{bin,modules,proc,sys,dev,root}
  cp "$(command -v busybox)" "$root/bin/busybox"
  cp toolchain/vm/init "$root/init"
  chmod 755 "$root/init"
  depmod -b "$package" "$version"
  for module in "${vm_modules[@]}"; do
    modprobe -d "$package" -S "$version" --ignore-install --show-depends "$module" ||
      die "the kernel package has no module $module."
  done | awk 'sub(/^insmod /, "") && sub(/ *$/, "") && !seen[$0]++' |
    while IFS= read -r module; do
      cp "$module" "$root/modules/"
      basename "$module" >> "$root/modules/order"
    done
  (cd "$root" && find . | cpio --quiet -o -H newc) | gzip > "$2"
}
