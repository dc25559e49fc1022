#!/bin/bash
# `plots vessel` draws the output of vessel_prepare; without that output it names the missing file.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"
# An open pipe of 5 mm radius and 40 mm length, in millimetres.
awk 'BEGIN {
  for (j = 0; j <= 20; ++j) for (i = 0; i < 16; ++i)
    print "v", 5 * cos(6.2831853 * i / 16), 2 * j, 5 * sin(6.2831853 * i / 16)
  for (j = 0; j < 20; ++j) for (i = 0; i < 16; ++i)
    print "f", 16 * j + i + 1, 16 * j + 17 + i, 16 * j + 17 + (i + 1) % 16, 16 * j + (i + 1) % 16 + 1
}' > pipe.obj
message=$("$programs/plots" vessel pipe.obj vessel.obj --unit 0.001 --out vessel.png 2>&1) && exit 1
grep -q 'vessel_report.json' <<< "$message"
"$programs/vessel_prepare" pipe.obj --unit 0.001 --out vessel.obj --voxel 0.0005 --max-distance 0.0005 --open all --quiet
"$programs/plots" vessel pipe.obj vessel.obj --unit 0.001 --cut y=0.02 --out vessel.png
[ "$(head -c 4 vessel.png | tail -c 3)" = PNG ]
status=0
message=$("$programs/plots" vessel pipe.obj vessel.obj --cut w=1 --out vessel.png 2>&1) || status=$?
[ "$status" -eq 2 ]
grep -q 'y=0.495' <<< "$message"
