"""Fig. 2 to 4: the framed curve of the wire, its segments, and the rest curvature that moves with it."""

import numpy as np

import endovascular_sim

from .. import style
from . import wires
from .row import Measurement, below, number

PUSH = 3500         # steps until the tip has passed the bend of config/scenes/tube.yaml
SHOWN = 7           # frames of the tip in the picture
ARROW = 8.0         # length of a director in the picture [mm]
DIRECTORS = (("tangent", "#333333"), ("$d_1$", "#b3261e"), ("$d_2$", "#2b5c8a"))


def frame_of_the_tip(folder):
    """Fig. 2: material frame of the tip while a wire is pushed through a bend and turned."""
    session = endovascular_sim.World("tube").session()
    figure, [axes] = style.figure(panel=(5.0, 6.2))
    error, deviation = 0.0, 0.0
    for k in range(SHOWN):
        session.step(n=PUSH // SHOWN)
        tip, nodes = session.tips[0], session.nodes
        frame = tip["frame"]
        error = max(error, np.abs(frame.T @ frame - np.eye(3)).max(), abs(np.linalg.det(frame) - 1.0))
        last = nodes[-1] - nodes[-2]
        deviation = max(deviation, np.linalg.norm(np.cross(frame[:, 0], last / np.linalg.norm(last))))
        for column, (name, colour) in enumerate(DIRECTORS):
            begin = 1e3 * tip["position"][[0, 2]]
            axes.annotate("", begin + ARROW * frame[[0, 2], column], begin, arrowprops={"arrowstyle": "->", "color": colour})
            if k == 0:
                axes.plot([], [], color=colour, label=name)
    axes.plot(*(1e3 * session.nodes[:, [0, 2]].T), color="#8a8f98", linewidth=2, zorder=0, label="wire at the end")
    axes.set_aspect("equal")
    axes.set(xlim=(-10, 65), ylim=(0, 95), xlabel="x [mm]", ylabel="z, along the introducer [mm]", title="Frames of the tip on its way through the bend")
    axes.legend(loc="lower right")
    style.save(figure, folder / "fig2.png")
    return [Measurement("largest error of orthonormality of (tangent, d1, d2) [1]", "0", below(error, 1e-12), "< 1e-12", error < 1e-12,
                        error < 1e-12),
            Measurement("largest angle between the frame's tangent and the last edge [rad]", "0", below(deviation, 1e-12), "< 1e-12",
                        deviation < 1e-12, deviation < 1e-12)]


def segments(folder):
    """Fig. 3: nodes and edges of a wire, and the strain of its edges in a bend."""
    world = endovascular_sim.World("tube", sampling={"nodes": 76}, **{"solver.strain_tolerance": 5e-5})
    session = world.session()
    session.step(n=PUSH)
    nodes = session.nodes
    rest = world.lengths[0] / 75
    lengths = wires.edges(nodes)
    strain = np.abs(lengths / rest - 1.0).max()
    figure, [axes] = style.figure(panel=(4.2, 5.4))
    wires.draw_nodes(axes, nodes, color="#2b5c8a", markersize=4)
    axes.set(xlim=(-10, 60), ylim=(-5, 90), xlabel="x [mm]", ylabel="z, along the introducer [mm]",
             title="%d nodes, %d segments of %.1f mm" % (len(nodes), len(nodes) - 1, 1e3 * rest))
    style.save(figure, folder / "fig3.png")
    return [Measurement("nodes less segments [1]", "1", str(len(nodes) - len(lengths)), "1", len(nodes) - len(lengths) == 1, True),
            Measurement("largest strain of a segment in the bend [1]", "very low", number(strain, 2), "≤ 5e-5", strain <= 5e-5, strain <= 5e-5)]


def rest_curvature(folder):
    """Fig. 4: the angled tip turns with the handle in free space and keeps its angle."""
    session = endovascular_sim.World(wires.FREE_TIP).session()
    figure, [axes] = style.figure(panel=(4.6, 5.2))
    angles, offsets = [], []
    for _ in range(8):
        session.step(n=2000)
        nodes = session.nodes
        last = nodes[-1] - nodes[-2]
        hand = session.hands["rotation"][0]
        angles.append(np.degrees(np.arctan2(np.hypot(last[0], last[1]), last[2])))
        offsets.append(np.arctan2(last[1], last[0]) - hand)
        tip = nodes[-40:]
        axes.plot(1e3 * tip[:, 0], 1e3 * tip[:, 1], label="%.0f°" % np.degrees(hand))
    axes.set_aspect("equal")
    axes.set(xlim=(-9, 9), ylim=(-9, 12), xlabel="x [mm]", ylabel="y [mm]", title="Angled tip, seen along the shaft, by the turn of the handle")
    axes.legend(ncol=4, loc="upper center")
    style.save(figure, folder / "fig4.png")
    change = max(angles) - min(angles)
    lag = np.degrees(np.abs(np.angle(np.exp(1j * (np.array(offsets) - offsets[-1])))).max())  # the last one after a full turn
    return [Measurement("change of the tip's angle in a full turn [°]", "0: the curvature moves with the frame", number(change, 1),
                        "≤ 0.1", change <= 0.1, change <= 0.1),
            Measurement("largest lag of the tip behind the handle [°]", "0", number(lag, 1), "≤ 0.5", lag <= 0.5, lag <= 0.5)]

