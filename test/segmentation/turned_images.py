"""Writes a volume of synthetic_ct as images of other axes, without ITK: VOLUME CLICKS FOLDER.

permuted.mha: axes (k, -i, j) in place of (i, j, k); flipped.nrrd: i and k reversed; oblique.mha: the patient turned about an
oblique axis, with its clicks in oblique.yaml."""
import math
import os
import re
import sys

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
import image_files  # noqa: E402


def rotation():
    """Turn of the oblique patient by 25 degrees."""
    axis = numpy.array([1.0, 2.0, 3.0]) / math.sqrt(14.0)
    angle = math.radians(25.0)
    cross = numpy.cross(numpy.eye(3), axis)
    return numpy.eye(3) - math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def write(writer, path, values, spacing, origin, axes):
    """values[k, j, i]; axes: unit vectors of i, j and k."""
    image_files.SIZE = values.shape[::-1]
    image_files.SPACING, image_files.ORIGIN = tuple(spacing), tuple(origin)
    image_files.rotation = lambda: [list(axis) for axis in axes]
    writer(path, data=numpy.ascontiguousarray(values).tobytes())


def write_turned_clicks(clicks, path):
    def turned(match):
        point = rotation() @ [float(x) for x in match.group(1).split(",")]
        return "[%.12g, %.12g, %.12g]" % tuple(point)

    with open(clicks) as file:
        text = file.read()
    with open(path, "w") as file:
        file.write(re.sub(r"\[([-\d., e]+)\]", turned, text))


def main(volume, clicks, folder):
    with open(volume, "rb") as file:
        data = file.read()
    size = numpy.frombuffer(data, "<i4", 3, 8)
    spacing, origin = 1e3 * numpy.frombuffer(data, "<f8", 6, 24).reshape(2, 3)
    axes = numpy.eye(3)
    values = numpy.frombuffer(data, "<i2", int(numpy.prod(size)), 160).reshape(size[::-1])

    def place(name):
        return os.path.join(folder, name)

    last = (size - 1) * spacing
    # New i, j, k are the old k, -i, j: the new array is indexed by (j, -i, k).
    permuted = values[:, :, ::-1].transpose(1, 2, 0)
    write(image_files.write_mha, place("permuted.mha"), permuted, spacing[[2, 0, 1]], origin + [last[0], 0.0, 0.0],
          [axes[2], -axes[0], axes[1]])
    write(image_files.write_nrrd, place("flipped.nrrd"), values[::-1, :, ::-1], spacing,
          origin + [last[0], 0.0, last[2]], [-axes[0], axes[1], -axes[2]])
    turn = rotation()
    write(image_files.write_mha, place("oblique.mha"), values, spacing, turn @ origin, turn.T)
    write_turned_clicks(clicks, place("oblique.yaml"))


if __name__ == "__main__":
    main(*sys.argv[1:])
