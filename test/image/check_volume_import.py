#!/usr/bin/env python3
"""Checks volume_import: PROGRAM FOLDER. Good files of all formats give the voxels at their places; wrong ones are refused
with file and remedy, and leave no output."""
import gzip
import os
import struct
import subprocess
import sys
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import image_files as files

PROGRAM, FOLDER = sys.argv[1:3]
failures = []


def run(name, path, *options):
    out = os.path.join(FOLDER, name + ".vol")
    result = subprocess.run(
        [PROGRAM, path, "--out", out, *options], capture_output=True, text=True, timeout=120, check=False
    )
    return out, result


def expect(name, condition, text):
    if not condition:
        failures.append("%s: %s" % (name, text))


def accept(name, path, *options, modality=1):
    out, result = run(name, path, *options)
    expect(name, result.returncode == 0, "refused: " + result.stderr)
    if result.returncode != 0:
        return
    places, found = files.read_volume(out)
    expect(name, found == modality, "modality %d" % found)
    expect(name, len(places) == len(files.values()), "%d different values" % len(places))
    for k in range(files.SIZE[2]):
        for j in range(files.SIZE[1]):
            for i in range(files.SIZE[0]):
                place = places.get(files.value(i, j, k))
                error = max(abs(a - b) for a, b in zip(place, files.position(i, j, k))) if place else 1e9
                if error > 1e-3:
                    expect(name, False, "voxel (%d, %d, %d) is %g mm from its place" % (i, j, k, error))
                    return
    with open(out, "rb") as file:
        content = file.read()
    expect(name, b"Doe" not in content and b"4711" not in content and b"1962" not in content, "the output names the patient")
    expect(name, "Doe" not in result.stdout + result.stderr, "a message names the patient")


def refuse(name, path, *words, options=()):
    out, result = run(name, path, *options)
    expect(name, result.returncode == 1, "exit code %d: %s" % (result.returncode, result.stderr))
    for word in (os.path.basename(path), *words):
        expect(name, word in result.stderr, "'%s' is missing in: %s" % (word, result.stderr))
    expect(name, not os.path.exists(out), "an output was written")


def here(name):
    return os.path.join(FOLDER, name)


# good files
files.write_series(here("series"))
accept("series", here("series"))
files.write_mha(here("a.mha"))
accept("mha", here("a.mha"))
files.write_nrrd(here("a.nrrd"))
accept("nrrd", here("a.nrrd"))
files.write_nrrd(here("ras.nrrd"), "right-anterior-superior")
accept("nrrd_ras", here("ras.nrrd"))
files.write_nifti(here("a.nii"))
accept("nifti", here("a.nii"))
files.write_nifti(here("scaled.nii"), slope=0.5, stored=[2 * v for v in files.values()])
accept("nifti_scaled", here("scaled.nii"))
accept("other", here("a.mha"), "--modality", "other", modality=2)

# two series in one folder
files.write_series(here("two"))
files.write_series(here("two"), series="1.2.3.5")
refuse("two_series", here("two"), "2 series", "--series")
accept("chosen_series", here("two"), "--series", "2")
refuse("no_such_series", here("two"), "--series must be one of them", options=("--series", "3"))

# wrong series
files.write_series(here("gap"), slices=(0, 1, 3, 4))
refuse("missing_slice", here("gap"), "slices are missing")
files.write_series(here("double"), slices=(0, 1, 2, 3, 4), heights=(0, 1, 1, 2, 3))
refuse("double_slice", here("double"), "is the place of", "image_", "a slice twice")
files.write_series(here("uneven"), heights=(0, 1, 2, 3, 4.2))
refuse("uneven_spacing", here("uneven"), "slices are 1.250 mm apart, but 1.500 mm between", "image_", "equal spacing")
files.write_series(here("tilt"), shift=(0.0, 0.4, 0.0))
refuse("tilt", here("tilt"), "gantry tilt")
files.write_series(here("one"), slices=(0,))
refuse("one_slice", here("one"), "two or more")
for tag, word in (
    ((0x0028, 0x0030), "PixelSpacing"),
    ((0x0020, 0x0032), "ImagePositionPatient"),
    ((0x0020, 0x0037), "ImageOrientationPatient"),
):
    files.write_series(here("without_" + word), without=(tag,))
    refuse("without_" + word, here("without_" + word), word, "is missing")
for tag, word in (((0x0028, 0x1053), "RescaleSlope"), ((0x0028, 0x1052), "RescaleIntercept")):
    files.write_series(here("without_" + word), without=(tag,))
    refuse("without_" + word, here("without_" + word), word, "image_", "is missing", "--modality ct")
