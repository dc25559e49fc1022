#!/bin/bash
# Label maps of all types, formats and axes give the same vessel with named branches, which the scene mesh accepts: no node of a
# wire leaves it. Without --label they are refused with the labels that they hold; grey images are no label maps.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"
failures=0

"$programs/volume_import" --help > /dev/null 2>&1 || { echo "skipped: built without ITK"; exit 77; }
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$repository/test/segmentation/label_maps.py" .
cat > names.csv <<'CSV'
id,name
52,aorta
65,iliac artery left
66,iliac_artery_right
CSV

fail() {
  echo "$1"
  failures=$((failures + 1))
}
segment() { # segment MAP OUT OPTION...
  "$programs/vessel_segment" "$1" --out "$2" --quiet "${@:3}" > log 2>&1 || { cat log; exit 1; }
}
check() { # check STATUS PATTERN ARGUMENT...: the exit code, and a message that matches the pattern
  local status=0
  "$programs/vessel_segment" "${@:3}" --out refused.obj --quiet > output 2>&1 || status=$?
  [ "$status" -eq "$1" ] && grep -qE -e "$2" output && return
  cat output
  fail "wanted exit code $1 and '$2', got $status"
}
compare() { # compare OBJ LIMIT
  PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$repository/test/segmentation/compare_meshes.py" one.obj "$@" ||
    fail "$1 is another vessel"
}

labels=(--label 52 --label 65 --label 66 --names names.csv)
segment uint8.nii one.obj "${labels[@]}"
cat log
grep -q 'genus 0, open ends: 1' log || fail "the end at the border is not open, or others are"
for name in aorta iliac_artery_left iliac_artery_right; do
  grep -Eq "name: \"?$name\"?\$" one_centreline.yaml || fail "no branch $name"
done
/usr/bin/python3 - <<'PYTHON' || fail "the report is wrong"
import json
report = json.load(open("one_report.json"))
diameters = {branch["name"]: branch["sections"]["diameter"] for branch in report["branches"]}
for name, diameter in (("aorta", 12), ("iliac_artery_left", 8), ("iliac_artery_right", 6)):
    found = sorted(diameters[name])[len(diameters[name]) // 2]
    print("%s: %.2f mm" % (name, 1e3 * found))
    assert abs(1e3 * found - diameter) < 0.4, name
assert report["genus"] == 0 and report["open_ends"][0]["at_border"]
PYTHON
[ -e one.vol ] || [ -e one.part.vol ] && fail "a volume of labels is left"

for map in int16.nii int32.nii float32.nii float64.nii; do
  segment $map other.obj "${labels[@]}"
  cmp one.obj other.obj || fail "$map is another vessel"
done
for map in permuted.mha flipped.nrrd; do
  segment $map other.obj "${labels[@]}"
  compare other.obj 1e-6
done
segment large.nii other.obj --label 1000052 --label 65 --label 66
cmp one.obj other.obj || fail "large labels give another vessel"

# all ends, by clicks in RAS
segment uint8.nii open.obj --label aorta --label iliac_artery_left --label iliac_artery_right --names names.csv --open all
grep -q 'open ends: 3' log || fail "--open all does not open all ends"
printf 'frame: RAS\nbranches: [{name: ends, clicks: [[-15, -38, 472], [19, -33, 470]]}]\n' > ends.yaml
segment uint8.nii clicked.obj "${labels[@]}" --clicks ends.yaml
cmp open.obj clicked.obj || fail "clicks open other ends"
"$programs/simulate" "$repository/config/scenes/mesh.yaml" --set vessel.mesh="$folder/open.obj" --set vessel.unit=1 \
  --set vessel.centreline="$folder/open_centreline.yaml" --set entry.position='[0.001, 0.035, 0.4]' \
  --out run --no-plots --quiet > /dev/null
/usr/bin/python3 -c '
import json, sys
result = json.load(open("run/result.json"))
print("%d nodes outside, %.4f mm beyond the wall" % (result["nodes_outside"], 1e3 * result["worst_surface_penetration"]))
sys.exit(0 if result["nodes_outside"] == 0 else 1)' || fail "the wire leaves the vessel"

check 1 'is a label map, not an image: it holds the label\(s\) 7, 52, 65, 66; .*vessel_segment --label N' int32.nii --clicks ends.yaml
check 1 'it holds the label\(s\) 1; ' mask.nii --clicks ends.yaml --modality other
check 1 '\-\-label: is 99, but the label map holds 7, 52, 65, 66' int32.nii --label 99
check 1 'requires a label map, but this image has values that are no whole numbers' blurred.nii --label 1
check 1 'names require a table, --names' int32.nii --label aorta
check 1 'names.csv: aorto: is no name of a label; did you mean "aorta"' int32.nii --label aorto --names names.csv
check 2 'names requires --label' int32.nii --names names.csv --clicks ends.yaml
for grey in grey.nii coarse_grey.nii; do
  "$programs/volume_import" $grey --modality other --out grey.vol > output 2>&1 || { cat output; fail "$grey is refused"; }
done
ls ./*.part.* 2> /dev/null && fail "these files are left"
exit $((failures > 0))
