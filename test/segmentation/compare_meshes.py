"""Prints the largest distance [m] of equal vertices of two OBJ files: A B LIMIT [oblique]. Fails beyond the limit, and if the
numbers of vertices or the triangles differ. With `oblique`, B belongs to the patient of turned_images.py."""
import sys

import numpy

import turned_images


def read(path):
    with open(path) as file:
        lines = [line.split() for line in file]
    vertices = numpy.array([line[1:4] for line in lines if line and line[0] == "v"], float)
    return vertices, {tuple(sorted(line[1:])) for line in lines if line and line[0] == "f"}


(a, a_triangles), (b, b_triangles) = (read(path) for path in sys.argv[1:3])
if len(a) != len(b) or a_triangles != b_triangles:
    sys.exit("%d and %d vertices, or other triangles" % (len(a), len(b)))
if sys.argv[4:] == ["oblique"]:
    b = b @ turned_images.rotation()  # the inverse turn of row vectors
largest = numpy.linalg.norm(a - b, axis=1).max()
print("%s: %.3g m" % (sys.argv[2], largest))
sys.exit(0 if largest <= float(sys.argv[3]) else 1)
