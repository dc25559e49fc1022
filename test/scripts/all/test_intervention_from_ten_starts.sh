#!/bin/bash
# The intervention of pci.yaml, in flowing blood and with injections, places its stent from ten of ten perturbed starts, with all nodes
# inside the wall.
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
"$programs/procedure_study" "$repository/config/scenes/pci.yaml" --out "$folder/study" --runs 10 --set duration=300
