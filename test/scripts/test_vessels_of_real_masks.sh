#!/bin/bash
# Real masks become vessels of genus 0 that run the scene mesh: no node leaves them. The masks are third-party data in
# ENDOVASCULAR_DATA_DIR: aorta.nii.gz and example_seg.nii.gz (TotalSegmentator's tests), aorta-final-levelset.mha (VMTK's, negative
# inside).
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
data=${ENDOVASCULAR_DATA_DIR:-/nonexistent}
cd "$folder"
tested=no

"$programs/volume_import" --help > /dev/null 2>&1 || { echo "skipped: built without ITK"; exit 77; }

vessel() { # vessel NAME MASK OPTION...
  [ -f "$2" ] || { echo "$1: skipped, $2 is missing"; return 0; }
  tested=yes
  "$programs/vessel_segment" "$2" --out "$1.obj" --quiet "${@:3}" > "$1.log" 2>&1 || { cat "$1.log"; exit 1; }
  cat "$1.log"
  grep -q 'genus 0' "$1.log"
  local arguments
  eval "arguments=($(sed -n 's/^to use the vessel: rosrun endovascular_sim simulate //p' "$1.log"))"
  "$programs/simulate" "$repository/${arguments[0]}" "${arguments[@]:1}" --out "$1" --no-plots --quiet > /dev/null
  /usr/bin/python3 - "$1" <<'PYTHON'
import json, sys
result = json.load(open(sys.argv[1] + "/result.json"))
print("%s: %d nodes outside, %.4f mm beyond the wall" % (sys.argv[1], result["nodes_outside"], 1e3 * result["worst_surface_penetration"]))
sys.exit(0 if result["nodes_outside"] == 0 and result["worst_surface_penetration"] <= 1e-4 else 1)
PYTHON
}

vessel total "$data/aorta.nii.gz" --label 1
vessel coarse "$data/example_seg.nii.gz" --label 52
if [ -f "$data/aorta-final-levelset.mha" ]; then
  /usr/bin/python3 "$repository/test/segmentation/mask_of_level_set.py" "$data/aorta-final-levelset.mha" mask.mha
fi
vessel level_set mask.mha --label 1
[ $tested = yes ] || { echo "skipped: ENDOVASCULAR_DATA_DIR holds none of the masks"; exit 77; }
