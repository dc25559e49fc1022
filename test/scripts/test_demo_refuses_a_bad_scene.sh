#!/bin/bash
# A refused scene ends the demo at once, with the scene's message and without starting a graph.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
status=0
message=$("$repository/catkin_ws/demo" --scene tube --headless --set vessel.stifness=3 --out "$folder/results" 2>&1) ||
  status=$?
echo "$message"
[ "$status" -eq 1 ]
grep -q 'stifness' <<< "$message"
[ ! -e "$folder/results/session.bag" ]
# A folder that already holds a session is never overwritten.
mkdir -p "$folder/old"
echo '{}' > "$folder/old/report.json"
status=0
message=$("$repository/catkin_ws/demo" --scene tube --headless --out "$folder/old" 2>&1) || status=$?
[ "$status" -eq 1 ]
grep -q 'already holds a session' <<< "$message"
