"""Writes a volume of synthetic_ct as images with a defect each, without ITK: VOLUME FOLDER.

thick.mha: slices twice as far apart; metal.mha: a cube of metal beside the trunk of fork.yaml; plain.mha: without contrast agent;
nan.nrrd: a value that is no number; grey.mha: 8 bit."""
import os
import sys

import numpy

import turned_images
from turned_images import image_files


def main(volume, folder):
    with open(volume, "rb") as file:
        data = file.read()
    size = numpy.frombuffer(data, "<i4", 3, 8)
    spacing, origin = 1e3 * numpy.frombuffer(data, "<f8", 6, 24).reshape(2, 3)
    values = numpy.frombuffer(data, "<i2", int(numpy.prod(size)), 160).reshape(size[::-1])

    def write(name, array, writer=image_files.write_mha, step=1, **options):
        turned_images.write(lambda path, data: writer(path, data=data, **options), os.path.join(folder, name), array,
                            spacing * [1, 1, step], origin, numpy.eye(3))

    write("thick.mha", values[::2], step=2)
    write("plain.mha", numpy.minimum(values, 60))
    metal = values.copy()
    i, j, k = numpy.rint(([12.0, 4.0, 15.0] - origin) / spacing).astype(int)  # 8 mm beside the wall of the trunk
    metal[k : k + 3, j : j + 3, i : i + 3] = 3071
    write("metal.mha", metal)
    broken = values.astype("<f4")
    broken[5, 5, 5] = numpy.nan
    write("nan.nrrd", broken, image_files.write_nrrd, kind="float")
    grey = numpy.clip((values + 150) / 3, 0, 255).astype("u1")
    write("grey.mha", grey, header={"ElementType": "MET_UCHAR"})


main(*sys.argv[1:])
