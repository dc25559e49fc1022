#!/bin/bash
# replay --out makes from the bags of three sessions the files and pictures that the sessions wrote.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
. "$repository/test/scripts/folder_of_a_test.sh"
/usr/bin/python3 "$repository/test/scripts/results_from_bags.py" "$repository" "$programs" "$folder"
