#!/usr/bin/python3
"""Draws the figures of CONTACT, PHYSICS, ARCHITECTURE, FLOW, MOTION and CONTRAST as SVG files beside this script.

  docs/figures/draw.py            writes the files
  docs/figures/draw.py --check    compares the files with what it would write; exit code 1 if one differs
"""
import argparse
import io
import os
import sys

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch, Polygon, Wedge

WALL, LUMEN, WIRE, GUIDE, MARK = "#8c6d62", "#f7efe9", "#2b5c8a", "#777777", "#b3261e"
plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "figures", "font.family": "sans-serif", "font.size": 10})


def canvas(width, height, x, y):
    figure, axes = plt.subplots(figsize=(width, height))
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    axes.set_aspect("equal")
    axes.axis("off")
    figure.subplots_adjust(0, 0, 1, 1)
    return figure, axes


def arrow(axes, begin, end, style="-|>", colour="black", width=1.2, **more):
    axes.add_patch(FancyArrowPatch(begin, end, arrowstyle=style, color=colour, linewidth=width, mutation_scale=11,
                                   shrinkA=0, shrinkB=0, **more))


def label(axes, x, y, text, colour="black", **more):
    axes.text(x, y, text, color=colour, **{"ha": "center", "va": "center", **more})


def features():
    """Features at a ridge: the face's normal, and the normal cone of a reflex edge."""
    figure, axes = canvas(7.2, 3.4, (-6, 6.2), (-1.6, 4.3))
    left, ridge, right = np.array([-6, -0.2]), np.array([0, 1.0]), np.array([6.2, -0.24])
    axes.add_patch(Polygon([left, ridge, right, [6.2, -1.6], [-6, -1.6]], facecolor=WALL, alpha=0.35, edgecolor="none"))
    axes.plot(*zip(left, ridge, right), color=WALL, linewidth=2.5)
    label(axes, 0, -0.8, "wall", WALL)
    normals = []
    for a, b in ((left, ridge), (ridge, right)):
        along = (b - a) / np.linalg.norm(b - a)
        normals.append(np.array([-along[1], along[0]]))
    angles = [np.degrees(np.arctan2(n[1], n[0])) for n in normals]
    axes.add_patch(Wedge(ridge, 3.0, angles[1], angles[0], facecolor=MARK, alpha=0.13, edgecolor="none"))
    for n in normals:
        axes.plot(*zip(ridge, ridge + 3.0 * n), color=MARK, linewidth=0.9, linestyle="--")
    for node, foot, name in ((np.array([-3.6, 1.9]), None, "face"), (np.array([0.12, 3.2]), ridge, "edge"),
                             (np.array([3.4, 2.1]), None, "face")):
        if foot is None:
            a, n = (left, normals[0]) if node[0] < 0 else (ridge, normals[1])
            foot = node - np.dot(node - a, n) * n
        arrow(axes, foot, node - 0.42 * (node - foot) / np.linalg.norm(node - foot), colour=MARK)
        axes.add_patch(Circle(node, 0.42, facecolor="white", edgecolor=WIRE, linewidth=2))
        axes.plot(*node, "o", color=WIRE, markersize=3)
        axes.plot(*foot, "o", color=MARK, markersize=4)
        label(axes, node[0], node[1] + 0.68, name)
    label(axes, 1.45, 3.7, "normal cone", MARK, fontsize=9)
    label(axes, -3.75, 0.95, "n", MARK, style="italic")
    return figure


