# Shared by `demo` and `test`: what this machine needs, and the build. Sourced by bash, never run.
#
# The caller sets `workspace` (this catkin workspace) and `repository` (the package's root) first.

build_log="$workspace/build/build.log"
packages_file="$workspace/packages.txt"
install_stamp="$workspace/.setup-done"

say() { printf '%s\n' "== $*"; }
note() { printf '%s\n' "   $*"; }
warn() { printf '%s\n' "warning: $*" >&2; }
die() { printf '%s\n' "error: $*" >&2; exit 1; }

# A path that CMake, make or catkin's generated scripts take apart is refused before anything is done.
check_path() {
  local path=$1 bad
  # Letters of other alphabets do no harm.
  bad=$(printf '%s' "$path" | LC_ALL=C tr -d 'A-Za-z0-9_./+@~,=\200-\377-')
  [ -z "$bad" ] && return
  bad=${bad:0:1}
  if [ "$bad" = ' ' ]; then bad='a space'; else bad="the character '$bad'"; fi
  printf '%s\n' \
    "error: the path of this repository holds $bad, and catkin cannot build or test there:" \
    "         $path" \
    "       Use a path of letters, digits and . _ - + @ ~ , = only, for example:" \
    "         mv '$path' \"\$HOME/endovascular_sim\"" >&2
  exit 2
}

# Only Debian's own tools: another python3, cmake or ROS in front of them (pyenv, conda, /opt/ros) breaks catkin,
# and other compiler flags would break bit-exact replay.
clean_environment() {
  export PATH=/usr/bin:/bin:/usr/sbin:/sbin
  unset ROS_PACKAGE_PATH ROS_ROOT ROS_ETC_DIR ROS_DISTRO ROS_VERSION ROS_PYTHON_VERSION ROS_IP ROS_MASTER_URI \
    ROS_NAMESPACE ROSLISP_PACKAGE_DIRECTORIES CMAKE_PREFIX_PATH PYTHONPATH PYTHONHOME VIRTUAL_ENV PKG_CONFIG_PATH \
    LD_LIBRARY_PATH CC CXX CPPFLAGS CFLAGS CXXFLAGS LDFLAGS CATKIN_SHELL MAKEFLAGS
  export ROS_HOSTNAME=localhost LC_NUMERIC=C
}

wanted_packages() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$packages_file"; }

# Names of the listed packages that dpkg does not have, one per line.
missing_packages() {
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' 2>/dev/null | sed -n 's/^installed //p' | sort -u)
  comm -23 <(wanted_packages | sort -u) <(printf '%s\n' "$installed")
}

