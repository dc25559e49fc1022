#!/bin/bash
# vessel_segment refuses wrong images and clicks with place and remedy, leaves no vessel, and warns of doubtful images.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"
failures=0

check() { # check STATUS IMAGES CLICKS PATTERN OPTION...: the exit code, and a message that matches the pattern
  local wanted=$1 images=$2 clicks=$3 pattern=$4 status=0
  "$programs/vessel_segment" "$images" --clicks "$clicks" --out result.obj --max-distance 0.0005 --quiet "${@:5}" > output 2>&1 ||
    status=$?
  [ "$status" -eq "$wanted" ] && grep -qE -e "$pattern" output && return
  echo "wanted exit code $wanted and '$pattern' of $images with $clicks; got $status and:"
  cat output
  failures=$((failures + 1))
}
click() { # click X,Y,Z FILE: the clicks with another first one
  sed "0,/clicks: \[\[[^]]*\]/s//clicks: [[$1]/" fork.yaml > "$2"
}

"$programs/synthetic_ct" --anatomy "$repository/config/anatomies/fork.yaml" --view fit --spacing 0.8 --out fork.vol \
  --clicks fork.yaml --quiet > log

click '0.9, 9.9, 0.6' beside.yaml
check 1 fork.vol beside.yaml 'trunk, click 1 \(line [0-9]+\) at \(0.9, 9.9, 0.6\) mm: lies in fat .*; the nearest lumen is at \('
click '0.0, 4.5, 0.6' wall.yaml
check 1 fork.vol wall.yaml 'trunk, click 1 .*(on the wall|soft tissue or the wall) .*; the nearest lumen is at \('
click '0.9, 90.9, 0.6' outside.yaml
check 1 fork.vol outside.yaml 'trunk, click 1 .* lies outside of the image, which extends from \(.*check the frame \(LPS or RAS\)'
sed 's/unit: 0.001/unit: 1/' fork.yaml > unit.yaml
check 1 fork.vol unit.yaml 'is no position in a patient; check the numbers and the unit|lies outside of the image'
[ ! -e result.obj ] || { echo "a refusal left a vessel"; failures=$((failures + 1)); }
echo kept > result.obj
check 1 fork.vol beside.yaml 'lies in fat'
[ "$(cat result.obj)" = kept ] || { echo "a refusal changed an earlier vessel"; failures=$((failures + 1)); }
check 1 fork.vol none.yaml 'none.yaml.*give a file of clicks'
check 1 fork.vol fork.yaml 'fork.vol: needs about 0.3. GB; raise --memory' --memory 0.1
check 1 fork.vol fork.yaml '\-\-open nowhere: matches no end; .*trunk near' --open nowhere


# clicks that are no course along a branch
trunk() { # trunk FILE CLICK...: one branch
  local IFS=,
  printf 'branches: [{name: trunk, clicks: [%s]}]\n' "${*:2}" > "$1"
}
trunk same.yaml '[0, 2, 20]' '[0, 2, 20]'
check 1 fork.vol same.yaml 'same.yaml: trunk: clicks 1 and 2 are at the same place; delete one'
for z in 20.3 21 22 23 25 28 30; do
  trunk close.yaml '[0, 2, 20]' "[0, 2, $z]"
  check 1 fork.vol close.yaml 'close.yaml: trunk: its clicks are only [0-9.]* mm apart in a lumen of [78].[0-9] mm; click near each end'
done
[ "$(cat result.obj)" = kept ] || { echo "close clicks changed an earlier vessel"; failures=$((failures + 1)); }
trunk ends.yaml '[0, 1, 5]' '[24, 0, 84]' '[-19, 5, 88]'
check 1 fork.vol ends.yaml 'trunk: the path turns back at click 2, which is an end of a branch; .*one branch per end .*SlicerVMTK'
trunk short.yaml '[12, 0, 70.2]' '[18.6, 0, 77.7]' # the wire of the scene needs 11 mm
check 1 fork.vol short.yaml 'result.obj: is not written, because no scene can use the vessel \(.*a longer stretch, or leave an end closed'
ls ./*.part.* 2> /dev/null && { echo "a refusal left these files"; failures=$((failures + 1)); }

if "$programs/volume_import" --help > /dev/null 2>&1; then
  /usr/bin/python3 "$repository/test/segmentation/altered_images.py" fork.vol .
  check 0 thick.mha fork.yaml 'warning: slices are 1.6.* mm apart: .*reconstruct slices of 1 mm or less' --modality ct
  check 0 metal.mha fork.yaml 'warning: trunk: metal at \(.*\) mm, .*streaks may displace the contour' --modality ct
  grep -q 'metal at' result_report.json || { echo "the report has no warning of metal"; failures=$((failures + 1)); }
  check 1 plain.mha fork.yaml 'no click lies in contrast, .* give the series with contrast agent' --modality ct
  check 1 nan.nrrd fork.yaml 'nan.nrrd: 1 values are not finite; replace them' --modality ct
  check 1 grey.mha fork.yaml 'grey values of 8 bit, which are no Hounsfield units; .*--modality other'
  check 1 fork.yaml fork.yaml 'fork.yaml: is no image that can be read|holds no image that can be read|no image'
  mkdir empty
  check 1 empty fork.yaml 'empty: holds no DICOM images; give a folder with a DICOM series'
fi
[ "$failures" -eq 0 ]
