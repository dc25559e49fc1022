#!/bin/bash
# Bags of half a second of every scene whose mesh is there: an independent reader finds what bag_check and Python's Bag find, and they replay.
set -eu
repository=$(cd "$(dirname "$0")/../../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
. "$repository/test/scripts/folder_of_a_test.sh"
. "$repository/test/scripts/node_modules.sh"
/usr/bin/python3 "$repository/test/scripts/make_tube.py" "$folder/tube.obj"
bags=()
for scene in "$repository"/config/scenes/*.yaml; do
  name=$(basename "$scene" .yaml)
  overrides=(duration=0.5)
  mesh=$(sed -n 's/^  mesh: *\([^ ]*\).*/\1/p' "$scene")
  case "$name" in
    mesh) overrides+=("vessel.mesh=$folder/tube.obj" vessel.unit=0.001) ;;
    peer_wire) mesh=aortic_arch_tree.obj overrides+=(vessel.mesh=aortic_arch_tree.obj) ;;
  esac
  if [ -n "$mesh" ] && [ ! -f "${ENDOVASCULAR_DATA_DIR:-/nonexistent}/$mesh" ]; then
    echo "$name: left out, ENDOVASCULAR_DATA_DIR has no $mesh"
    continue
  fi
  echo "recording $name"
  PYTHONPATH=$repository/test/scripts:$PYTHONPATH /usr/bin/python3 -c 'import sys, bag_sessions; bag_sessions.record(*sys.argv[1:])' \
    "$repository" "$folder/$name" "$scene" "${overrides[@]}"
  bags+=("$folder/$name/results/session.bag")
done
/usr/bin/python3 "$repository/test/scripts/independent_reader.py" "$programs" "${bags[@]}"
"$programs/replay" "${bags[@]}"
