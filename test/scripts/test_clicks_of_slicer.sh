#!/bin/bash
# Lists of 3D Slicer become vessels: the ends of a tree as SlicerVMTK lists them, and names in any script in files and scenes.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"
"$programs/synthetic_ct" --anatomy "$repository/config/anatomies/fork.yaml" --view fit --spacing 0.8 --out fork.vol \
  --clicks fork.yaml --quiet > log

markups() { # markups FILE LABEL X,Y,Z...: a point list of 3D Slicer
  local point number=0
  {
    printf '{"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": ['
    for point in "${@:3}"; do
      number=$((number + 1))
      printf '%s{"label": "%s-%d", "position": [%s], "positionStatus": "defined"}' "$([ $number -eq 1 ] || echo ,)" "$2" $number "$point"
    done
    printf ']}]}\n'
  } > "$1"
}
segment() { # segment CLICKS OUT
  "$programs/vessel_segment" fork.vol --clicks "$1" --out "$2" --max-distance 0.0005 --quiet > log 2> warnings
}

markups ends.mrk.json Endpoints '0, 1, 5' '24, 0, 84' '-19, 5, 88'
segment ends.mrk.json ends.obj
grep -q 'genus 0, open ends: 3' log
grep -q 'Endpoints: click [23] is the end of a branch of its own, Endpoints_[23]' warnings

for name in 'Aorta ascendens – größe' '冠状動脈'; do
  markups "$name.mrk.json" F '0, 1, 5' '24, 0, 84'
  segment "$name.mrk.json" "$name.obj"
  branch=${name// /_}
  [ -f "${name}_$branch.png" ] && grep -q "\"name\": \"$branch\"" "${name}_report.json" && grep -q "name: \"$branch\"" "${name}_centreline.yaml"
  command=$(sed -n 's/^to use the vessel: rosrun endovascular_sim simulate //p' log)
  (cd "$repository" && eval "\"$programs/simulate\" $command --seconds 0.02 --no-plots --quiet --out \"$folder/run\"")
done
