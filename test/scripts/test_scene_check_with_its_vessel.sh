#!/bin/bash
# With --vessel, scene_check accepts the default scene and refuses an entry at a centreline end that does not exist.
# Runs beside other tests.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
programs=$repository/catkin_ws/devel/lib/endovascular_sim
scene=$repository/config/scenes/pci.yaml
"$programs/scene_check" "$scene" --vessel --hash
status=0
message=$("$programs/scene_check" "$scene" --vessel --set entry.centreline_end=nowhere 2>&1 > /dev/null) || status=$?
echo "$message"
[ "$status" -eq 1 ]
grep -q 'entry.centreline_end.*nowhere' <<< "$message"
grep -q 'right_common_femoral' <<< "$message"
"$programs/scene_check" "$scene" --set entry.centreline_end=nowhere --hash # only the vessel knows its ends
