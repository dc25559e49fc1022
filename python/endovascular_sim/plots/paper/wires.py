"""Scenes of the rows, and measurements of polylines."""

import numpy as np

# Distal 120 mm of a 0.014" wire from the ostium of the left main artery. The compliant wall keeps snap-through between facets, whose
# time depends on every detail, out of the comparison of samplings.
CORONARY = """
name: coronary
duration: 4
vessel: {anatomy: plain, stiffness: 5.0e6, friction: 0.1}
entry: {position: [0.014, -0.01433, 0.2041], direction: [9, -0.7, 2.2], up: [0, 1, 0]}
instrument:
  name: guidewire
  sections:
    - {length: 0.040, radius: 1.778e-4, material: steel, density: 7000, bending_stiffness: 50.0e-6, poisson_ratio: 0.3}
    - {length: 0.050, radius: 1.778e-4, material: steel, density: 7000, bending_stiffness: 10.0e-6, poisson_ratio: 0.3}
    - {length: 0.030, radius: 1.778e-4, material: platinum, density: 12000, bending_stiffness: 1.6e-6, poisson_ratio: 0.3}
drive:
  source: script
  initial_insertion: 0.002
  insertion: {points: [[0, 0], [2.8, 0.07], [3.2, 0.07], [4.0, 0.055]]}
  rotation: {amplitude: 0.5, frequency: 0.5}
"""

# Wire with an angled tip, clamped at its proximal end, which is turned in free space.
FREE_TIP = """
name: free_tip
duration: 16
vessel: none
entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}
instrument:
  name: wire
  sections:
    - {length: 0.100, radius: 4.445e-4, material: steel, density: 6450, bending_stiffness: 40.0e-6, poisson_ratio: 0.3}
  tip: {shape: angled, radius: 0.010, angle: 0.785398163397448, straight: 0.006}
introducer: false
proximal_end: clamped
drive: {source: script, rotation: {points: [[0, 0], [16, 6.283185307179586]]}, torque_limit: 1}
loads: {gravity: [0, 0, 0], damping: 2.0}
sampling: {kind: uniform, nodes: 101}
"""


def edges(nodes):
    """Lengths of the edges of a polyline [m]."""
    return np.linalg.norm(np.diff(nodes, axis=0), axis=1)


def turns(nodes):
    """Turning angles at the inner nodes of a polyline [rad]."""
    directions = np.diff(nodes, axis=0) / edges(nodes)[:, None]
    cosine = (directions[:-1] * directions[1:]).sum(axis=1)
    return np.arctan2(np.linalg.norm(np.cross(directions[:-1], directions[1:]), axis=1), cosine)


def inserted(session):
    """Nodes of the first instrument beyond the introducer's mouth [m]."""
    nodes = session.nodes
    from_tip = np.append(np.cumsum(edges(nodes)[::-1])[::-1], 0.0)
    return nodes[from_tip <= session.hands["insertion"][0] + 1e-9]


def draw_nodes(axes, nodes, view=(0, 2), **look):
    """Draws edges and nodes of a wire along two axes of the patient frame [mm]."""
    axes.plot(*(1e3 * nodes[:, list(view)].T), "o-", markersize=look.pop("markersize", 2.5), linewidth=look.pop("linewidth", 0.8), **look)
    axes.set_aspect("equal", adjustable="box")


def draw_wall(axes, world, view, low, high):
    """Draws the outline of the vessel between two corners [mm]."""
    from matplotlib.collections import PolyCollection
    corners = 1e3 * world.vertices[world.triangles][:, :, list(view)]
    visible = ((corners.max(axis=1) >= low) & (corners.min(axis=1) <= high)).all(axis=1)
    axes.add_collection(PolyCollection(corners[visible], facecolor="#f6e0dc", edgecolor="none", antialiased=False, zorder=0))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.grid(False)
