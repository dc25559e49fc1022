#!/bin/bash
# Every C++ file has the format of .clang-format.
# Runs beside other tests.
set -eu
cd "$(dirname "$0")/../.."
git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format --dry-run -Werror
