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
    expect(name, result.returncode >= 0 and "signal" not in result.stderr, "ended by a signal: " + result.stderr)
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

# NIfTI: units, types, byte orders, both forms
files.write_nifti(here("metres.nii"), unit=1, scale=1e-3)
accept("metres", here("metres.nii"))
files.write_nifti(here("micrometres.nii"), unit=3, scale=1e3)
accept("micrometres", here("micrometres.nii"))
in_ras = [-files.ORIGIN[0], -files.ORIGIN[1], files.ORIGIN[2]]
files.write_nifti(here("metres_of_qform.nii"), oriented=False, qform=in_ras, unit=1, scale=1e-3)
accept("metres_of_qform", here("metres_of_qform.nii"))
files.write_nifti(here("both_forms.nii"), qform=[n + 0.3 for n in in_ras[:1]] + in_ras[1:])
accept("both_forms", here("both_forms.nii"))  # less than half a voxel apart
files.write_nifti(here("big_endian.nii"), qform=in_ras, order=">", kind="f")
accept("big_endian", here("big_endian.nii"))
for kind in "iqd":
    files.write_nifti(here("kind.nii"), kind=kind)
    accept("nifti_kind_" + kind, here("kind.nii"))
files.write_nifti(here("unsigned.nii"), kind="H", stored=[v + 1024 for v in files.values()], intercept=-1024.0)
accept("nifti_unsigned", here("unsigned.nii"))
files.write_nifti(here("no_scaling.nii"), slope=float("nan"))
accept("nifti_no_scaling", here("no_scaling.nii"))
files.write_nifti(here("4d_of_one.nii"), dimensions=(*files.SIZE, 1))
accept("nifti_4d_of_one", here("4d_of_one.nii"))

# units of the other formats, which ITK ignores
files.write_nrrd(here("mm.nrrd"), units="mm")
accept("nrrd_mm", here("mm.nrrd"))
files.write_nrrd(here("cm.nrrd"), units="cm")
refuse("nrrd_cm", here("cm.nrrd"), "space units", '"cm"', "millimetres")
files.write_mha(here("mm.mha"), {"DistanceUnits": "mm"})
accept("meta_mm", here("mm.mha"))
files.write_mha(here("cm.mha"), {"DistanceUnits": "cm"})
refuse("meta_cm", here("cm.mha"), "DistanceUnits", "cm", "millimetres")

# NIfTI whose place in the patient is wrong or unknown
files.write_nifti(here("shear.nii"), rows=files.nifti_rows(shear=0.4), qform=in_ras)
refuse("shear", here("shear.nii"), "sform", "gantry tilt or shear of 17.7", "resample")
with open(here("shear.nii"), "rb") as whole:
    files.write(here("shear.nii.gz"), gzip.compress(whole.read()))
refuse("shear_gz", here("shear.nii.gz"), "sform", "resample")
files.write_nifti(here("forms_apart.nii"), qform=[in_ras[0] + 0.5, *in_ras[1:]])
refuse("forms_apart", here("forms_apart.nii"), "qform and sform", "0.5 mm apart")
mirrored = [[-n for n in files.nifti_rows()[0]]] + files.nifti_rows()[1:]
files.write_nifti(here("mirrored.nii"), rows=mirrored, qform=in_ras)
refuse("mirrored", here("mirrored.nii"), "qform and sform", "mm apart")
for place, number in ((3, 1.7e38), (3, float("nan")), (0, 1.7e38), (0, float("nan")), (2, float("-inf"))):
    rows = files.nifti_rows()
    rows[1][place] = number
    name = "form_%d_%g" % (place, number)
    files.write_nifti(here(name + ".nii"), rows=rows)
    refuse(name, here(name + ".nii"), "", options=("--time", "10"))
files.write_nifti(here("unit.nii"), unit=7)
refuse("unit", here("unit.nii"), "xyzt_units", "millimetres")
for name, number in (("nan", float("nan")), ("inf", float("-inf"))):
    files.write_nifti(here(name + ".nii"), kind="f", stored=[number, *files.values()[1:]])
    refuse("nifti_" + name, here(name + ".nii"), "1 values are not finite")
    with open(here(name + ".nii"), "rb") as whole:
        files.write(here(name + ".nii.gz"), gzip.compress(whole.read()))
    refuse("nifti_gz_" + name, here(name + ".nii.gz"), "1 values are not finite")
