#!/bin/bash
# Programs pass paths to other programs literally: no shell executes a part of a path, and plots appear in such folders.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"
for name in "q'; touch PWNED; echo '" "O'Brien"; do
  "$programs/simulate" "$repository/config/scenes/straight_wire.yaml" --seconds 0.5 --quiet --out "$name" > /dev/null
  ls "$name"/*.png > /dev/null || { echo "no plot in the folder $name"; exit 1; }
done
[ ! -e PWNED ] || { echo "a shell executed a part of the path"; exit 1; }
