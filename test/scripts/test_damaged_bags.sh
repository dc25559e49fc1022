#!/bin/bash
# Ten damaged bags of a session: bag_check, replay, replay --out and bag_export name the damage, and none is taken for complete.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
. "$repository/test/scripts/folder_of_a_test.sh"
/usr/bin/python3 "$repository/test/scripts/damaged_bags.py" "$repository" "$programs" "$folder"
