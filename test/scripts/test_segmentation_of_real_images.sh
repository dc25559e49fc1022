#!/bin/bash
# Real images become vessels that run the scene mesh: no node leaves them, no surface is more than 0.1 mm beyond the wall.
# aorta.mha (and aorta-surface.stl, the level set of VMTK) and CT_AVM.nii.gz are third-party data in ENDOVASCULAR_DATA_DIR.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
data=${ENDOVASCULAR_DATA_DIR:-/nonexistent}
cd "$folder"
tested=no

"$programs/volume_import" --help > /dev/null 2>&1 || { echo "skipped: built without ITK"; exit 77; }

segment() { # segment NAME FILE CLICKS
  "$programs/vessel_segment" "$data/$2" --modality other --clicks "$repository/test/data/$3" --out "$1.obj" --quiet > "$1.log"
  cat "$1.log"
  grep -q 'genus 0' "$1.log"
}

scene() { # scene NAME OPTION...
  "$programs/simulate" "$repository/config/scenes/mesh.yaml" --set vessel.mesh="$folder/$1.obj" --set vessel.unit=1 \
    --set vessel.centreline="$folder/$1_centreline.yaml" --out "$1" --no-plots --quiet "${@:2}"
  /usr/bin/python3 - "$1" <<'PYTHON'
import json, sys
result = json.load(open(sys.argv[1] + "/result.json"))
outside, beyond = result["nodes_outside"], result["worst_surface_penetration"]
print("%s: %d nodes outside, %.4f mm beyond the wall" % (sys.argv[1], outside, 1e3 * beyond))
sys.exit(0 if outside == 0 and beyond <= 1e-4 else 1)
PYTHON
}

if [ -f "$data/aorta.mha" ]; then
  tested=yes
  segment aorta aorta.mha clicks_aorta_mr.yaml
  grep -q 'open ends: 5' aorta.log
  scene aorta --set entry.position='[-0.19, -0.045, 0.042]'
  if [ -f "$data/aorta-surface.stl" ]; then
    # VMTK's surface is in the frame of the grid without its direction, which is (-1, -1, 1).
    /usr/bin/python3 "$repository/test/segmentation/distance_of_surfaces.py" aorta.obj "$data/aorta-surface.stl" 0.0006
  fi
fi
if [ -f "$data/CT_AVM.nii.gz" ]; then
  tested=yes
  segment sinus CT_AVM.nii.gz clicks_sinus_ct.yaml
  scene sinus
fi
[ $tested = yes ] || { echo "skipped: ENDOVASCULAR_DATA_DIR holds neither aorta.mha nor CT_AVM.nii.gz"; exit 77; }
