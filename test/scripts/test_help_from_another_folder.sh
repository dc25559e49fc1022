#!/bin/bash
# Both commands print their help from any current folder and refuse unknown options.
# Runs beside other tests.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
cd /
"$repository/catkin_ws/demo" --help | grep -q -- '--scene NAME'
"$repository/catkin_ws/test" --help | grep -q 'N passed, N failed'
status=0; "$repository/catkin_ws/demo" --nonsense 2> /dev/null || status=$?
[ "$status" -eq 2 ]
status=0; "$repository/catkin_ws/demo" --seconds -3 2> /dev/null || status=$?
[ "$status" -eq 2 ]
message=$("$repository/catkin_ws/demo" --scene no_such_scene 2>&1) && exit 1
grep -q "there is no scene 'no_such_scene'" <<< "$message"
grep -q 'demo' <<< "$message"
