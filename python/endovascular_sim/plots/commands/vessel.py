"""Draws input and result of `vessel_prepare`.

Both are seen from the front, the result with its centreline and open ends, and cut by planes. OUT_report.json must lie
beside OUT.obj.
"""

import argparse
import pathlib

import numpy as np

from .. import meshes, style, tables
from ..command import Failure, warn

AXES = "xyz"
BEFORE, AFTER, CENTRELINE = "#d9604f", "#e8a79d", "#1f6fb0"
LIGHT = (0.3, 0.4, 0.87)  # direction towards the light, in the picture: right, up, towards the viewer


def draw_surface(axis, corners, view, colour, alpha):
    """Draws shaded triangles from the farthest to the nearest. view: the axes that point right and up."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb
    right, up = np.eye(3)[list(view)]
    seen = 1e3 * corners @ np.stack([right, up, np.cross(right, up)], axis=1)
    normal = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    shade = 0.35 + 0.65 * np.abs(normal @ np.array(LIGHT))
    order = np.argsort(seen[:, :, 2].mean(axis=1))
    face = np.clip(shade[order, None] * np.array(to_rgb(colour)), 0.0, 1.0)
    axis.add_collection(PolyCollection(seen[order][:, :, :2], facecolors=face, edgecolors="none", alpha=alpha,
                                       antialiased=False, rasterized=True))
    axis.set_aspect("equal")
    axis.autoscale_view()
    axis.set_axis_off()


def cut_lines(corners, normal, position):
    """Intersection of the triangles with a plane normal to an axis, as an array segments × ends × axes [m]."""
    height = corners[:, :, normal] - position
    crossed = corners[(height.min(axis=1) < 0.0) & (height.max(axis=1) >= 0.0)]
    lines = []
    for triangle in crossed:
        ends = []
        for k in range(3):
            a, b = triangle[k], triangle[(k + 1) % 3]
            if (a[normal] < position) != (b[normal] < position):
                ends.append(a + (position - a[normal]) / (b[normal] - a[normal]) * (b - a))
        lines.append(ends)
    return np.array(lines).reshape(-1, 2, 3)


def draw_cut(axis, meshes, cut):
    """Draws both meshes cut by a plane.

    cut: axis and position, e.g. ("y", 0.495).
    """
    from matplotlib.collections import LineCollection
    name, position = cut
    normal = AXES.index(name)
    others = [k for k in range(3) if k != normal]
    for corners, colour, width in zip(meshes, ("0.55", "#a03b30"), (2.4, 1.2)):
        lines = 1e3 * cut_lines(corners, normal, position)[:, :, others]
        if len(lines) == 0:
            warn("the plane %s = %g m does not intersect both meshes" % cut)
        axis.add_collection(LineCollection(lines, colors=colour, linewidths=width))
    axis.autoscale_view()
    axis.set_aspect("equal")
    axis.set(title="cut at %s = %g mm (grey: before, red: after)" % (name, 1e3 * position),
             xlabel=AXES[others[0]] + " [mm]", ylabel=AXES[others[1]] + " [mm]")


def draw_centreline(axis, report, view):
    """Draws the branches, and a ring at each open end."""
    for branch in report["centreline"]:
        points = 1e3 * np.array(branch["points"])
        axis.plot(points[:, view[0]], points[:, view[1]], color=CENTRELINE, linewidth=1.2)
    for opening in report["openings"]:
        centre = 1e3 * np.array(opening["place"])
        axis.plot(centre[view[0]], centre[view[1]], "o", color="black", fillstyle="none", markersize=9)


def cut_of(text):
    """Plane of a text: y=0.495 is ("y", 0.495)."""
    name, equals, position = text.partition("=")
    try:
        if name not in AXES or len(name) != 1 or not equals:
            raise ValueError
        return name, float(position)
    except ValueError:
        raise argparse.ArgumentTypeError("requires an axis and a position in metres, e.g. y=0.495, not " + text)


def add_arguments(parser):
    parser.add_argument("before", help="the input of vessel_prepare, OBJ or binary STL")
    parser.add_argument("after", help="its output, OUT.obj")
    parser.add_argument("--unit", type=float, default=1.0, help="length of a unit of the input [1 m]")
    parser.add_argument("--up", choices=AXES, default="y", help="axis towards the head [y]")
    parser.add_argument("--cut", type=cut_of, action="append", default=[], metavar="AXIS=POSITION",
                        help="also draws both meshes cut by a plane, e.g. y=0.495 [m]; may be repeated")
    parser.add_argument("--out", required=True, metavar="FILE.png", help="picture to write")


def run(options):
    """Reads both meshes and the report, and writes the picture."""
    beside = pathlib.Path(options.after).with_suffix("").as_posix() + "_report.json"
    if not pathlib.Path(beside).is_file():
        raise Failure("%s: missing; vessel_prepare writes it beside %s" % (beside, options.after))
    report = tables.read_json(beside)
    surfaces = [options.unit * meshes.read_corners(options.before), meshes.read_corners(options.after)]
    view = (0 if options.up != "x" else 1, AXES.index(options.up))
    rows = max(1, len(options.cut))
    figure = style.pyplot().figure(figsize=(8 + (4 if options.cut else 0), 7))
    grid = figure.add_gridspec(rows, 3 if options.cut else 2)
    before, after = figure.add_subplot(grid[:, 0]), figure.add_subplot(grid[:, 1])
    draw_surface(before, surfaces[0], view, BEFORE, 1.0)
    draw_surface(after, surfaces[1], view, AFTER, 0.6)
    draw_centreline(after, report, view)
    for axis, title, key in ((before, "before", "before"), (after, "after, open ends (o)", "after")):
        counts = report[key]
        axis.set_title("%s\n%d triangles, components: %d, boundary edges: %d" %
                       (title, counts["triangles"], counts["components"], counts["boundary_edges"]))
    limits = [axis.get_ylim() for axis in (before, after)]
    for axis in (before, after):
        axis.set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
    for row, cut in enumerate(options.cut):
        draw_cut(figure.add_subplot(grid[row, 2]), surfaces, cut)
    style.save(figure, options.out)
