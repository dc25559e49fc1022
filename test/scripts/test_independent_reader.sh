#!/bin/bash
# An independent reader of bags, npm's @foxglove/rosbag, finds the messages and the steps that bag_check and Python's Bag find.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
. "$repository/test/scripts/folder_of_a_test.sh"
. "$repository/test/scripts/node_modules.sh"
/usr/bin/python3 "$repository/test/scripts/independent_reader.py" "$programs" \
  "$repository/test/fuzz/corpus/bag/session"
