#!/bin/bash
# The installation is complete and can be moved: a plain CMake program and a catkin program outside of the repository are
# built against it, the first links no ROS library, and both compute the trajectory of `simulate`.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
build=${ENDOVASCULAR_BUILD_DIR:-$repository/catkin_ws/build}
unset ENDOVASCULAR_CONFIG_DIR LD_LIBRARY_PATH
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/first" > "$folder/install.log"
mv "$folder/first" "$folder/installed"
installed=$folder/installed

# catkin's own files name the configured prefix, which may lie in the repository; nothing names its sources.
if grep -rlE "$repository/(catkin_ws/src/endovascular_sim/)?(config|src|cmake|launch)/" "$installed"; then
  echo "these installed files name the repository's sources"
  exit 1
fi

hash_of() { sed -n 's/.*trajectory_hash"*:* "*\([0-9a-f]\{16\}\).*/\1/p' "$1"; }
cd "$folder"
"$installed/lib/endovascular_sim/simulate" "$installed/share/endovascular_sim/config/scenes/tube.yaml" \
  --no-plots --quiet --out "$folder/run"
wanted=$(hash_of "$folder/run/result.json")
[ -n "$wanted" ]

for project in plain_cmake catkin; do
  cp -r "$repository/test/install/$project" "$folder/$project"
  cmake -S "$folder/$project" -B "$folder/$project/build" -DCMAKE_PREFIX_PATH="$installed" -DCMAKE_BUILD_TYPE=Release \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 > "$folder/$project.log"
  cmake --build "$folder/$project/build" >> "$folder/$project.log"
  program=$(find "$folder/$project/build" -name 'step_a_scene*' -type f -perm -100 | head -n 1)
  "$program" | tee "$folder/$project.out"
  [ "$(hash_of "$folder/$project.out")" = "$wanted" ] || { echo "$project: the trajectory is not that of simulate, $wanted"; exit 1; }
  ldd "$program" > "$folder/$project.ldd"
  grep -q "$installed/lib/libendovascular_sim_core.so" "$folder/$project.ldd"
done
if grep -E 'libros|libxmlrpcpp|libcpp_common|libendovascular_sim_nodes' "$folder/plain_cmake.ldd"; then
  echo "plain_cmake links ROS"
  exit 1
fi
grep -q libroscpp "$folder/catkin.ldd"

# Of the installed programs, only nodes and the two tools that speak ROS link it.
for program in "$installed"/lib/endovascular_sim/*; do
  name=$(basename "$program")
  [ "$(head -c 4 "$program" | tail -c 3)" = ELF ] || continue
  uses=no
  if ldd "$program" | grep -q libroscpp; then uses=yes; fi
  case "$name" in
    contact|fluoroscopy|haptic_device|rod_dynamics|session|vessel_server|visualization|replay|device_simulator) wanted=yes ;;
    *) wanted=no ;;
  esac
  [ $uses = $wanted ] || { echo "$name links ROS: $uses, expected: $wanted"; exit 1; }
done
