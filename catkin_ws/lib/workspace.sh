# Shared by `demo` and `test`: installation of Debian packages, and the build. Sourced by bash, never run.
#
# The caller sets `workspace` (this catkin workspace) and `repository` (the package's root) first.

build_log="$workspace/build/build.log"

# shellcheck source=messages.sh
. "$workspace/lib/messages.sh"

# Refuses a path that CMake, make or catkin's generated scripts would split, before anything else happens.
check_path() {
  local path=$1 bad
  # Letters of other alphabets work.
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

# Only Debian's own tools: another python3, cmake or ROS earlier in PATH (pyenv, conda, /opt/ros) breaks catkin, and other
# compiler flags would break bit-exact replay.
clean_environment() {
  export PATH=/usr/bin:/bin:/usr/sbin:/sbin
  unset ROS_PACKAGE_PATH ROS_ROOT ROS_ETC_DIR ROS_DISTRO ROS_VERSION ROS_PYTHON_VERSION ROS_IP ROS_MASTER_URI \
    ROS_NAMESPACE ROSLISP_PACKAGE_DIRECTORIES CMAKE_PREFIX_PATH PYTHONPATH PYTHONHOME VIRTUAL_ENV PKG_CONFIG_PATH \
    LD_LIBRARY_PATH CC CXX CPPFLAGS CFLAGS CXXFLAGS LDFLAGS CATKIN_SHELL MAKEFLAGS
  export ROS_HOSTNAME=localhost LC_NUMERIC=C
}

# wanted_packages LIST: the names in a list, one per line.
wanted_packages() { sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$workspace/$1"; }

# missing_packages LIST: the listed packages that are not installed, one per line.
missing_packages() {
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' 2>/dev/null | sed -n 's/^installed //p' | sort -u)
  comm -23 <(wanted_packages "$1" | sort -u) <(printf '%s\n' "$installed")
}

# install_packages LIST: installs the listed packages that are missing.
install_packages() {
  local list=$1 list_hash system stamp
  stamp="$workspace/.installed-${list%.txt}"
  list_hash=$(sha256sum < "$workspace/$list" | cut -d' ' -f1)
  # dpkg's status file changes with every installation and removal: the stamp is valid for the pair.
  system=$(stat -c %Y /var/lib/dpkg/status 2>/dev/null || echo none)
  if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$list_hash $system" ]; then
    return
  fi
  command -v dpkg-query >/dev/null || die "dpkg-query is missing: this package is for Debian 12 and 13, whose archives hold ROS 1."

  local missing
  mapfile -t missing < <(missing_packages "$list")
  if [ ${#missing[@]} -gt 0 ]; then
    local id='' version=''
    [ -r /etc/os-release ] && { id=$(. /etc/os-release; echo "${ID:-}"); version=$(. /etc/os-release; echo "${VERSION_ID:-}"); }
    case "$id $version" in
      'debian 12'|'debian 13') ;;
      *)
        die "this is ${id:-an unknown system} ${version:-}, and ${#missing[@]} of the packages of catkin_ws/$list are missing.
       They are installed from the archive of Debian 12 (bookworm) or 13 (trixie), which hold ROS 1.
       Run this on one of them, or in a container (image debian:12, or debian:13)." ;;
    esac
    local become=() install=(apt-get install -y --no-install-recommends "${missing[@]}")
    if [ "$(id -u)" -ne 0 ]; then
      if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
        become=(sudo)
      else
        printf '%s\n' "error: ${#missing[@]} Debian packages are missing. Their installation requires root privileges, which are not" \
          "       available (no sudo, or it needs a password and there is no terminal). As root, run:" "" \
          "  apt-get update && ${install[*]}" "" "       then start this command again." >&2
        exit 3
      fi
    fi
    say "Installing ${#missing[@]} missing Debian packages (listed in catkin_ws/$list) with apt-get${become:+ through sudo}:"
    note "${missing[*]}"
    "${become[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update ||
      die "apt-get update failed (see above): check the network and /etc/apt/sources.list."
    "${become[@]}" env DEBIAN_FRONTEND=noninteractive "${install[@]}" ||
      die "apt-get install failed (see above)."
    mapfile -t missing < <(missing_packages "$list")
    [ ${#missing[@]} -eq 0 ] || die "still missing after apt-get install: ${missing[*]}"
    system=$(stat -c %Y /var/lib/dpkg/status 2>/dev/null || echo none)
  fi
  printf '%s\n' "$list_hash $system" > "$stamp"
}

# Number of compilers at once: one per processor, with at least 1.5 GB of free memory each.
build_jobs() {
  local processors memory
  processors=$(nproc)
  memory=$(awk '/^MemAvailable:/ { print int($2 / 1572864) }' /proc/meminfo)
  [ "${memory:-1}" -lt 1 ] && memory=1
  [ "$processors" -lt "$memory" ] && echo "$processors" || echo "$memory"
}

# source_hash all|tests: one hash over path, time and size of every file that the target is built from.
source_hash() {
  local folders=(src msg srv cmake python catkin_ws/src/crtk_msgs)
  [ "$1" = tests ] && folders+=(test)
  {
    printf '%s\n' "$repository" "$(build_options)"
    cd "$repository"
    find CMakeLists.txt package.xml "${folders[@]}" -type f ! -name '*.pyc' -printf '%p %T@ %s\n' 2>/dev/null | sort
  } | sha256sum | cut -d' ' -f1
}

# CMake options of this run. Warnings are errors in continuous integration only (CI=true). Tests are configured where the
# packages that they need are installed, volume_import where ITK is: CMake searches again after its installation.
build_options() {
  local werror=OFF testing=OFF itk=OFF
  [ "${CI:-}" = true ] && werror=ON
  [ -z "$(missing_packages packages-test.txt)" ] && testing=ON
  [ "$(dpkg-query -W -f='${db:Status-Status}' libinsighttoolkit5-dev 2>/dev/null)" = installed ] && itk=ON
  printf '%s\n' "-DENDOVASCULAR_WERROR=$werror" "-DENDOVASCULAR_ITK=$itk" "-DCATKIN_ENABLE_TESTING=$testing"
}

# run_catkin_make ARGUMENT…: catkin_make with its steps on the terminal and everything in the log.
run_catkin_make() {
  local status options
  mapfile -t options < <(build_options)
  set +e
  (cd "$workspace" && exec catkin_make -C "$workspace" -DCMAKE_BUILD_TYPE=Release -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 "${options[@]}" "$@") 2>&1 | tee -a "$build_log" |
    grep --line-buffered -E '^\[ *[0-9]+%\] (Building|Linking|Generating)|error|Error|warning:|CMake Warning'
  status=${PIPESTATUS[0]}
  set -e
  return "$status"
}

# build all|tests|demo_programs|TARGET: brings a target up to date. Unchanged sources of the first three cost no call of
# CMake; `all` contains `demo_programs`.
build() {
  local target=$1 stamp="$workspace/build/.$1-built" hash stamps
  hash=$(source_hash "$target")
  stamps=("$stamp")
  [ "$target" != demo_programs ] || stamps+=("$workspace/build/.all-built")
  if [ -f "$workspace/devel/setup.bash" ] && cat "${stamps[@]}" 2>/dev/null | grep -qxF "$hash"; then
    return
  fi
  # A build tree stores its absolute path and cannot be moved.
  local cache="$workspace/build/CMakeCache.txt"
  if [ -f "$cache" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$workspace/src" "$cache"; then
    note "the repository has moved: building from scratch"
    rm -rf "$workspace/build" "$workspace/devel"
  fi
  mkdir -p "$workspace/build"
  # catkin expects its top-level file beside the packages.
  ln -sfn /usr/share/catkin/cmake/toplevel.cmake "$workspace/src/CMakeLists.txt"

  local jobs
  jobs=$(build_jobs)
  case "$target" in
    all) say "Building the workspace in Release with $jobs job(s); log: $build_log" ;;
    demo_programs) say "Building the nodes in Release with $jobs job(s); log: $build_log" ;;
    tests) say "Building the tests in Release with $jobs job(s); log: $build_log" ;;
    *) say "Building $target in Release with $jobs job(s); log: $build_log" ;;
  esac
  : > "$build_log"
  rm -f "$stamp"
  local goal=()
  [ "$target" = all ] || goal=("$target")
  if ! run_catkin_make -j"$jobs" "${goal[@]}"; then
    tail -n 40 "$build_log" >&2
    die "the build failed; the whole log is $build_log"
  fi
  case "$target" in all|tests|demo_programs) printf '%s\n' "$hash" > "$stamp" ;; esac
}

# setup_workspace LIST… -- TARGET…: installs the packages of the lists and builds the targets. One set-up at a time: two
# builds in one tree would collide.
setup_workspace() {
  check_path "$repository"
  clean_environment
  exec 9< "$workspace/packages.txt"
  if ! flock -n 9; then
    note "waiting for another set-up in this workspace to end"
    flock 9
  fi
  while [ "$1" != -- ]; do
    install_packages "$1"
    shift
  done
  shift
  local target
  for target in "$@"; do build "$target"; done
  exec 9>&-
  set +u
  . "$workspace/devel/setup.bash"
  set -u
}

# Exports the folder of the meshes outside of the repository, if there is one.
find_meshes() {
  if [ -z "${ENDOVASCULAR_DATA_DIR:-}" ] && [ -d "$repository/../shared/vessels" ]; then
    ENDOVASCULAR_DATA_DIR=$(cd -P "$repository/../shared/vessels" && pwd -P)
    export ENDOVASCULAR_DATA_DIR
  fi
}
