#!/bin/bash
# clang-tidy finds nothing in src, by the checks of .clang-tidy.
#   FILE… as arguments: only these
set -eu
cd "$(dirname "$0")/../../.."
build=${ENDOVASCULAR_BUILD_DIR:-catkin_ws/build}
[ $# -gt 0 ] || set -- $(git ls-files 'src/*.cpp')
# gcc knows warning options that clang does not.
printf '%s\0' "$@" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option
