#!/bin/bash
# A build without ITK has a volume_import that names the commands for its installation, and an installation of ITK changes
# the options of the build, so that CMake searches it again.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"

cmake -S "$repository" -B "$folder/build" -DENDOVASCULAR_ROS=OFF -DENDOVASCULAR_ITK=OFF > "$folder/log"
cmake --build "$folder/build" --target volume_import >> "$folder/log"
status=0
"$folder/build/lib/endovascular_sim/volume_import" CT --out a.vol 2> "$folder/message" || status=$?
[ "$status" -eq 1 ] || { echo "exit code $status"; exit 1; }
for line in 'sudo apt-get install libinsighttoolkit5-dev' 'catkin_ws/demo --build-only'; do
  grep -qF "  $line" "$folder/message" || { echo "the message does not name: $line"; exit 1; }
  grep -qF "$line" "$repository/docs/IMAGES.md" || { echo "IMAGES.md does not name: $line"; exit 1; }
done
if ldd "$folder/build/lib/endovascular_sim/volume_import" | grep ITK; then exit 1; fi

workspace=$repository/catkin_ws
# shellcheck source=../../catkin_ws/lib/workspace.sh
. "$workspace/lib/workspace.sh"
dpkg-query() { [ "${*: -1}" = libinsighttoolkit5-dev ] && printf '%s' "$state_of_itk" || command dpkg-query "$@"; }
state_of_itk=installed
build_options | grep -qx -e -DENDOVASCULAR_ITK=ON
state_of_itk=
build_options | grep -qx -e -DENDOVASCULAR_ITK=OFF
