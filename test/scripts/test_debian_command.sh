#!/bin/bash
# `catkin_ws/debian` explains itself, and refuses a suite without ROS 1 and unknown options before it makes anything.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
command=$repository/catkin_ws/debian

"$command" --help | grep -q '^usage: catkin_ws/debian SUITE'
"$command" trixie --help | grep -q '^usage: catkin_ws/debian SUITE'

# refuses TEXT ARGUMENT…: exit code 2, and a message with the text.
refuses() {
  local text=$1 code=0
  shift
  CHROOT_CACHE=$folder/cache "$command" "$@" > "$folder/output" 2>&1 || code=$?
  if [ $code -ne 2 ] || ! grep -qF -- "$text" "$folder/output"; then
    echo "arguments '$*': exit code $code, and not '$text':"
    cat "$folder/output"
    exit 1
  fi
}
refuses 'the first argument is a suite'
refuses "'buster' is no suite with ROS 1: bookworm or trixie" buster
refuses '--root needs a folder' trixie --root
refuses "unknown option '--fast'" trixie --fast
[ ! -e "$folder/cache" ] || { echo "a refused command makes files"; exit 1; }

# A folder that holds another system is left as it is.
mkdir -p "$folder/other/etc"
echo 'VERSION_CODENAME=bookworm' > "$folder/other/etc/os-release"
code=0
"$command" trixie --root "$folder/other" true > "$folder/output" 2>&1 || code=$?
case $code in
  77) ;;  # no chroot can be made here
  1) grep -q 'is no system of trixie' "$folder/output" ;;
  *) cat "$folder/output"; exit 1 ;;
esac
[ "$(ls "$folder/other")" = etc ]
