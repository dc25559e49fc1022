#!/bin/bash
# All rows of docs/REPRODUCE.md hold, and have the results of docs/validation/reproduce.csv.
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
"$programs/plots" reproduce --out "$folder/out" --compare "$repository/docs/validation/reproduce.csv"