def distances():
    """Gap, margin and free distance of an edge of the instrument."""
    figure, axes = canvas(7.2, 3.9, (-1.2, 11.4), (-0.9, 5.95))
    wall = np.array([[-1.2, 0.35], [3.2, 0.0], [6.2, 0.35], [8.6, 1.0], [11.4, 1.1]])
    axes.add_patch(Polygon([*wall, [11.4, -0.9], [-1.2, -0.9]], facecolor=WALL, alpha=0.35, edgecolor="none"))
    axes.plot(*wall.T, color=WALL, linewidth=2.5)
    label(axes, 10.5, -0.3, "wall", WALL)
    nodes = np.array([[0.6, 1.45], [4.4, 1.75], [8.4, 4.3]])
    radius, margin = 0.6, 1.0
    for node in nodes:
        axes.add_patch(Circle(node, radius + margin, facecolor="none", edgecolor=GUIDE, linestyle=":", linewidth=1.1))
    for a, b in zip(nodes, nodes[1:]):
        along = (b - a) / np.linalg.norm(b - a)
        side = radius * np.array([-along[1], along[0]])
        axes.add_patch(Polygon([a + side, b + side, b - side, a - side], facecolor="#dbe7f2", edgecolor=WIRE, linewidth=1.3))
    for node in nodes:
        axes.add_patch(Circle(node, radius, facecolor="#dbe7f2", edgecolor=WIRE, linewidth=1.3))
    axes.plot(*nodes.T, "-o", color=WIRE, markersize=4, linewidth=1)
    foot = np.array([4.27, 0.12])
    normal = (nodes[1] - foot) / np.linalg.norm(nodes[1] - foot)
    arrow(axes, foot, nodes[1] - radius * normal, "<|-|>", MARK)
    axes.plot(*foot, "o", color=MARK, markersize=4)
    label(axes, 4.65, 0.62, "g", MARK, style="italic")
    direction = np.array([np.cos(np.radians(125)), np.sin(np.radians(125))])
    arrow(axes, nodes[1] + radius * direction, nodes[1] + (radius + margin) * direction, "<|-|>", GUIDE)
    label(axes, 3.05, 3.35, "margin", GUIDE)
    middle = 0.36 * nodes[1] + 0.64 * nodes[2]
    corner = wall[3]
    toward = (corner - middle) / np.linalg.norm(corner - middle)
    arrow(axes, middle + radius * toward, corner, "<|-|>", "black")
    label(axes, 9.15, 2.25, "free distance\nof the edge", ha="left", fontsize=9)
    label(axes, 6.0, 3.55, "$e_i$", WIRE)
    label(axes, 4.4, 2.03, "$x_i$", WIRE)
    label(axes, 8.4, 4.62, "$x_{i+1}$", WIRE)
    return figure


def box(axes, x, y, w, h, text, colour="#eef3f8", edge=WIRE, **more):
    axes.add_patch(FancyBboxPatch((x - w / 2, y - h / 2), w, h, boxstyle="round,pad=0,rounding_size=0.12",
                                  facecolor=colour, edgecolor=edge, linewidth=1.2))
    label(axes, x, y, text, **more)


def step():
    """Data flow of one step of the scheme kkt."""
    figure, axes = canvas(7.6, 5.4, (0, 15.2), (0, 10.8))
    box(axes, 2.4, 9.9, 4.2, 1.1, "commands of the hands", "white", GUIDE)
    box(axes, 7.4, 9.9, 3.8, 1.1, "handle: grip, slip, stops")
    box(axes, 12.5, 9.9, 4.0, 1.1, "insertion, rotation", "white", GUIDE)
    box(axes, 12.5, 7.7, 4.0, 1.2, "twist of the layers\n(quasi-static)")
    box(axes, 12.5, 5.5, 4.0, 1.2, "linear system\nbending, inertia, drag")
    box(axes, 7.4, 5.5, 3.8, 1.2, "active set, friction\n(at most 16 passes)")
    box(axes, 2.4, 5.5, 4.2, 1.2, "trust region:\nmargin, free distance, turn")
    box(axes, 2.4, 7.7, 4.2, 1.2, "contact set:\ngaps, normals, margins")
    box(axes, 7.4, 3.2, 3.8, 1.2, "length correction")
    box(axes, 12.5, 3.2, 4.0, 1.2, "loads between layers,\nreactions of wall and hand")
    box(axes, 12.5, 1.0, 4.0, 1.1, "state, force at the hands", "white", GUIDE)
    box(axes, 7.4, 7.7, 3.8, 1.2, "detector, in this\nor its own process", "#f7efe9", WALL)
    for begin, end in (((4.5, 9.9), (5.5, 9.9)), ((9.3, 9.9), (10.5, 9.9)), ((12.5, 9.35), (12.5, 8.3)),
                       ((12.5, 7.1), (12.5, 6.1)), ((10.5, 5.5), (9.3, 5.5)), ((5.5, 5.5), (4.5, 5.5)),
                       ((9.3, 3.2), (10.5, 3.2)), ((12.5, 2.6), (12.5, 1.55))):
        arrow(axes, begin, end)
    arrow(axes, (2.4, 6.1), (2.4, 7.1))
    label(axes, 2.2, 6.6, "truncated:\nagain", ha="right", fontsize=9)
    arrow(axes, (4.5, 7.7), (5.5, 7.7), "<|-|>", WALL)
    label(axes, 5.0, 8.55, "query, set", WALL, fontsize=9)
    arrow(axes, (4.5, 7.2), (10.5, 5.95))
    arrow(axes, (3.4, 4.9), (5.5, 3.2), connectionstyle="arc3,rad=0.2")
    label(axes, 3.4, 3.55, "whole", fontsize=9)
    return figure


