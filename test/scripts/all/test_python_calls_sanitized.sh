#!/bin/bash
# 1000 random sequences of calls of the Python module under the address sanitizer: test/python/random_calls.py.
# Builds core and module in catkin_ws/sanitized/python.
#   OPTION… of random_calls.py, e.g. --first 17 --count 1 --verbose
set -eu
repository=$(cd "$(dirname "$0")/../../.." && pwd)
build=$repository/catkin_ws/sanitized/python
runtime=$(clang++ -print-file-name=libclang_rt.asan-x86_64.so)
checks="-fsanitize=address -shared-libasan"
launcher=()
if command -v ccache > /dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi

mkdir -p "$build/endovascular_sim"
{
  cmake -S "$repository/python" -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ \
    -DENDOVASCULAR_FIND_CORE=OFF -DENDOVASCULAR_PACKAGE=endovascular_sim \
    -DPython3_EXECUTABLE=/usr/bin/python3 -DCMAKE_LIBRARY_OUTPUT_DIRECTORY="$build/endovascular_sim" \
    -DCMAKE_SHARED_LINKER_FLAGS="$checks" -DCMAKE_MODULE_LINKER_FLAGS="$checks" \
    -DCMAKE_CXX_FLAGS="$checks -D_GLIBCXX_ASSERTIONS -DENDOVASCULAR_SANITIZED -g1 -fno-omit-frame-pointer" \
    -DCMAKE_CXX_FLAGS_RELEASE=-O1 "${launcher[@]}" &&
    nice cmake --build "$build" -j "$(nproc)" --target endovascular_sim_python
} > "$build.log" 2>&1 || { tail -n 40 "$build.log"; exit 1; }
cp "$repository"/python/endovascular_sim/*.py "$build/endovascular_sim/"

# The interpreter and numpy keep memory until their end, so leaks are not searched. PYTHONMALLOC: every object has memory of its own.
export ASAN_OPTIONS=detect_leaks=0:abort_on_error=1:allocator_may_return_null=1
export PYTHONPATH=$build PYTHONMALLOC=malloc ENDOVASCULAR_CONFIG_DIR=$repository/config
cd "$repository/test/python"
LD_PRELOAD=$runtime exec /usr/bin/python3 -X faulthandler random_calls.py "$@"
