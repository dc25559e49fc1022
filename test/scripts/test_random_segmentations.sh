#!/bin/bash
# 20 random synthetic CTs with good and wrong clicks: vessel_segment refuses with a message, or makes a vessel that `simulate` runs. 200 with
# another seed and the table: RANDOM_SEGMENTATIONS=200 SEED=7 bash test/scripts/test_random_segmentations.sh
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
"$programs/volume_import" --help > /dev/null 2>&1 || { echo "without ITK: images are not read"; exit 0; }
/usr/bin/python3 "$repository/test/segmentation/random_segmentations.py" "$programs" "$folder" "${RANDOM_SEGMENTATIONS:-20}" "${SEED:-1}"