def layers():
    """Layers of the source tree, upper ones include lower ones."""
    rows = [
        ("nodes · tools · rviz_plugin", "ROS, command line, rviz", "#f5e3e1"),
        ("benchmark · python", "studies, bindings", "#eef3f8"),
        ("session", "a run of a scene: what every program opens", "#dbe7f2"),
        ("procedure · results", "operator, metrics", "#eef3f8"),
        ("simulation", "one time step of a scene", "#eef3f8"),
        ("scene", "files, keys, instruments and vessel of a scene", "#eef3f8"),
        ("drive · robot · haptics · sensor · fluoroscopy · intervention", "what moves or sees instruments", "#eef3f8"),
        ("patient · phantom", "tissues of the body, synthetic CT and MR", "#eef3f8"),
        ("vessel · contrast · flow · motion · segmentation · instrument", "anatomy and devices", "#eef3f8"),
        ("rod · contact", "mechanics; they share only contact/contract", "#eef3f8"),
        ("common · yaml · geometry · image", "errors, archives, meshes, volumes", "#f2f2f2"),
    ]
    figure, axes = canvas(7.4, 5.05, (-0.3, 14.5), (0, 10.1))
    for k, (folders, what, colour) in enumerate(rows):
        y = 9.65 - 0.9 * k
        axes.add_patch(FancyBboxPatch((0.6, y - 0.37), 13.6, 0.74, boxstyle="round,pad=0,rounding_size=0.1",
                                      facecolor=colour, edgecolor=WIRE, linewidth=1))
        label(axes, 0.85, y, folders, ha="left", family="monospace", fontsize=8)
        label(axes, 13.95, y, what, ha="right", fontsize=8.5, colour="#444444")
    arrow(axes, (0.3, 9.9), (0.3, 0.3))
    label(axes, 0.0, 5.05, "includes", rotation=90, fontsize=8.5)
    return figure


def resistor(axes, x, y, name, length=0.7):
    """Zigzag along x, from (x, y)."""
    xs = x + length * np.array([0, 0.15, 0.22, 0.36, 0.5, 0.64, 0.78, 0.85, 1.0])
    ys = y + 0.14 * np.array([0, 0, 1, -1, 1, -1, 1, 0, 0])
    axes.plot(xs, ys, color="black", linewidth=1.1)
    label(axes, x + 0.5 * length, y + 0.32, name)


def outlet(axes, x, y, name):
    """Windkessel from (x, y): R1, then C to the ground and R2."""
    resistor(axes, x, y, "$R_1$")
    resistor(axes, x + 0.9, y, "$R_2$")
    axes.plot([x + 0.7, x + 0.9], [y, y], color="black", linewidth=1.1)
    axes.plot([x + 0.8, x + 0.8], [y, y - 0.28], color="black", linewidth=1.1)
    for below in (0.28, 0.36):
        axes.plot([x + 0.66, x + 0.94], [y - below, y - below], color="black", linewidth=1.6)
    label(axes, x + 1.1, y - 0.34, "$C$")
    label(axes, x + 1.7, y, name, ha="left")


