#!/bin/bash
# The reference runs of test/data/trajectory_hashes.txt give their recorded trajectories, bit for bit. Runs whose mesh is not
# in ENDOVASCULAR_DATA_DIR are left out.
#   --renew   writes the hashes of this build into the table, after an intended change of the physics
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
table=$repository/test/data/trajectory_hashes.txt
simulate=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}/simulate
cd "$folder"  # no mesh of the current folder is used instead

physics=$(sed -n 's/.*kPhysicsNumber = \([0-9]*\);.*/\1/p' "$repository/src/common/version.h")
recorded_physics=$(sed -n 's/^physics_number //p' "$table")
renew=false
[ "${1:-}" != --renew ] || renew=true

# run_one NAME HASH MESH SCENE ARGUMENT…: the new hash goes to NAME.hash.
run_one() {
  local name=$1 mesh=$3 scene=$4
  shift 4
  if [ "$mesh" != - ] && [ ! -f "${ENDOVASCULAR_DATA_DIR:-/nonexistent}/$mesh" ]; then
    echo "$name: left out, ENDOVASCULAR_DATA_DIR has no $mesh"
    return
  fi
  # A procedure that is cut short is no success of its own, but has a trajectory.
  "$simulate" "$repository/config/scenes/$scene.yaml" --no-plots --quiet --out "$name" "$@" > "$name.log" 2>&1 || true
  sed -n 's/.*"trajectory_hash": *"\([0-9a-f]*\)".*/\1/p' "$name/result.json" > "$name.hash" 2> /dev/null ||
    { echo "$name: no result"; cat "$name.log"; }
}
export -f run_one
export simulate repository
runs() { grep -vE '^(#|physics_number|$)' "$table"; }
runs | xargs -P "$(nproc)" -d '\n' -I '{}' bash -c 'set -f; run_one $1' run_one '{}'

compared=0 different=0 failed=0
while read -r name hash mesh _; do
  if [ ! -e "$name.hash" ]; then
    [ "$mesh" != - ] && [ ! -d "$name" ] || failed=$((failed + 1))
    continue
  fi
  new=$(cat "$name.hash")
  compared=$((compared + 1))
  if $renew; then
    sed -i "s/^\($name  *\)$hash/\1$new/" "$table"
  elif [ "$new" != "$hash" ]; then
    echo "$name: trajectory_hash $new, recorded $hash"
    different=$((different + 1))
  fi
done < <(runs)
if $renew; then
  sed -i "s/^physics_number .*/physics_number $physics/" "$table"
  echo "$compared hashes written for physics number $physics"
  exit "$failed"
fi
echo "$compared runs compared, $different different"
[ "$failed" -eq 0 ] || exit 1
if [ "$different" -gt 0 ] || [ "$physics" != "$recorded_physics" ]; then
  cat <<TEXT
The physics number is $physics (src/common/version.h), that of the table $recorded_physics. Unless the results were meant to
change, find the cause of the difference. After an intended change of the physics, increment kPhysicsNumber, run
  test/scripts/test_trajectory_hashes.sh --renew
with all meshes in ENDOVASCULAR_DATA_DIR, and commit the table with the change.
TEXT
  exit 1
fi
[ "$compared" -gt 0 ]
