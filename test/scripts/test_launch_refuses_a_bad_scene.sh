#!/bin/bash
# A refused scene ends a launch before any node starts, and its message is printed once.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"
export ROS_HOME=$folder ROS_LOG_DIR=$folder
for launch in sim.launch robot.launch; do
  status=0
  message=$(timeout 60 roslaunch endovascular_sim "$launch" overrides:='vessel.stifness=3 duration=1' rviz:=false 2>&1) || status=$?
  echo "$message"
  [ "$status" -ne 0 ] && [ "$status" -ne 124 ]
  [ "$(grep -c 'did you mean "stiffness"' <<< "$message")" -eq 1 ]
  ! grep -q 'process\[' <<< "$message"
done
