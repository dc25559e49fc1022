# Sources and Debian packages of the last commit. Sourced by `package` and `release`, after workspace.sh.

# Version of the last commit: that of CMakeLists.txt at its tag, else one before it that grows with the commits. `release` sets
# package_version.
package_version=''
version_of_project() { git -C "$repository" show HEAD:CMakeLists.txt | sed -n 's/^project(endovascular_sim VERSION \([0-9.]*\).*/\1/p'; }
version_of_package() {
  local version
  version=$(version_of_project)
  if [ -n "$package_version" ]; then
    printf '%s\n' "$package_version"
  elif [ -n "$(git -C "$repository" tag --points-at HEAD --list "v$version")" ]; then
    printf '%s\n' "$version"
  else
    printf '%s~%s.%s\n' "$version" "$(TZ=UTC0 git -C "$repository" log -1 --date=format-local:%Y%m%d%H%M%S --format=%cd)" \
      "$(git -C "$repository" rev-parse HEAD | cut -c 1-12)"
  fi
}

# packages_marked MARK: packages of packages.txt with a mark, separated by commas.
packages_marked() {
  sed -n -E 's/^([a-z0-9.+-]+)[[:space:]]*#(.*)$/\1 \2 /p' "$1/catkin_ws/packages.txt" |
    awk -v mark="$2" '{ for (i = 2; i <= NF; ++i) if ($i == mark) print $1 }' | paste -sd, | sed 's/,/, /g'
}

# write_sources FOLDER: the files of the last commit, with packaging/debian as `debian`, completed by dependencies and the changelog.
write_sources() {
  local folder=$1 debian="$1/debian" mark all
  mkdir -p "$folder"
  git -C "$repository" archive HEAD | tar -C "$folder" -x
  cp -r "$folder/packaging/debian" "$debian"
  all=$(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$folder/catkin_ws/packages.txt" "$folder/catkin_ws/packages-package.txt" |
    grep -vxE 'debhelper|build-essential|dpkg-dev|lintian' | LC_ALL=C sort -u | paste -sd, | sed 's/,/, /g')
  sed -i "s/@build@/debhelper-compat (= 13), $all/" "$debian/control"
  for mark in run run-rviz run-dev run-messages; do sed -i "s/@$mark@/$(packages_marked "$folder" "$mark")/" "$debian/control"; done
  ! grep -n '@' "$debian/control" | grep -v '<.*@.*>' || die "packaging/debian/control: a mark of packages.txt has no package"
  write_copyright "$folder"
  cat > "$debian/changelog" <<CHANGELOG
endovascular-sim ($(version_of_package)) unstable; urgency=medium

  * Commit $(git -C "$repository" rev-parse HEAD | cut -c 1-12); changes are listed in CHANGELOG.md.

 -- $(sed -n 's/^Maintainer: //p' "$debian/control")  $(git -C "$repository" log -1 --format=%cD)
CHANGELOG
}

# The texts of the licences, from the files of the repository.
write_copyright() {
  local folder=$1 file="$1/debian/copyright"
  sed -i "s/@crtk@/$(sed -n 's/^Copyright (c) //p' "$folder/catkin_ws/src/crtk_msgs/LICENSE")/" "$file"
  licence() {
    printf 'License: %s\n' "$1"
    sed -e '1,/^Copyright/d' -e '/^All rights reserved/d' "$2" | sed -e '1{/^$/d}' -e 's/^$/./' -e 's/^/ /'
    echo
  }
  { licence BSD-3-Clause "$folder/LICENSE"; licence Expat "$folder/catkin_ws/src/crtk_msgs/LICENSE"; } | sed -e '/^License/{n;/^ \.$/d}' >> "$file"
}

# build_packages SOURCES: packages beside the folder of the sources.
build_packages() {
  local sources=$1 jobs
  jobs=$(build_jobs)
  say "Building packages of version $(dpkg-parsechangelog -l "$sources/debian/changelog" -S Version) with $jobs job(s); log: $sources.log"
  (
    cd "$sources"
    export LC_ALL=C.UTF-8 DEB_BUILD_OPTIONS="parallel=$jobs noautodbgsym"
    umask 022
    dpkg-buildpackage -b -us -uc
  ) > "$sources.log" 2>&1 || { tail -n 40 "$sources.log" >&2; die "the build failed; the whole log is $sources.log"; }
}

# check_packages FOLDER: lintian finds nothing in the packages of a folder.
check_packages() {
  local found
  say "Checking the packages with lintian"
  found=$(lintian --allow-root --fail-on error,warning --suppress-tags bad-distribution-in-changes-file "$1"/*.changes 2>&1) ||
    { printf '%s\n' "$found" >&2; die "lintian refuses the packages"; }
}
