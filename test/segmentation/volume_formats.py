"""Writes a volume of synthetic_ct with axis-aligned voxels as DICOM series, NIfTI, NRRD and MetaImage, without ITK."""
import os
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
import image_files  # noqa: E402


def main(volume, folder):
    with open(volume, "rb") as file:
        data = file.read()
    size = struct.unpack_from("<3i", data, 8)
    spacing = [1e3 * s for s in struct.unpack_from("<3d", data, 24)]
    origin = [1e3 * s for s in struct.unpack_from("<3d", data, 48)]
    axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    image_files.SIZE, image_files.SPACING, image_files.ORIGIN = size, spacing, origin
    image_files.rotation = lambda: axes
    stored = data[160:]
    image_files.write_mha(os.path.join(folder, "image.mha"), data=stored)
    image_files.write_nrrd(os.path.join(folder, "image.nrrd"), data=stored)
    numbers = struct.unpack("<%dh" % (len(stored) // 2), stored)
    image_files.write_nifti(os.path.join(folder, "image.nii"), dimensions=size, stored=numbers)
    series = os.path.join(folder, "dicom")
    os.makedirs(series)
    count = size[0] * size[1]
    for k in range(size[2]):
        pixels = [n + 1024 for n in numbers[k * count : (k + 1) * count]]
        place = [origin[0], origin[1], origin[2] + k * spacing[2]]
        with open(os.path.join(series, "%d.dcm" % ((7 * k) % 1009)), "wb") as file:
            file.write(image_files.slice_file(k, place, axes, size=size, pixels=pixels))


main(*sys.argv[1:])
