#!/bin/bash
# vessel_segment makes the same vessel from DICOM, NIfTI, NRRD and MetaImage files, written without ITK, and with any number
# of threads. The vessel is a scene's vessel, its centreline an anatomy. No file holds the patient's name. Wrong clicks are
# refused.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$programs/synthetic_ct" --anatomy "$repository/config/anatomies/fork.yaml" --view fit --spacing 0.6 --out fork.vol \
  --clicks fork.yaml --quiet > log
"$programs/vessel_segment" fork.vol --clicks fork.yaml --out one.obj --threads 1 --quiet > log
grep -q 'genus 0, open ends: 3' log
"$programs/vessel_segment" fork.vol --clicks fork.yaml --out four.obj --threads 4 --quiet > log
cmp one.obj four.obj
cmp <(grep -v '^name:' one_centreline.yaml) <(grep -v '^name:' four_centreline.yaml)

if [ -x "$programs/volume_import" ]; then
  /usr/bin/python3 "$repository/test/segmentation/volume_formats.py" fork.vol .
  for images in dicom image.nii image.nrrd image.mha; do
    modality=$([ "$images" = dicom ] || echo "--modality ct")
    # shellcheck disable=SC2086
    "$programs/vessel_segment" "$images" $modality --clicks fork.yaml --out "of_$images.obj" --quiet > log
    /usr/bin/python3 "$repository/test/segmentation/compare_meshes.py" one.obj "of_$images.obj" 1e-6 > log
  done
  if grep -a -l 'Doe^Jane\|ID4711' of_* one* four*; then
    echo "the patient's name or number is in these files"
    exit 1
  fi
fi

"$programs/vessel_segment" fork.vol --page page.html --quiet > log
grep -q 'const grid' page.html

"$programs/simulate" "$repository/config/scenes/mesh.yaml" --set vessel.mesh="$folder/one.obj" --set vessel.unit=1 \
  --set drive.travel=0.03 --set entry.position='[0,0,0]' --out run --seconds 1 --no-plots --quiet
grep -q '"nodes_outside": 0' run/result.json
"$programs/simulate" "$repository/config/scenes/mesh.yaml" --set vessel.mesh=null --set vessel.unit=null --set vessel.repair=null --set vessel.rotation=null \
  --set vessel.translation=null --set vessel.anatomy="$folder/one_centreline.yaml" --set drive.travel=0.03 \
  --set entry.position='[0,0,0]' --out run2 --seconds 0.2 --no-plots --quiet

sed 's/0.95, 0.86, 0.56/0.95, 9.86, 0.56/' fork.yaml > beside.yaml
status=0
"$programs/vessel_segment" fork.vol --clicks beside.yaml --out bad.obj --quiet 2> errors || status=$?
[ "$status" -eq 1 ]
grep -q 'trunk, click 1 (line 6) at (0.9, 9.9, 0.6) mm: lies in fat .*; the nearest lumen is at (' errors
