"""Writes label maps of one fork of vessels in several formats and types, and images that are no label maps: FOLDER.

Label 52 is a trunk of 12 mm, 65 and 66 are its branches of 8 and 6 mm, 7 is another organ; voxels of 1 x 1 x 1.5 mm. The trunk
enters at the lower border, the branches end within the image."""
import os
import sys

import numpy

import turned_images
from turned_images import image_files

SIZE, SPACING, ORIGIN = (64, 48, 60), numpy.array([1.0, 1.0, 1.5]), numpy.array([-31.0, 12.0, 400.0])
FORK = numpy.array([0.0, 36.0, 440.0])
TUBES = {52: (numpy.array([1.0, 35.0, 390.0]), FORK, 6.0), 65: (FORK, numpy.array([16.0, 38.0, 474.0]), 4.0),
         66: (FORK, numpy.array([-20.0, 33.0, 472.0]), 3.0)}


def labels():
    """Label map [k, j, i]."""
    k, j, i = numpy.meshgrid(*(numpy.arange(n) for n in SIZE[::-1]), indexing="ij")
    points = numpy.stack([i, j, k], -1) * SPACING + ORIGIN
    found = numpy.zeros(SIZE[::-1], int)
    found[:, 38:46, :] = 7
    best = numpy.zeros(found.shape)
    for label, (begin, end, radius) in TUBES.items():
        step = end - begin
        t = numpy.clip((points - begin) @ step / (step @ step), 0.0, 1.0)
        distance = numpy.linalg.norm(points - begin - t[..., None] * step, axis=-1) - radius
        inside = distance < best
        found[inside] = label
        best[inside] = distance[inside]
    return found


def main(folder):
    def place(name):
        return os.path.join(folder, name)

    axes = numpy.eye(3)
    last = (numpy.array(SIZE) - 1) * SPACING
    found = labels()

    def nifti(name, values, kind):
        image_files.SIZE, image_files.SPACING, image_files.ORIGIN = SIZE, tuple(SPACING), tuple(ORIGIN)
        image_files.rotation = lambda: [list(axis) for axis in axes]
        image_files.write_nifti(place(name), dimensions=SIZE, stored=values.ravel().tolist(), kind=kind)

    for name, kind in (("uint8", "B"), ("int16", "h"), ("int32", "i"), ("float32", "f"), ("float64", "d")):
        nifti(name + ".nii", found, kind)
    nifti("large.nii", numpy.where(found == 52, 1000052, found), "i")
    nifti("mask.nii", (found == 52).astype(int), "B")
    short = found.astype("<i2")
    turned_images.write(image_files.write_mha, place("permuted.mha"), short[:, :, ::-1].transpose(1, 2, 0),
                        SPACING[[2, 0, 1]], ORIGIN + [last[0], 0.0, 0.0], [axes[2], -axes[0], axes[1]])
    turned_images.write(image_files.write_nrrd, place("flipped.nrrd"), short[::-1, :, ::-1], SPACING,
                        ORIGIN + [last[0], 0.0, last[2]], [-axes[0], axes[1], -axes[2]])
    # Grey images: of 8 bit, and one of few values.
    random = numpy.random.default_rng(1)
    nifti("grey.nii", numpy.clip(found * 3 + random.normal(30, 12, found.shape), 0, 255).astype(int), "B")
    nifti("coarse_grey.nii", numpy.clip((found > 0) * 5 + random.normal(5, 2, found.shape), 0, 15).astype(int), "B")
    nifti("blurred.nii", (found == 52) * 0.7, "f")


main(*sys.argv[1:])
