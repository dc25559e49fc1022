#!/bin/bash
# In a bare Debian 13: the demonstration and the trajectory hashes from source, then the packages. `catkin_ws/debian trixie` runs
# all tests there.
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
code=0
"$repository/catkin_ws/debian" trixie sh -c \
  "catkin_ws/demo --headless && catkin_ws/test --filter 'test_trajectory_hashes'" || code=$?
[ $code -eq 0 ] || exit $code
"$repository/test/scripts/all/test_package.sh" trixie
