#!/bin/bash
# volume_import reads images of all formats, written without ITK, and refuses wrong ones. No installed program but
# volume_import loads ITK, and none loads FFTW, whose licence is the GPL.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"

/usr/bin/python3 "$repository/test/image/check_volume_import.py" "$programs/volume_import" "$folder"

for program in "$programs"/*; do
  libraries=$(ldd "$program" 2> /dev/null) || continue  # a script
  if grep -q fftw <<< "$libraries"; then
    echo "$program loads FFTW"
    exit 1
  fi
  case $(basename "$program") in volume_import | images_of_tests_by_itk) continue ;; esac # the second one belongs to the tests
  if grep -q libITK <<< "$libraries"; then
    echo "$program loads ITK"
    exit 1
  fi
done
