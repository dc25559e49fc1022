#!/bin/bash
# The page for clicks judges and saves clicks in a browser; vessel_segment makes a vessel of the saved file.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
command -v chromium > /dev/null || { echo "without Chromium: the page is not used"; exit 0; }
cd "$folder"
"$programs/synthetic_ct" --anatomy "$repository/config/anatomies/fork.yaml" --view fit --spacing 0.8 --out fork.vol \
  --clicks fork.yaml --quiet > log
"$programs/vessel_segment" fork.vol --page page.html --quiet > log
/usr/bin/python3 "$repository/test/segmentation/view/use_page.py" page.html > clicks.yaml || { cat clicks.yaml; exit 1; }
grep -q 'name: "größe"' clicks.yaml && grep -q 'largest_radius: 9' clicks.yaml
"$programs/vessel_segment" fork.vol --clicks clicks.yaml --out vessel.obj --max-distance 0.0005 --quiet > log
grep -q 'genus 0, open ends: 2' log && [ -f vessel_größe.png ]
