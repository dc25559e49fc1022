#!/bin/bash
# vessel_segment makes a vessel for scenes and a centreline that is an anatomy. --open and --closed name ends by points, as
# vessel_server prints them for a click in rviz. No output holds the name, number or date of birth of the patient.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"

"$programs/synthetic_ct" --anatomy "$repository/config/anatomies/fork.yaml" --view fit --spacing 0.6 --out fork.vol \
  --clicks fork.yaml --quiet > log
"$programs/vessel_segment" fork.vol --clicks fork.yaml --out one.obj --quiet > log
grep -q 'genus 0, open ends: 3' log

ends() { # ends OPTION...: prints the number of open ends
  "$programs/vessel_segment" fork.vol --clicks fork.yaml --out ends.obj --max-distance 0.0005 --quiet "$@" |
    sed -n 's/.* open ends: \([0-9]*\),.*/\1/p'
}
[ "$(ends --open 0.025,0,0.08)" -eq 1 ] # a point near the end of the left branch
[ "$(ends --closed -0.02,0.005,0.09)" -eq 2 ]
[ "$(ends --open largest --open left --closed trunk)" -eq 1 ]

if "$programs/volume_import" --help > /dev/null 2>&1; then
  # All outputs, with the terminal, of images whose files hold the patient's data.
  mkdir outputs
  /usr/bin/python3 "$repository/test/segmentation/volume_formats.py" fork.vol .
  /usr/bin/python3 "$repository/test/segmentation/series_by_pydicom.py" fork.vol pydicom
  for images in pydicom image.nii; do
    grep -a -q 'Doe^Jane' -r "$images"
    modality=$([ "$images" = image.nii ] && echo "--modality ct" || true)
    # shellcheck disable=SC2086
    "$programs/vessel_segment" "$images" $modality --clicks fork.yaml --out "outputs/of_$images.obj" \
      --max-distance 0.0005 > "outputs/$images.log" 2>&1
    # shellcheck disable=SC2086
    "$programs/vessel_segment" "$images" $modality --page "outputs/page_$images.html" > "outputs/page_$images.log" 2>&1
  done
  cp -r pydicom twice
  sed 's/1.2.826.0.1.8/1.2.826.0.1.9/g' pydicom/000 > twice/other_series
  "$programs/vessel_segment" twice --page outputs/none.html > outputs/refusal.log 2>&1 && exit 1
  grep -q 'holds 2 series' outputs/refusal.log
  if grep -a -r -l -i -e 'doe^jane' -e 'ID4711' -e '19620314' outputs; then
    echo "the patient's name, number or date of birth is in these files"
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
