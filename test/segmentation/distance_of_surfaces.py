"""Prints mean and 95 % distance [m] of the vertices of a binary STL file, in mm and turned by half a turn about z, from the surface of
an OBJ file (vertices, middles of edges and of triangles): OBJ STL LIMIT. Fails if the mean exceeds the limit."""
import sys

import numpy

with open(sys.argv[1]) as file:
    lines = [line.split() for line in file]
vertices = numpy.array([line[1:4] for line in lines if line and line[0] == "v"], float)
triangles = numpy.array([[k.split("/")[0] for k in line[1:4]] for line in lines if line and line[0] == "f"], int) - 1
a, b, c = (vertices[triangles[:, k]] for k in range(3))
surface = numpy.concatenate([vertices, (a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3])
with open(sys.argv[2], "rb") as file:
    content = file.read()
facet = numpy.dtype([("normal", "<3f4"), ("corners", "<9f4"), ("attribute", "<u2")])
corners = numpy.frombuffer(content[84:], facet, count=int.from_bytes(content[80:84], "little"))["corners"]
points = numpy.unique(corners.reshape(-1, 3), axis=0) * [-1e-3, -1e-3, 1e-3]
distance = numpy.array([numpy.sqrt(((surface - p) ** 2).sum(axis=1).min()) for p in points])
print("distance from %s: mean %.3g m, 95 %% %.3g m" % (sys.argv[2], distance.mean(), numpy.quantile(distance, 0.95)))
sys.exit(0 if distance.mean() <= float(sys.argv[3]) else 1)
