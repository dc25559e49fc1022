#!/bin/bash
# No scene of config/scenes gives a warning, with its vessel. Scenes whose mesh is not in ENDOVASCULAR_DATA_DIR are left out;
# mesh.yaml has a tube for the user's mesh.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
/usr/bin/python3 "$repository/test/scripts/make_tube.py" "$folder/tube.obj"
failed=0
for scene in "$repository"/config/scenes/*.yaml; do
  arguments=()
  mesh=$(sed -n 's/^  mesh: *\([^ ]*\).*/\1/p' "$scene")
  case "$(basename "$scene")" in
    mesh.yaml) arguments=(--set "vessel.mesh=$folder/tube.obj" --set vessel.unit=0.001) ;;
    peer_wire.yaml) mesh=aortic_arch_tree.obj arguments=(--set vessel.mesh=aortic_arch_tree.obj) ;;
  esac
  if [ -n "$mesh" ] && [ ! -f "${ENDOVASCULAR_DATA_DIR:-/nonexistent}/$mesh" ]; then
    echo "$(basename "$scene"): left out, ENDOVASCULAR_DATA_DIR has no $mesh"
    continue
  fi
  message=$("$programs/scene_check" "$scene" --vessel --hash "${arguments[@]}" 2>&1) || { echo "$scene: refused"; failed=1; }
  echo "$(basename "$scene"): $message"
  ! grep -qi 'warning' <<< "$message" || failed=1
  # Less than a tenth of the hand force is the error that the sampling of the scene for any mesh may have.
  [ "$(basename "$scene")" != mesh.yaml ] || grep -Eq 'expected error .*: [0-9]\.[0-9] % at' <<< "$message" || failed=1
done
exit $failed