files.write_nifti(here("padded.nii"), kind="f", stored=[1e30, *files.values()[1:]])
refuse("padded", here("padded.nii"), "1e+30", "replace")
refuse("padded_other", here("padded.nii"), "1e+30", options=("--modality", "other"))
files.write_nifti(here("above.nii"), kind="f", stored=[40000.0, *files.values()[1:]])
refuse("above", here("above.nii"), "40000", "no Hounsfield units")

# MetaImage with its values in other files, as MetaIO reads them
raw = struct.pack("<%dh" % len(files.values()), *files.values())
part = len(raw) // files.SIZE[2]
os.makedirs(here("slices"), exist_ok=True)
for k in range(files.SIZE[2]):
    files.write(here("slices/s%02d.raw" % k), raw[k * part : (k + 1) * part])
files.write(here("patient 1 gefäß.raw"), raw)
names = ["slices/s%02d.raw" % k for k in range(files.SIZE[2])]
for name, data_file in (("name_with_blanks", "patient 1 gefäß.raw"), ("list", "LIST\n" + "\n".join(names)),
                        ("pattern", "slices/s%02d.raw 0 4 1")):
    files.write_mha(here(name + ".mhd"), data=b"", data_file=data_file)
    accept(name, here(name + ".mhd"))
files.write_mha(here("equals.mha"), equals="=")
accept("no_blanks_at_equals", here("equals.mha"))
files.write_mha(here("text.mha"), {"BinaryData": "False"}, " ".join(str(v) for v in files.values()).encode())
accept("values_as_text", here("text.mha"))
files.write_mha(here("short_text.mha"), {"BinaryData": "False"}, " ".join(str(v) for v in files.values()[1:]).encode())
refuse("values_as_text_missing", here("short_text.mha"), "fewer values")
files.write(here("cut.raw"), raw[:-2])
files.write_mha(here("cut.mhd"), data=b"", data_file="cut.raw")
refuse("cut_raw", here("cut.mhd"), "fewer values")
files.write(here("slices/short.raw"), raw[: part - 2])
files.write_mha(here("short_list.mhd"), data=b"", data_file="LIST\n" + "\n".join([*names[:4], "slices/short.raw"]))
refuse("short_list", here("short_list.mhd"), "fewer values")
files.write_mha(here("list_of_4.mhd"), data=b"", data_file="LIST\n" + "\n".join(names[:4]))
refuse("list_of_4", here("list_of_4.mhd"), "ElementDataFile", "4 files for 5 slices")
for pattern in ("s%s.raw 0 4 1", "s%n%d.raw 0 4 1", "s%02d.raw"):
    files.write_mha(here("pattern_of_words.mhd"), data=b"", data_file=pattern)
    refuse("pattern_of_words", here("pattern_of_words.mhd"), "ElementDataFile", "pattern")
packed = zlib.compress(raw)
files.write(here("packed.zraw"), packed)
for name, header in (("zraw", {}), ("zraw_with_size", {"CompressedDataSize": str(len(packed))})):
    files.write_mha(here(name + ".mhd"), {"CompressedData": "True", **header}, b"", data_file="packed.zraw")
    accept(name, here(name + ".mhd"))
files.write_mha(here("without_size.mha"), {"CompressedData": "True"}, packed)
refuse("packed_without_size", here("without_size.mha"), "CompressedDataSize", "is missing")
files.write_mha(here("wrong_size.mha"), {"CompressedData": "True", "CompressedDataSize": str(len(packed) - 20)}, packed)
refuse("packed_wrong_size", here("wrong_size.mha"), "fewer values")
damaged = packed[:60] + bytes(255 - b for b in packed[60:70]) + packed[70:]
files.write_mha(here("packed_damaged.mha"), {"CompressedData": "True", "CompressedDataSize": str(len(packed))}, damaged)
refuse("packed_damaged", here("packed_damaged.mha"), "export the images again")