def flow_network():
    """Cells and nodes of the flow network, with heart, lesion, instrument and outlets."""
    figure, axes = canvas(7.4, 3.6, (-1.5, 11.2), (-3.1, 3.0))
    axes.add_patch(Circle((-0.6, 0), 0.55, facecolor="#f3d9d6", edgecolor=MARK, linewidth=1.5))
    label(axes, -0.6, 0, "heart\n$Q(t)$", MARK, fontsize=9)
    trunk, upper, lower = [0.4, 1.6, 2.8, 4.0], [(4.0, 0), (5.2, 0.8), (6.4, 1.6)], [(4.0, 0), (5.2, -0.8), (6.4, -1.6)]
    for a, b in zip(trunk, trunk[1:]):
        axes.plot([a, b], [0, 0], color=WALL, alpha=0.3, linewidth=26, solid_capstyle="butt")
    for way in (upper, lower):
        for a, b in zip(way, way[1:]):
            axes.plot(*zip(a, b), color=WALL, alpha=0.3, linewidth=17, solid_capstyle="butt")
    axes.plot([-0.05, 0.4], [0, 0], color=MARK, linewidth=1.5)
    nodes = [(x, 0) for x in trunk] + upper[1:] + lower[1:]
    for node in nodes:
        axes.add_patch(Circle(node, 0.11, facecolor="white", edgecolor="black", zorder=5))
    label(axes, 0.4, 0.62, "node:\npressure $P$,\nvolume $V$", fontsize=9, va="bottom")
    for a, b in zip(trunk, trunk[1:]):
        arrow(axes, (a + 0.3, 0), (b - 0.3, 0), colour=WIRE)
    label(axes, 2.2, -0.62, "cell: flow $Q$, area $A$,\nlength $\\Delta x$", WIRE, fontsize=9, va="top")
    throat = np.array([5.8, 1.2])
    axes.add_patch(Circle(throat + (-0.12, 0.28), 0.16, facecolor=WALL, edgecolor="none"))
    axes.add_patch(Circle(throat + (0.14, -0.26), 0.16, facecolor=WALL, edgecolor="none"))
    label(axes, 4.6, 2.35, "lesion: resistance $R$,\njet $K$", WALL, fontsize=9)
    arrow(axes, (5.1, 2.0), (5.62, 1.5), colour=WALL, width=0.9)
    axes.plot([7.6, 6.4, 4.6, 3.0], [-2.4, -1.62, -0.42, -0.14], color=GUIDE, linewidth=4, solid_capstyle="round")
    label(axes, 7.4, -2.55, "catheter: annulus, and\npressure at its tip", GUIDE, fontsize=9, ha="right")
    for y, name in ((1.6, "veins, or\nmuscle of the heart"), (-1.6, "veins")):
        axes.plot([6.4, 6.9], [y, y], color="black", linewidth=1.1)
        outlet(axes, 6.9, y, name)
    return figure


def flow_steps():
    """Steps of the simulation and of the flow: a result acts one step of the flow after its request."""
    figure, axes = canvas(7.4, 2.5, (-1.9, 10.6), (-0.7, 3.5))
    for y, name in ((2.4, "instruments"), (0.4, "blood")):
        axes.plot([-0.2, 10.4], [y, y], color="#bbbbbb", linewidth=1)
        label(axes, -0.4, y, name, ha="right")
    for k in range(11):
        axes.plot([k, k], [2.3, 2.5], color="black", linewidth=1)
    for k, begin in enumerate((0, 5)):
        box(axes, begin + 1.9, 0.4, 2.6, 0.5, "step %d of the flow" % (k + 1), fontsize=9)
        arrow(axes, (begin, 2.3), (begin + 0.6, 0.65), colour=WIRE)
        arrow(axes, (begin + 3.2, 0.5), (begin + 5, 2.25), colour=MARK)
    label(axes, -0.25, 1.4, "lumens, tips,\ncontrols", WIRE, fontsize=9, ha="right")
    label(axes, 3.6, 1.75, "pressure, flow", MARK, fontsize=9, ha="right")
    label(axes, 0.5, 2.85, "1 ms", fontsize=9)
    arrow(axes, (5, 3.15), (10, 3.15), "<|-|>", MARK)
    label(axes, 7.5, 3.35, "drag, thrust and readings by step 1 of the flow", MARK, fontsize=9)
    return figure


def moved(points):
    """Map of the figure of the motion, in a plane: shortening towards the apex, rotation and breath, fading between two circles.
    Its displacements are twice those of an adult. @param points rows of x, z [mm]"""
    points = np.asarray(points, float)
    centre, core, reach = np.array([42.0, 155.0]), 50.0, 100.0
    base, apex = np.array([0.0, 194.0]), np.array([75.0, 122.0])
    length = np.linalg.norm(apex - base)
    axis = (apex - base) / length
    along = (points - base) @ axis
    across = points - base - along[:, None] * axis
    field = 24 * axis * (1 - along / length)[:, None] - 0.12 * across + np.array([0.0, -6.0])
    t = np.clip((((points - centre) ** 2).sum(axis=1) - core ** 2) / (reach ** 2 - core ** 2), 0, 1)
    return points + (1 - t ** 3 * (10 - 15 * t + 6 * t ** 2))[:, None] * field


