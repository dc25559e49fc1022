#!/bin/bash
# Every tool that reads or writes a file names the file, the reason and a remedy when that fails, and ends with an error code.
# Runs beside other tests.
set -u
repository=$(cd "$(dirname "$0")/../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

check() { # check FILE REMEDY TOOL ARGUMENT...: the tool fails, and its message names the file and a remedy
  local file=$1 remedy=$2 output status=0
  shift 2
  output=$(timeout 60 "$programs/$@" 2>&1 >"${stdout:-/dev/null}") || status=$?
  [ "$status" -ge 1 ] && [ "$status" -le 3 ] && grep -qF -e "$file" <<< "$output" && grep -qE -e "$remedy" <<< "$output" &&
    ! grep -qE 'basic_|filesystem error|std::|what\(\)|vector::' <<< "$output" && return
  echo "expected an error that names '$file' and '$remedy' of: $*; exit code $status and:"
  echo "$output"
  failures=$((failures + 1))
}

scene=$repository/config/scenes/straight_wire.yaml
file=$work/file
echo 'no: [valid' > "$file"
: > "$work/empty"
mkdir "$work/folder"
missing=$work/missing

for bad in "$missing" "$file" "$work/empty" "$work/folder"; do
  check "$bad" 'give|line|file|require|expected' simulate "$bad" --out "$work/out"
  check "$bad" 'give|line|file|require|expected' scene_check "$bad"
  check "$bad" 'give|line|file|require|expected' procedure_study "$bad" --out "$work/out"
  check "$bad" 'give|file|damaged|bag' replay "$bad"
  check "$bad" 'give|file|damaged|bag' replay "$bad" --out "$work/made" --no-plots
  check "$bad" 'give|line|file|require|expected' scripted_recording "$bad" --out "$work/recorded"
  check "$bad" 'give|file|mesh' vessel_prepare "$bad" --unit 1 --out "$work/out.obj"
  check "$bad" 'give|file|state' simulate "$scene" --out "$work/out" --seconds 0.01 --no-plots --quiet --from-state "$bad"
done
for bad in "$missing" "$work/folder" "$file"; do
  check "$bad" 'give|line|name|file' instrument_shape "$bad.yaml" --out "$work/shape.csv"
done
# Meshes whose path lengths have no meaning, each with its fault; a sound one gives an image.
frame=(fluoroscopy_frame --materials "$repository/config/xray/materials.yaml" --pixels 64 --out "$work/frame.png" --mesh)
for fault in 'box_with_hole boundary edges .*vessel_prepare' 'box_flipped_face inconsistently oriented.*vessel_prepare' \
    'moebius boundary edges.*vessel_prepare' 'box_fin non-manifold.*vessel_prepare' 'two_boxes 2 separate components.*vessel_prepare'; do
  mesh=$repository/test/data/meshes/${fault%% *}.obj
  check "$mesh" "${fault#* }" "${frame[@]}" "$mesh"
done
[ ! -e "$work/frame.png" ] || { echo "an image of a faulty mesh was written"; failures=$((failures + 1)); }
for mesh in box_mm.obj box_inward.obj; do
  "$programs/${frame[0]}" "${frame[@]:1}" "$repository/test/data/meshes/$mesh" && [ -s "$work/frame.png" ] || { echo "no image of $mesh"; failures=$((failures + 1)); }
  rm -f "$work/frame.png"
done
for folder in "$file" "$file/below" /proc/none; do
  check "$folder" 'choose' simulate "$scene" --out "$folder" --seconds 0.01 --no-plots --quiet
done
check "$file" 'choose' benchmark accuracy --quick --out "$file"
check /dev/full 'free some space' simulate "$scene" --out "$work/out" --seconds 0.01 --no-plots --quiet --save-state /dev/full --at 0.01
stdout=/dev/full check 'standard output' 'free some space' scene_check "$scene"
[ "$failures" -eq 0 ]
