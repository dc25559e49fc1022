#!/bin/bash
# vessel_segment makes the same mesh from the same grid in every image format, of three writers (own, ITK, pydicom), with any
# number of threads, and for permuted, flipped and oblique axes.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
cd "$folder"

segment() { # segment IMAGES CLICKS OUT OPTION...
  "$programs/vessel_segment" "$1" --clicks "$2" --out "$3" --max-distance 0.0005 "${@:4}" > log 2>&1 || { cat log; exit 1; }
}
compare() { # compare OBJ LIMIT [oblique]
  /usr/bin/python3 "$repository/test/segmentation/compare_meshes.py" one.obj "$@" || { echo "$1 is another vessel"; exit 1; }
}

"$programs/synthetic_ct" --anatomy "$repository/config/anatomies/fork.yaml" --view fit --spacing 0.8 --out fork.vol \
  --clicks fork.yaml --quiet > log
segment fork.vol fork.yaml one.obj --threads 1
segment fork.vol fork.yaml two.obj --threads 1
segment fork.vol fork.yaml four.obj --threads 4
for result in two four; do
  cmp one.obj $result.obj
  cmp <(grep -v '^name:' one_centreline.yaml) <(grep -v '^name:' ${result}_centreline.yaml)
  cmp one_report.json ${result}_report.json
  for view in one_*.png; do cmp "$view" "$result${view#one}"; done
done

"$programs/volume_import" --help > /dev/null 2>&1 || { echo "without ITK: formats are not tested"; exit 0; }
/usr/bin/python3 "$repository/test/segmentation/volume_formats.py" fork.vol .
/usr/bin/python3 "$repository/test/segmentation/series_by_pydicom.py" fork.vol pydicom
mkdir itk
"$programs/images_of_tests_by_itk" fork.vol itk
for images in dicom image.nii image.nrrd image.mha pydicom itk/series itk/image.nii.gz; do
  case $images in dicom | pydicom | itk/series) modality=() ;; *) modality=(--modality ct) ;; esac
  segment "$images" fork.yaml other.obj "${modality[@]}"
  compare other.obj 1e-6
done

/usr/bin/python3 "$repository/test/segmentation/turned_images.py" fork.vol fork.yaml .
segment permuted.mha fork.yaml permuted.obj --modality ct
compare permuted.obj 1e-6
segment flipped.nrrd fork.yaml flipped.obj --modality ct
compare flipped.obj 1e-6
segment oblique.mha oblique.yaml oblique.obj --modality ct
compare oblique.obj 2e-5 oblique