def motion_map():
    """Resting and moved patient: grid, fade, aorta, coronary artery, and a wire that is pulled back."""
    figure, axes = canvas(7.4, 3.85, (-92, 437), (18, 293))
    s = np.linspace(0, 1, 60)[:, None]
    aorta = np.concatenate([[0, 190] + s * [-22, 45], [-22, 235] + np.hstack([27 * (1 - np.cos(np.pi * s)), 30 * np.sin(np.pi * s)]) * [-1, 1],
                            [-76, 235] + s * [2, -185]])
    artery = np.array([[0, 190], [14, 199], [28, 197], [42, 184], [52, 168], [62, 150], [72, 133]])
    inside = np.interp(np.linspace(0, 6, 70), range(7), artery[:, 0]), np.interp(np.linspace(0, 6, 70), range(7), artery[:, 1])
    kernel = np.ones(9) / 9
    artery = np.stack([np.convolve(np.pad(v, 4, mode="edge"), kernel, "valid") for v in inside], axis=1)
    angle = np.linspace(0, 2 * np.pi, 200)
    for shift, change, title in ((0, lambda p: np.asarray(p, float), "at rest, X"), (292, moved, "moved, x = φ(X)")):
        def draw(points, **style):
            axes.plot(*(change(points) + [shift, 0]).T, **style)
        for value in np.arange(-60, 151, 15):
            draw(np.column_stack([np.full(80, value), np.linspace(50, 260, 80)]), color="#d5d5d5", linewidth=0.7)
        for value in np.arange(50, 261, 15):
            draw(np.column_stack([np.linspace(-60, 150, 80), np.full(80, value)]), color="#d5d5d5", linewidth=0.7)
        for radius in (50, 100):
            circle = np.column_stack([42 + radius * np.cos(angle), 155 + radius * np.sin(angle)])
            axes.plot(*(circle + [shift, 0]).T, color=GUIDE, linewidth=1, linestyle=":")
        draw(aorta, color=WALL, alpha=0.4, linewidth=14, solid_capstyle="round")
        draw(artery, color=WALL, alpha=0.55, linewidth=7, solid_capstyle="round")
        wire = np.concatenate([aorta[170:60:-6], aorta[60:0:-6], artery[:48:5]])
        axes.plot(*(change(wire) + [shift, 0]).T, "-o", color=WIRE, markersize=2.2, linewidth=1)
        foot, normal = artery[24], np.array([0.62, 0.78])
        begin, end = change([foot + 4 * normal, foot + 26 * normal]) + [shift, 0]
        arrow(axes, begin, end, colour=MARK)
        label(axes, *(end + [9, 4]), "N" if shift == 0 else "n", MARK, style="italic")
        label(axes, 42 + shift, 34, title)
    label(axes, 42, 118, "w = 1", GUIDE, fontsize=9)
    label(axes, 70, 71, "fade", GUIDE, fontsize=9)
    label(axes, 134, 60, "w = 0", GUIDE, fontsize=9)
    arrow(axes, (155, 215), (208, 215), colour=MARK, connectionstyle="arc3,rad=-0.25")
    label(axes, 181, 262, "features: φ(P),\n$n \\parallel \\nabla\\varphi^{-T}N$", MARK, fontsize=9, va="center")
    arrow(axes, (208, 95), (155, 95), colour=WIRE, connectionstyle="arc3,rad=-0.25")
    label(axes, 180, 80, "nodes: $\\varphi^{-1}(x)$", WIRE, fontsize=9, va="top")
    return figure


