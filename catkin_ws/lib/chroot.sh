# Bare Debian systems in folders, for checks of packages and of other releases. Sourced by bash, never run.
#
#   reason=$(why_no_chroot) && { echo "skipped: $reason"; exit 0; }
#   make_chroot bookworm "$root"                        a minimal system of a suite, with an account `user`
#   apt_in_chroot "$root" install --no-install-recommends cmake
#   in_chroot "$root" dpkg --list                       a command as root
#   in_chroot --user user --bind "$PWD:/sources" "$root" bash -c 'cd /sources && make'
#   remove_chroot "$root"
#
# The minimal system and downloaded packages are kept in CHROOT_CACHE, so that a second folder costs no download. Mounts and
# processes of a command live in namespaces of its own: none is left when it ends, however it ends.

CHROOT_CACHE=${CHROOT_CACHE:-${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/endovascular_sim/chroot}
CHROOT_MIRROR=${CHROOT_MIRROR:-http://deb.debian.org/debian}
CHROOT_MIRROR_SECURITY=${CHROOT_MIRROR_SECURITY:-http://deb.debian.org/debian-security}

# Prints the reason why no chroot can be made here; fails if one can.
why_no_chroot() {
  if [ "$(id -u)" -ne 0 ]; then
    echo "a chroot needs root privileges"
  elif ! command -v debootstrap > /dev/null; then
    echo "debootstrap is not installed"
  elif ! unshare --mount --pid --fork mount -t tmpfs none /mnt 2> /dev/null; then
    echo "mounts are not permitted here"
  else
    return 1
  fi
}

chroot_tarball() { printf '%s/%s-%s.tar\n' "$CHROOT_CACHE" "$1" "$(dpkg --print-architecture)"; }

# make_chroot SUITE FOLDER: a minimal system of a suite (bookworm, trixie) in a new folder.
make_chroot() {
  local suite=$1 root=$2 tarball
  tarball=$(chroot_tarball "$suite")
  [ ! -e "$root" ] || { echo "error: $root exists already" >&2; return 1; }
  mkdir -p "$CHROOT_CACHE/$suite" "$root"
  (
    flock 8
    if [ ! -s "$tarball" ]; then
      local bare
      bare=$(mktemp -d "$CHROOT_CACHE/bare.XXXXXX")
      chmod 755 "$bare"
      debootstrap --variant=minbase "$suite" "$bare" "$CHROOT_MIRROR" > "$CHROOT_CACHE/$suite.log" 2>&1 ||
        { tail -n 5 "$CHROOT_CACHE/$suite.log" >&2; rm -rf "$bare"; exit 1; }
      rm -f "$bare"/var/cache/apt/archives/*.deb
      tar -C "$bare" -cf "$tarball.new" . && mv "$tarball.new" "$tarball"
      rm -rf "$bare"
    fi
  ) 8> "$CHROOT_CACHE/$suite.lock" || { rmdir "$root"; return 1; }
  tar -C "$root" -xpf "$tarball" || return 1
  printf 'deb %s\n' "$CHROOT_MIRROR $suite main" "$CHROOT_MIRROR $suite-updates main" \
    "$CHROOT_MIRROR_SECURITY $suite-security main" > "$root/etc/apt/sources.list"
  # `apt` removes what it has downloaded, unlike `apt-get`.
  echo 'Binary::apt::APT::Keep-Downloaded-Packages "true";' > "$root/etc/apt/apt.conf.d/90keep-downloads"
  # No service starts in a folder.
  printf '#!/bin/sh\nexit 101\n' > "$root/usr/sbin/policy-rc.d"
  chmod 755 "$root/usr/sbin/policy-rc.d"
  cp -L /etc/resolv.conf /etc/hosts "$root/etc/" 2> /dev/null || true
  in_chroot "$root" useradd --create-home --shell /bin/bash user || return 1
  apt_in_chroot "$root" update
}

# in_chroot [--user NAME] [--bind HOST:INSIDE]… FOLDER COMMAND…: runs a command in a clean environment, as root or as a user.
in_chroot() {
  local user=root binds=()
  while true; do
    case "$1" in
      --user) user=$2; shift 2 ;;
      --bind) binds+=("$2"); shift 2 ;;
      *) break ;;
    esac
  done
  local root=$1
  shift
  # The command has process and mount namespaces of its own.
  CHROOT_BINDS=$(printf '%s\n' "${binds[@]}") unshare --mount --pid --fork --kill-child bash -c '
    set -eu
    root=$1 user=$2
    shift 2
    mount --make-rprivate /
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sysfs "$root/sys"
    mount -t tmpfs -o mode=755 tmpfs "$root/dev"
    for device in null zero full random urandom tty; do
      : > "$root/dev/$device"
      mount --bind "/dev/$device" "$root/dev/$device"
    done
    mkdir -p "$root/dev/pts" "$root/dev/shm"
    mount -t devpts -o newinstance,ptmxmode=0666,mode=620 devpts "$root/dev/pts"
    mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
    ln -s pts/ptmx "$root/dev/ptmx"
    ln -s /proc/self/fd "$root/dev/fd"
    ln -s fd/0 "$root/dev/stdin"
    ln -s fd/1 "$root/dev/stdout"
    ln -s fd/2 "$root/dev/stderr"
    while IFS= read -r bind; do
      [ -n "$bind" ] || continue
      inside=$root/${bind#*:}
      if [ -d "${bind%%:*}" ]; then mkdir -p "$inside"; else mkdir -p "$(dirname "$inside")"; [ -e "$inside" ] || : > "$inside"; fi
      mount --bind "${bind%%:*}" "$inside"
    done <<< "$CHROOT_BINDS"
    # su gives a user the groups and the home folder; "$@" arrives as one quoted command.
    printf -v command "%q " "$@"
    home=/root
    [ "$user" = root ] || home=/home/$user
    exec env -i TERM=dumb LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME="$home" \
      chroot "$root" su "$user" -s /bin/bash -c "cd && exec $command"
  ' in_chroot "$root" "$user" "$@"
}

# apt_in_chroot FOLDER ARGUMENT…: apt-get with the downloads of earlier folders of this suite, one at a time.
apt_in_chroot() {
  local root=$1 suite
  shift
  suite=$(sed -n 's/^VERSION_CODENAME=//p' "$root/etc/os-release")
  mkdir -p "$CHROOT_CACHE/$suite"
  (
    flock 8
    in_chroot --bind "$CHROOT_CACHE/$suite:/var/cache/apt/archives" "$root" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y \
      -o Dpkg::Use-Pty=0 "$@"
  ) 8> "$CHROOT_CACHE/$suite.apt.lock"
}

# remove_chroot FOLDER: removes it, unless something is mounted in it.
remove_chroot() {
  if grep -q " $(readlink -f "$1")/" /proc/mounts; then
    echo "error: something is mounted in $1" >&2
    return 1
  fi
  rm -rf --one-file-system "$1"
}
