# Sourced by tests, after folder_of_a_test.sh: `packages` is the folder of the packages for a suite of Debian.
# ENDOVASCULAR_PACKAGES names a folder with packages, which are not built then.
. "$repository/catkin_ws/lib/chroot.sh"
if reason=$(why_no_chroot); then
  echo "skipped: $reason"
  exit 77
fi

# packages_for SUITE: builds them on this system for its own suite, in a bare system for another one.
packages_for() {
  local suite=$1
  packages=${ENDOVASCULAR_PACKAGES:-$folder/packages}
  if [ -n "${ENDOVASCULAR_PACKAGES:-}" ]; then
    return
  elif grep -qx "VERSION_CODENAME=$suite" /etc/os-release; then
    "$repository/catkin_ws/package" --out "$packages"
    return
  fi
  local root="$folder/build_of_$suite"
  "$repository/catkin_ws/package" --prepare-only --build "$folder/$suite"
  make_chroot "$suite" "$root"
  mv "$folder/$suite" "$root/build"
  apt_in_chroot "$root" install --no-install-recommends build-essential
  apt_in_chroot "$root" build-dep --no-install-recommends /build/endovascular-sim
  in_chroot "$root" bash -c "cd /build/endovascular-sim && LC_ALL=C.UTF-8 DEB_BUILD_OPTIONS='parallel=$(nproc) noautodbgsym' dpkg-buildpackage -b -us -uc" \
    > "$folder/build_of_$suite.log" 2>&1 || { tail -n 40 "$folder/build_of_$suite.log"; exit 1; }
  mkdir -p "$packages"
  cp "$root"/build/*.deb "$packages/"
  remove_chroot "$root"
}