def contrast_cells():
    """Contrast medium: cells of the lumen with their concentrations, and a ray through them."""
    figure, axes = canvas(7.4, 3.7, (-1.0, 13.8), (-1.6, 5.8))
    shades = {"none": "#f7efe9", "low": "#d9cdd6", "middle": "#a795ad", "high": "#6b5a7d"}

    def cell(corners, shade):
        axes.add_patch(Polygon(corners, facecolor=shades[shade], edgecolor="none"))

    aorta = [-1.2, 0.1, 1.4, 2.7, 4.0, 5.3]
    for low, high, shade in zip(aorta, aorta[1:], ("none", "low", "low", "none", "none")):
        cell([(-0.6, low), (1.2, low), (1.2, high), (-0.6, high)], shade)
    branch = [1.2, 2.3, 3.4, 4.5, 5.6, 6.7]
    for left, right, shade in zip(branch, branch[1:], ("high", "high", "middle", "middle", "low")):
        cell([(left, 1.6), (right, 1.6), (right, 2.5), (left, 2.5)], shade)
    for y in aorta[1:-1]:
        axes.plot([-0.6, 1.2], [y, y], color=MARK, linewidth=1, linestyle="--")
    for x in branch[:-1]:
        axes.plot([x, x], [1.6, 2.5], color=MARK, linewidth=1, linestyle="--")
    for way in ([(-0.6, -1.2), (-0.6, 5.3)], [(1.2, -1.2), (1.2, 1.6), (6.7, 1.6)], [(1.2, 5.3), (1.2, 2.5), (6.7, 2.5)]):
        axes.plot(*zip(*way), color=WALL, linewidth=2.5)
    axes.plot([-0.2, 0.0, 0.5, 1.9], [-1.2, 1.0, 2.0, 2.05], color=GUIDE, linewidth=4, solid_capstyle="round")
    label(axes, 1.7, -0.2, "catheter: end and side holes", GUIDE, fontsize=9, ha="left")
    arrow(axes, (1.65, -0.1), (0.1, 0.4), colour=GUIDE, width=0.9)
    arrow(axes, (2.0, 2.05), (2.9, 2.05), colour="white", width=1.6)
    arrow(axes, (4.7, 2.05), (6.3, 2.05), colour=WIRE)
    arrow(axes, (0.3, 5.05), (0.3, 4.2), colour=WIRE)
    label(axes, 5.5, 2.85, "flow $Q$", WIRE, fontsize=9)
    arrow(axes, (1.6, 1.3), (0.7, 0.8), colour=MARK, connectionstyle="arc3,rad=-0.3")
    label(axes, 1.75, 1.2, "reflux", MARK, fontsize=9, ha="left")
    label(axes, 5.0, 0.75, "cell: volume $V$, iodine $m = cV$", fontsize=9)
    arrow(axes, (4.6, 1.15), (4.2, 1.75), width=0.9)
    label(axes, 2.9, 4.35, "cap: a plane normal to\nthe centreline", MARK, fontsize=9, ha="left")
    arrow(axes, (2.8, 4.2), (1.1, 4.02), colour=MARK, width=0.9)

    source, pixel = np.array([8.3, 5.2]), np.array([12.9, -0.9])
    axes.plot(*source, "o", color="black", markersize=6)
    label(axes, source[0], source[1] + 0.4, "focus", fontsize=9)
    axes.add_patch(Polygon([(11.6, -1.35), (13.4, -0.1), (13.55, -0.3), (11.75, -1.55)], facecolor="#bbbbbb", edgecolor="black", linewidth=0.8))
    label(axes, 11.45, -1.3, "pixel", fontsize=9, ha="right")
    axes.plot(*zip(source, pixel), color="black", linewidth=0.9)
    along = (pixel - source) / np.linalg.norm(pixel - source)
    across = np.array([-along[1], along[0]])
    for k, (begin, end, shade) in enumerate(((2.3, 3.3, "high"), (3.3, 4.5, "middle"))):
        corners = [source + s * along + side * across for s, side in ((begin, -0.9), (end, -0.9), (end, 0.9), (begin, 0.9))]
        cell(corners, shade)
        middle = source + 0.5 * (begin + end) * along
        label(axes, *(middle + 1.15 * across), "$c_%d$" % (k + 1), fontsize=10)
    axes.plot(*zip(source, pixel), color="black", linewidth=0.9)
    for s, sign in ((2.3, "−"), (3.3, "+ −"), (4.5, "+")):
        point = source + s * along
        axes.plot(*zip(point - 0.9 * across, point + 0.9 * across), color=MARK if s == 3.3 else WALL, linewidth=1.6,
                  linestyle="--" if s == 3.3 else "-")
        axes.plot(*point, "o", color=MARK, markersize=4)
        label(axes, *(point - 1.2 * across), sign, MARK)
    label(axes, 8.2, 0.35, "$\\int c\\,ds = \\sum_k c_k \\ell_k$", fontsize=11, ha="left")
    return figure


FIGURES = {"contact_features": features, "contact_distances": distances, "step": step, "layers": layers,
           "flow_network": flow_network, "flow_steps": flow_steps, "motion_map": motion_map,
           "contrast_cells": contrast_cells}


def svg(draw):
    figure = draw()
    out = io.StringIO()
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    return out.getvalue()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare only")
    arguments = parser.parse_args()
    folder = os.path.dirname(os.path.abspath(__file__))
    different = []
    for name, draw in FIGURES.items():
        path = os.path.join(folder, name + ".svg")
        text = svg(draw)
        if arguments.check:
            if not os.path.exists(path) or open(path, encoding="utf-8").read() != text:
                different.append(path)
        else:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
    for path in different:
        print("%s is not what docs/figures/draw.py draws; run it" % path, file=sys.stderr)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
