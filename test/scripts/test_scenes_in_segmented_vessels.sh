#!/bin/bash
# The vessels of a synthetic MR angiogram (aortic bifurcation) and CT angiogram (coronary arteries) run the scene mesh: the mesh,
# the mesh with its centreline and a lesion on a named branch, and the smooth vessel of the centreline file. In the last two blood flows. No node leaves them, no surface is more than 0.1 mm beyond the wall.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"

run() { # run NAME OPTION...: mesh.yaml with these options
  "$programs/simulate" "$repository/config/scenes/mesh.yaml" --out "$1" --no-plots --quiet "${@:2}"
  /usr/bin/python3 - "$@" <<'PYTHON'
import json, sys
result = json.load(open(sys.argv[1] + "/result.json"))
outside, beyond = result["nodes_outside"], result["worst_surface_penetration"]
print("%s: %d nodes outside, %.4f mm beyond the wall, %.0f mm inserted" % (
    sys.argv[1], outside, 1e3 * beyond, 1e3 * result["inserted_length"]))
flows = len(sys.argv) > 2 and "flow=adult" in sys.argv[2:]
pressure = json.load(open(sys.argv[1] + "/metrics.json")).get("pressure")
if flows:
    print("  mean pressure %.0f Pa, Pd/Pa %.3f" % (pressure["mean_pressure_last"], pressure["lesions"][0]["pd_pa_after"]))
    assert abs(pressure["mean_pressure_last"] / 12400 - 1) < 0.05, pressure
    assert 0.8 < pressure["lesions"][0]["pd_pa_after"] < 1.01, pressure
assert flows == (pressure is not None)
sys.exit(0 if outside == 0 and beyond <= 1e-4 else 1)
PYTHON
}
scenes() { # scenes NAME LESION OPTION...: the mesh, also with a lesion on a named branch, and the vessel of the centreline
  run "$1_mesh" --set vessel.mesh="$folder/$1.obj" --set vessel.unit=1 "${@:3}"
  run "$1_named" --set vessel.mesh="$folder/$1.obj" --set vessel.unit=1 --set vessel.centreline="$folder/$1_centreline.yaml" \
    --set vessel.lesions="[{$2, length: 0.012, grade: 0.5}]" --set flow=adult "${@:3}"
  run "$1_centreline" --set vessel.mesh=null --set vessel.unit=null --set vessel.repair=null --set vessel.rotation=null \
    --set vessel.translation=null --set vessel.anatomy="$folder/$1_centreline.yaml" \
    --set vessel.lesions="[{$2, length: 0.012, grade: 0.5}]" --set flow=adult "${@:3}"
}

"$programs/synthetic_ct" --mr --view abdomen --out mr.vol --clicks mr.yaml --quiet > log
"$programs/vessel_segment" mr.vol --clicks mr.yaml --out mr.obj --max-distance 0.0005 --quiet > log
grep -q 'genus 0, open ends: 3' log
scenes mr "branch: right_external_iliac, fraction: 0.8" --seconds 4 --set drive.travel=0.16 --set drive.speed=0.06

"$programs/synthetic_ct" --spacing 0.6 --out ct.vol --clicks ct.yaml --branch ascending_aorta --branch left_main \
  --branch left_anterior_descending --branch left_circumflex --quiet > log
"$programs/vessel_segment" ct.vol --clicks ct.yaml --out ct.obj --quiet > log
grep -q 'genus 0, open ends: 4' log
scenes ct "branch: left_circumflex, fraction: 0.5" --seconds 3 --set drive.travel=0.06 --set entry.position='[0, 0, 1]'
