#!/bin/bash
# clang-tidy finds nothing in src, by the checks of .clang-tidy.
#   FILE… as arguments: only these
set -eu
cd "$(dirname "$0")/../../.."
build=${ENDOVASCULAR_BUILD_DIR:-catkin_ws/build}
# Another release of clang-tidy has other checks.
release=$(clang-tidy --version | sed -n 's/.*version \([0-9]*\)\..*/\1/p')
[ "$release" = 14 ] || { echo "skipped: clang-tidy is of release $release; the checks are those of release 14 (Debian 12)"; exit 77; }
[ $# -gt 0 ] || set -- $(git ls-files 'src/*.cpp')
# gcc knows warning options that clang does not.
printf '%s\0' "$@" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option