files.write_series(here("bytes"), bits=8)
refuse("8_bit_series", here("bytes"), "8 bit", "--modality other")
os.makedirs(here("empty"), exist_ok=True)
refuse("empty_folder", here("empty"), "no DICOM")

# wrong files
refuse("none", here("none.nii"), "is no file")
files.write(here("text.nii"), b"no image")
refuse("text", here("text.nii"), "no image that can be read")
files.write_mha(here("no_spacing.mha"), {"ElementSpacing": None})
refuse("no_spacing", here("no_spacing.mha"), "ElementSpacing", "is missing")
files.write_mha(here("no_orientation.mha"), {"TransformMatrix": None})
refuse("no_orientation", here("no_orientation.mha"), "TransformMatrix", "is missing")
files.write_nrrd(here("no_space.nrrd"), None)
refuse("no_space", here("no_space.nrrd"), "space", "is missing")
files.write_nifti(here("no_form.nii"), oriented=False)
refuse("no_form", here("no_form.nii"), "qform or sform", "is missing")
files.write_mha(here("zero.mha"), {"ElementSpacing": "0.7 0 1.25"})
refuse("zero_spacing", here("zero.mha"), "spacing")
files.write_mha(here("sheared.mha"), {"TransformMatrix": "1 0 0 0.3 0.9 0 0 0 1"})
refuse("sheared", here("sheared.mha"), "orthogonal")
files.write_nifti(here("time.nii"), dimensions=(*files.SIZE, 2), stored=files.values() * 2)
refuse("time_series", here("time.nii"), "4 dimensions")
numbers = [float(v) for v in files.values()]
numbers[17] = float("nan")
files.write_nrrd(here("nan.nrrd"), data=struct.pack("<%df" % len(numbers), *numbers), kind="float")
refuse("nan", here("nan.nrrd"), "1 values are not finite")
files.write_mha(
    here("colours.mha"), {"ElementNumberOfChannels": "3"}, struct.pack("<%dh" % (3 * len(numbers)), *(files.values() * 3))
)
refuse("colours", here("colours.mha"), "3 values per voxel")
with open(here("a.mha"), "rb") as whole:
    files.write(here("short.mha"), whole.read()[:-100])
refuse("truncated", here("short.mha"), "fewer values")
packed = zlib.compress(struct.pack("<%dh" % len(numbers), *files.values()))
compressed = {"CompressedData": "True", "CompressedDataSize": str(len(packed))}
files.write_mha(here("compressed.mha"), compressed, packed)
accept("compressed", here("compressed.mha"))
files.write_mha(here("packed_short.mha"), compressed, packed[:-20])
refuse("truncated_compressed", here("packed_short.mha"), "fewer values")
for name, length in (("a.nrrd", 60), ("a.nii", 60)):
    with open(here(name), "rb") as whole:
        files.write(here("short_" + name), whole.read()[:-length])
    refuse("truncated_" + name, here("short_" + name), "export")
with open(here("a.nii"), "rb") as whole:
    content = whole.read()
files.write(here("a.nii.gz"), gzip.compress(content))
accept("nifti_gz", here("a.nii.gz"))
files.write(here("short.nii.gz"), gzip.compress(content)[:-30])
refuse("truncated_gz", here("short.nii.gz"), "fewer values")
with open(here("series/image_1.2.3.4_3"), "rb") as whole:
    content = whole.read()
files.write_series(here("short_series"))
files.write(here("short_series/image_1.2.3.4_3"), content[:-40])
refuse("truncated_series", here("short_series"), "export")
files.write_mha(here("positive.mha"), data=struct.pack("<%dh" % len(numbers), *(v + 1000 for v in files.values())))
refuse("unknown_modality", here("positive.mha"), "--modality")
grey = {"ElementType": "MET_UCHAR"}
files.write_mha(here("grey.mha"), grey, bytes(n % 256 for n in range(len(numbers))))
refuse("8_bit", here("grey.mha"), "8 bit", "--modality other")
refuse("8_bit_ct", here("grey.mha"), "8 bit", "--modality other", options=("--modality", "ct"))
out, result = run("8_bit_other", here("grey.mha"), "--modality", "other")
expect("8_bit_other", result.returncode == 0, result.stderr)
files.write_mha(here("large.mha"), {"DimSize": "4000 4000 4000"})
refuse("too_large", here("large.mha"), "needs 512000 MB", "the limit is 4000 MB", "--memory")
files.write_mha(here("huge.mha"), {"DimSize": "2000000000 2000000000 2"})
refuse("huge", here("huge.mha"), "voxels")

for failure in failures:
    print(failure)
print("%d failures" % len(failures))
sys.exit(1 if failures else 0)