# label maps
inside = [(i - 3) ** 2 + (j - 3) ** 2 < 5 for k in range(files.SIZE[2]) for j in range(files.SIZE[1]) for i in range(files.SIZE[0])]
layers = [n // (files.SIZE[0] * files.SIZE[1]) for n in range(len(inside))]
for name, kind, stored in (("mask", "B", [int(x) for x in inside]), ("mask_255", "B", [255 * int(x) for x in inside]),
                           ("labels", "i", [(5 + layer // 2 * 20) * int(x) for x, layer in zip(inside, layers)]),
                           ("float_mask", "f", [float(x) for x in inside])):
    files.write_nifti(here(name + ".nii"), kind=kind, stored=stored)
    for modality in ((), ("--modality", "ct"), ("--modality", "other")):
        refuse(name, here(name + ".nii"), "is a label map", "it holds the label(s)", "vessel_segment --label N", options=modality)
        expect(name, "16 bit" not in run(name, here(name + ".nii"), *modality)[1].stderr, "advice on 16 bit")

# a CT that is stored without its intercept: air at 0, tissue at 1064, a vessel of 1374
ct = [(0, 1, 2, 1063, 1064, 1065, 1374)[n % 7] for n in range(len(inside))]
files.write_nifti(here("raised.nii"), kind="H", stored=ct)
for modality in ((), ("--modality", "ct")):
    refuse("raised", here("raised.nii"), "raised by 1024: air at 1, tissue at 1064", "--subtract 1024", options=modality)
out, result = run("lowered", here("raised.nii"), "--subtract", "1024")
expect("lowered", result.returncode == 0, result.stderr)
if result.returncode == 0:
    expect("lowered", sorted(files.read_volume(out)[0]) == [-1024, -1023, -1022, 39, 40, 41, 350], "other values")
out, result = run("raised_other", here("raised.nii"), "--modality", "other")
expect("raised_other", result.returncode == 0, result.stderr)
files.write_nifti(here("window.nii"), stored=[min(max(v - 1024, -200), 300) for v in ct])
out, result = run("window", here("window.nii"), "--modality", "ct")
expect("window", result.returncode == 0, result.stderr)
files.write_series(here("without_rescale"), without=((0x0028, 0x1052), (0x0028, 0x1053)), slices=(0, 1, 2), pixels=ct[:42])
refuse("without_rescale", here("without_rescale"), "RescaleSlope", "image_")
refuse("without_rescale_ct", here("without_rescale"), "raised by 1024", "--subtract 1024", options=("--modality", "ct"))

# DICOM as discs, scanners and exports hold it: one line names the cause
def cause(name, path, *words):
    refuse(name, path, *words)
    lines = run(name, path)[1].stderr.strip().splitlines()
    expect(name, len(lines) == 1, "%d lines: %s" % (len(lines), lines[:3]))


files.write_series(here("disc/DICOM/PAT0/SER0"))
files.write(here("disc/AUTORUN.INF"), b"[autorun]")
cause("disc", here("disc"), "folders below", "disc/DICOM/PAT0/SER0")
accept("series_of_a_disc", here("disc/DICOM/PAT0/SER0"))
files.write_series(here("phases"))
files.write_series(here("phases"), instances=100)
cause("two_phases", here("phases"), "is the place of", "a slice twice or two series")
cause("one_slice_of_a_series", here("phases/image_1.2.3.4_3"), "is one slice of a DICOM series; give its folder")
os.makedirs(here("enhanced"), exist_ok=True)
frames = [v + 1024 for v in files.values()]
files.write(here("enhanced/volume.dcm"),
            files.slice_file(0, files.ORIGIN, files.rotation(), pixels=frames, frames=files.SIZE[2],
                             without=((0x0028, 0x0030), (0x0020, 0x0032), (0x0020, 0x0037))))
for path in ("enhanced", "enhanced/volume.dcm"):
    cause("enhanced", here(path), "one file with 5 frames (enhanced CT", "dcm2niix")

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
files.write_series(here("zero_pixels"), spacing=(0.0, 0.7))
refuse("zero_pixels", here("zero_pixels"), "PixelSpacing", "image_", "greater than 0")
files.write_series(here("word_pixels"), spacing="0.9")
refuse("word_pixels", here("word_pixels"), "PixelSpacing", "2 numbers")
for turn in (6.0, 0.5):
    files.write_series(here("turned_%g" % turn), turned=(2, turn))
    refuse("turned_%g" % turn, here("turned_%g" % turn), "ImageOrientationPatient", "image_", "differs from that of")
files.write_series(here("skewed"), turned=(2, 6.0), skewed=True)
refuse("skewed", here("skewed"), "ImageOrientationPatient", "image_", "perpendicular")
files.write_series(here("scaled_axes"), axis_scale=0.5)
refuse("scaled_axes", here("scaled_axes"), "ImageOrientationPatient", "unit vectors")
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
