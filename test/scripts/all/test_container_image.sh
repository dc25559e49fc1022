#!/bin/bash
# The steps of the Containerfile, executed in a bare system of its release, give a system whose entry point runs a demonstration as
# the account of the image. No engine of containers is needed.
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
. "$(dirname "$0")/../packages_of_a_test.sh"
packages_for bookworm
root=$folder/image account=root place=/ variables=() entry='' default=''

copy() {
  local words target pattern
  read -ra words <<< "$1"
  target=${words[-1]}
  mkdir -p "$root$target"
  for pattern in "${words[@]::${#words[@]}-1}"; do
    compgen -G "$packages/$pattern" > /dev/null || { echo "COPY: no file $pattern"; exit 1; }
    # shellcheck disable=SC2086  # a pattern
    cp "$packages"/$pattern "$root$target"
  done
}

while IFS=$'\t' read -r instruction arguments <&4; do
  echo "$instruction $arguments"
  case "$instruction" in
    FROM)
      [ "$arguments" = docker.io/library/debian:12 ]
      make_chroot bookworm "$root"
      in_chroot "$root" userdel --remove user ;;  # not part of the image of Debian
    COPY) copy "$arguments" ;;
    RUN)
      in_chroot --bind "$CHROOT_CACHE/bookworm:/var/cache/apt/archives" "$root" sh -c "$arguments" > "$folder/step.log" 2>&1 ||
        { tail -n 30 "$folder/step.log"; exit 1; } ;;
    USER) account=$arguments ;;
    WORKDIR) place=$arguments ;;
    ENV) read -ra variables <<< "$arguments" ;;
    ENTRYPOINT) entry=$arguments ;;
    CMD) default=$arguments ;;
  esac
done 4< <(/usr/bin/python3 "$repository/test/scripts/containerfile.py" "$repository/packaging/container/Containerfile")
[ "$account" = user ] && [ "$entry" = endovascular_sim ] && [ "$default" = demo ]

in_image() { in_chroot --user "$account" --bind "$folder/results:/home/user/endovascular_sim" "$root" env -C "$place" "${variables[@]}" "$@"; }
mkdir "$folder/results"
chmod 1777 "$folder/results"
in_image id | grep uid=1000
in_image "$entry" --version
in_image "$entry" "$default" --headless --no-rviz --scene tube --seconds 1
ls "$folder"/results/tube-*/report.html
