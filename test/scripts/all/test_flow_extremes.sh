#!/bin/bash
# A million steps of the flow of blood with stenoses, balloons, closures, arrest and extreme rates.
set -eu
repository=$(cd "$(dirname "$0")/../../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
cd "$repository"
FLOW_STEPS=1000000 "$programs/test_flow" --gtest_filter='ExtremeFlow.*'
