#!/bin/bash
# Every C++ file has the format of .clang-format.
# Runs beside other tests.
set -eu
cd "$(dirname "$0")/../.."
# Another release of clang-format breaks lines elsewhere.
release=$(clang-format --version | sed -n 's/.*version \([0-9]*\)\..*/\1/p')
[ "$release" = 14 ] || { echo "skipped: clang-format is of release $release; the format is that of release 14 (Debian 12)"; exit 77; }
git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format --dry-run -Werror