install_packages() {
  local list_hash system
  list_hash=$(sha256sum < "$packages_file" | cut -d' ' -f1)
  # dpkg's status file changes with every installation and removal: the stamp holds for the pair.
  system=$(stat -c %Y /var/lib/dpkg/status 2>/dev/null || echo none)
  if [ -f "$install_stamp" ] && [ "$(cat "$install_stamp")" = "$list_hash $system" ]; then
    return
  fi
  command -v dpkg-query >/dev/null || die "dpkg-query is not here: this package is for Debian 12, which has ROS 1 in its archive."

  local missing
  mapfile -t missing < <(missing_packages)
  if [ ${#missing[@]} -gt 0 ]; then
    local id='' version=''
    [ -r /etc/os-release ] && { id=$(. /etc/os-release; echo "${ID:-}"); version=$(. /etc/os-release; echo "${VERSION_ID:-}"); }
    if [ "$id" != debian ] || [ "$version" != 12 ]; then
      die "this is ${id:-an unknown system} ${version:-}, and ${#missing[@]} of the packages of $packages_file are missing.
       They are installed from the archive of Debian 12 (bookworm), the release whose ROS 1 this package is built on.
       Run this on Debian 12, or in a container of it (image debian:12)."
    fi
    local become=() install=(apt-get install -y --no-install-recommends "${missing[@]}")
    if [ "$(id -u)" -ne 0 ]; then
      if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
        become=(sudo)
      else
        printf '%s\n' "error: ${#missing[@]} Debian packages are missing, and installing them needs root, which is not to be had here" \
          "       (no sudo, or it asks for a password and there is no terminal). As root, run:" "" \
          "  apt-get update && ${install[*]}" "" "       then start this again." >&2
        exit 3
      fi
    fi
    say "Installing ${#missing[@]} missing Debian packages (listed in catkin_ws/packages.txt) with apt-get${become:+ through sudo}:"
    note "${missing[*]}"
    "${become[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update ||
      die "apt-get update failed (see above): check the network and /etc/apt/sources.list."
    "${become[@]}" env DEBIAN_FRONTEND=noninteractive "${install[@]}" ||
      die "apt-get install failed (see above)."
    mapfile -t missing < <(missing_packages)
    [ ${#missing[@]} -eq 0 ] || die "still missing after apt-get install: ${missing[*]}"
    system=$(stat -c %Y /var/lib/dpkg/status 2>/dev/null || echo none)
  fi
  printf '%s\n' "$list_hash $system" > "$install_stamp"
}

# Compilers running at once: as many as processors, but 1.5 GB of free memory each.
build_jobs() {
  local processors memory
  processors=$(nproc)
  memory=$(awk '/^MemAvailable:/ { print int($2 / 1572864) }' /proc/meminfo)
  [ "${memory:-1}" -lt 1 ] && memory=1
  [ "$processors" -lt "$memory" ] && echo "$processors" || echo "$memory"
}

# One hash over name, time and size of everything that the given target is made of.
source_hash() {
  local folders=(src msg srv)
  [ "$1" = tests ] && folders+=(test)
  {
    printf '%s\n' "$repository"
    cd "$repository"
    find CMakeLists.txt package.xml "${folders[@]}" -type f ! -name '*.pyc' -printf '%p %T@ %s\n' 2>/dev/null | sort
  } | sha256sum | cut -d' ' -f1
}

# catkin_make with its steps on the terminal and everything in the log.
run_catkin_make() {
  local status
  set +e
  (cd "$workspace" && exec catkin_make -C "$workspace" -DCMAKE_BUILD_TYPE=Release -DPYTHON_EXECUTABLE=/usr/bin/python3 \
    -DPython3_EXECUTABLE=/usr/bin/python3 "$@") 2>&1 | tee -a "$build_log" |
    grep --line-buffered -E '^\[ *[0-9]+%\] (Building|Linking|Generating)|error|Error|warning:|CMake Warning'
  status=${PIPESTATUS[0]}
  set -e
  return "$status"
}

# build all|tests: brings the target up to date; silent and quick when nothing changed.
build() {
  local target=$1 stamp="$workspace/build/.$1-built" hash
  hash=$(source_hash "$target")
  if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$hash" ] && [ -f "$workspace/devel/setup.bash" ]; then
    return
  fi
  # A build tree remembers its absolute path; after a move it is worthless.
  local cache="$workspace/build/CMakeCache.txt"
  if [ -f "$cache" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$workspace/src" "$cache"; then
    note "the repository has moved: building from scratch"
    rm -rf "$workspace/build" "$workspace/devel"
  fi
  mkdir -p "$workspace/build"
  # catkin expects its own top-level file beside the packages.
  ln -sfn /usr/share/catkin/cmake/toplevel.cmake "$workspace/src/CMakeLists.txt"

  local jobs
  jobs=$(build_jobs)
  say "Building $([ "$target" = tests ] && echo 'the tests' || echo 'the workspace') in Release with $jobs job(s); log: $build_log"
  : > "$build_log"
  rm -f "$stamp"
  local goal=()
  [ "$target" = tests ] && goal=(tests)
  if ! run_catkin_make -j"$jobs" "${goal[@]}"; then
    tail -n 40 "$build_log" >&2
    die "the build failed; the whole log is $build_log"
  fi
  printf '%s\n' "$hash" > "$stamp"
}

# setup_workspace [tests]: from a bare machine to a built workspace. One at a time: two builds in one tree collide.
setup_workspace() {
  local target
  check_path "$repository"
  clean_environment
  exec 9< "$packages_file"
  if ! flock -n 9; then
    note "waiting for another set-up in this workspace to end"
    flock 9
  fi
  install_packages
  build all
  for target in "$@"; do build "$target"; done
  exec 9>&-
  set +u
  . "$workspace/devel/setup.bash"
  set -u
}
