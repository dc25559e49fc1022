#!/bin/bash
# 300 mutated files each of NIfTI, NRRD and MetaImage end volume_import with exit code 0 and a complete volume, or 1 and a message; no reader
# crashes or takes 20 s. Another number and seed: FUZZ_IMAGES=2000 FUZZ_SEED=7 bash test/scripts/test_fuzz_of_images.sh
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
"$programs/volume_import" --help > /dev/null 2>&1 || { echo "without ITK: images are not read"; exit 0; }
/usr/bin/python3 "$repository/test/image/fuzz_images.py" "$programs/volume_import" "$folder" "${FUZZ_IMAGES:-300}" "${FUZZ_SEED:-1}"
