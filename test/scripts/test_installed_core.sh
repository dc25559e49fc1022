#!/bin/bash
# An installation is complete and can be moved. The projects of test/install are built against it: all compute the
# trajectories of `simulate`, and the plain CMake programs link no ROS library. The catkin project also builds in the devel space.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
build=${ENDOVASCULAR_BUILD_DIR:-$repository/catkin_ws/build}
devel=${ENDOVASCULAR_DEVEL_DIR:-$repository/catkin_ws/devel}
unset ENDOVASCULAR_CONFIG_DIR LD_LIBRARY_PATH

cmake --install "$build" --prefix "$folder/first" > "$folder/install.log"
mv "$folder/first" "$folder/installed"
installed=$folder/installed

# catkin's own files name the configured prefix, which may lie in the repository; nothing names its sources.
if grep -rlE "$repository/(catkin_ws/src/endovascular_sim/)?(config|src|cmake|launch)/" "$installed"; then
  echo "these installed files name the repository's sources"
  exit 1
fi
links=$(find "$installed" -type l -lname '*/*')
[ -z "$links" ] || { echo "links that lead out of their folder: $links"; exit 1; }

hash_of() { sed -n 's/.*trajectory_hash"*:* "*\([0-9a-f]\{16\}\).*/\1/p' "$1"; }
cd "$folder"
"$installed/lib/endovascular_sim/simulate" "$installed/share/endovascular_sim/config/scenes/tube.yaml" \
  --no-plots --quiet --out "$folder/run"
wanted=$(hash_of "$folder/run/result.json")
[ -n "$wanted" ]

# build_and_run PROJECT PREFIX NAME: builds a project against the package in a prefix, runs it and compares its hash.
build_and_run() {
  local project=$1 prefix=$2 name=$3 program
  cmake -S "$repository/test/install/$project" -B "$folder/$name" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 > "$folder/$name.log"
  cmake --build "$folder/$name" >> "$folder/$name.log"
  program=$(find "$folder/$name" -name 'step_a_scene*' -type f -perm -100 | head -n 1)
  "$program" | tee "$folder/$name.out"
  [ "$(hash_of "$folder/$name.out")" = "$wanted" ] || { echo "$name: the trajectory is not that of simulate, $wanted"; exit 1; }
  ldd "$program" > "$folder/$name.ldd"
  grep -q "$prefix/lib/libendovascular_sim_core.so" "$folder/$name.ldd"
}
build_and_run plain_cmake "$installed" plain_cmake
# Half a procedure, an X-ray image, and the other half in a second session that loads the state of the first one.
"$installed/lib/endovascular_sim/simulate" "$installed/share/endovascular_sim/config/scenes/pci.yaml" --seconds 3 \
  --no-plots --quiet --out "$folder/pci" || true  # the procedure is cut short
"$folder/plain_cmake/run_a_procedure" duration=3 | tee "$folder/procedure.out"
"$installed/lib/endovascular_sim/simulate" "$installed/share/endovascular_sim/config/scenes/pci.yaml" --seconds 1.5 \
  --set "fluoroscopy.view=LAO 40" --x-ray --no-plots --quiet --out "$folder/half" || true
cmp x_ray.png "$folder/half/x_ray.png" || { echo "run_a_procedure: the image is not that of simulate"; exit 1; }
[ "$(hash_of "$folder/procedure.out")" = "$(hash_of "$folder/pci/result.json")" ] ||
  { echo "run_a_procedure: the trajectory is not that of simulate"; exit 1; }
build_and_run catkin "$installed" catkin
build_and_run catkin "$devel" catkin_devel
if grep -E 'libros|libxmlrpcpp|libcpp_common|libendovascular_sim_nodes' "$folder/plain_cmake.ldd"; then
  echo "plain_cmake links ROS"
  exit 1
fi
for program in step_a_scene run_a_procedure; do
  if ldd "$folder/plain_cmake/$program" | grep -E 'urdf|console_bridge'; then
    echo "plain_cmake/$program loads the reader of robots, which its scene does not have"
    exit 1
  fi
done
grep -q libroscpp "$folder/catkin.ldd"

# The Python package of the installation.
PYTHONPATH=$installed/lib/python3/dist-packages /usr/bin/python3 > "$folder/python.out" - "$wanted" <<'PYTHON'
import sys
import endovascular_sim as evs
from endovascular_sim.msg import DriveApplied
session = evs.World("tube").session()
session.step(n=10**6)
assert session.trajectory_hash == sys.argv[1], session.trajectory_hash
PYTHON

# Of the installed programs, only nodes, the three tools that speak ROS and the example of a client link it.
for program in "$installed"/lib/endovascular_sim/*; do
  name=$(basename "$program")
  [ "$(head -c 4 "$program" | tail -c 3)" = ELF ] || continue
  uses=no
  if ldd "$program" | grep -q libroscpp; then uses=yes; fi
  case "$name" in
    contact|expert|fluoroscopy|haptic_device|hemodynamics|player|robot|rod_dynamics|session|vessel_server|visualization|bag_check|replay|scripted_recording|device_simulator|push_to_force) wanted=yes ;;
    *) wanted=no ;;
  esac
  [ $uses = $wanted ] || { echo "$name links ROS: $uses, expected: $wanted"; exit 1; }
done
