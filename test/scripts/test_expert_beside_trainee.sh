#!/bin/bash
# The expert beside a trainee: states and distance of the tips are those computed from the two bags, in every alignment.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
. "$repository/test/scripts/folder_of_a_test.sh"
/usr/bin/python3 "$repository/test/scripts/expert_beside_trainee.py" "$repository" "$programs" "$folder"
