"""Surfaces of files, for drawing."""

import numpy as np

from .command import Failure


def read_obj(path):
    """Vertices and triangles of an OBJ file; polygons become fans of triangles."""
    vertices, triangles = [], []
    with open(path, encoding="utf-8") as stream:
        for line in stream:
            if line.startswith("v "):
                vertices.append([float(word) for word in line.split()[1:4]])
            elif line.startswith("f "):
                corners = [int(word.split("/")[0]) for word in line.split()[1:]]
                corners = [c - 1 if c > 0 else len(vertices) + c for c in corners]
                triangles += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
    if not triangles:
        raise Failure("%s: no triangles; use OBJ or binary STL" % path)
    return np.array(vertices), np.array(triangles)


def read_corners(path):
    """Corners of the triangles of an OBJ or binary STL file, triangles × corners × axes."""
    if str(path).lower().endswith(".stl"):
        return _read_stl(path)
    vertices, triangles = read_obj(path)
    return vertices[triangles]


def vertex_normals(vertices, faces):
    """Outward unit normals at the vertices, weighted by the areas of the triangles."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    summed = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(summed, faces[:, k], normals)
    return summed / np.maximum(np.linalg.norm(summed, axis=1, keepdims=True), 1e-30)


def _read_stl(path):
    with open(path, "rb") as stream:
        data = stream.read()
    count = int.from_bytes(data[80:84], "little")
    if len(data) != 84 + 50 * count:
        raise Failure("%s: not a binary STL file; convert it to OBJ" % path)
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    return np.frombuffer(data, record, count, 84)["corners"].astype(float)
