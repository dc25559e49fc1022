"""Fig. 5 and 8: adaptive sampling, as pictures of nodes."""

import time

import numpy as np

import endovascular_sim

from .. import style
from . import wires
from .row import Measurement, below, number, series

VIEW = (0, 2)                              # axes of the pictures: x to the right, z upwards
SHORTEST, LONGEST, TURN = 0.5e-3, 2e-3, 0.05  # default range of the edges [m], and their largest turn [rad]

# Samplings of Fig. 8. The paper's adaptive edges are 0.5 to 1.5 mm.
LENGTH = 0.120                             # of the wire of wires.CORONARY [m]
SAMPLINGS = {"uniform 0.5 mm": {"kind": "uniform", "nodes": 241}, "uniform 0.8 mm": {"kind": "uniform", "nodes": 151},
             "adaptive": {"kind": "adaptive", "nodes": "null", "min_edge": 0.5e-3, "max_edge": 1.5e-3, "turn_per_edge": 0.055}}
REFERENCE = {"kind": "uniform", "nodes": 961}
SAMPLE = 8                                 # steps between comparisons
SPACING = 0.5e-3                           # between compared points [m]
SHOWN_STEP = 2744                          # step at which 70.6 mm are inserted: 142 nodes with edges of 0.5 mm, as in the paper


def merging_and_splitting(folder):
    """Fig. 5: edges of an adaptive wire before, in and after the bend of a tube."""
    motion = {"insertion": {"points": [[0, 0], [3, 0.09], [3.5, 0.09], [6.5, 0.0]]}, "speed": "null", "travel": "null", "rotation": "null"}
    bend = {"vessel.tube.pieces.1.curvature": 50.0, "vessel.tube.pieces.1.length": 0.5 * np.pi / 50.0}
    world = endovascular_sim.World("tube", sampling={"kind": "adaptive", "nodes": "null"}, duration=8, drive=motion, **bend)
    session = world.session()
    figure, axes = style.figure(3, columns=3, panel=(3.6, 5.6))
    moments = {"before the bend": 900, "in the bend": 3400, "withdrawn": 5600}
    found = {}
    for axis, (name, step) in zip(axes, moments.items()):
        session.step(n=step - session.steps)
        nodes = wires.inserted(session)
        found[name] = nodes
        wires.draw_wall(axis, world, VIEW, (-6, -2), (46, 78))
        wires.draw_nodes(axis, nodes, VIEW, color="#2b5c8a", markersize=3.5)
        axis.set(xlim=(-6, 46), ylim=(-2, 78), xlabel="x [mm]", title="%s: %d nodes" % (name, len(nodes)))
    axes[0].set_ylabel("z, along the introducer [mm]")
    style.save(figure, folder / "fig5.png")
    bent = found["in the bend"]
    lengths, angle = wires.edges(bent), np.append(wires.turns(bent), 0.0)
    sharp = np.maximum(angle, np.append(0.0, angle[:-1])) > 0.5 * TURN
    straight, curved = 1e3 * lengths[~sharp].max(), 1e3 * np.median(lengths[sharp])
    before, after = (wires.edges(found[name]) for name in ("before the bend", "withdrawn"))
    halves = np.abs(np.log2(LONGEST / lengths) - np.round(np.log2(LONGEST / lengths))).max()
    return [Measurement("longest straight edge [mm]", "merged", number(straight), "%g mm" % (1e3 * LONGEST), straight > 1.9, straight > 1.9),
            Measurement("median edge in the bend [mm]", "divided", number(curved), "half of the longest, or less", curved < 1.05e3 * LONGEST / 2,
                        curved < 1.05e3 * LONGEST / 2),
            Measurement("largest turning angle of an edge [rad]", "small", number(angle.max(), 2), "≤ 0.06", angle.max() <= 0.06, None),
            Measurement("largest deviation of log₂(longest / edge) from a whole number [1]", "an edge is divided into two",
                        below(halves, 1e-6), "–", None, None),
            Measurement("mean edge before the bend, and again after the withdrawal [mm]", "divided edges are merged",
                        "%s, %s" % (number(1e3 * before.mean()), number(1e3 * after.mean())), "equal within 20 %",
                        abs(after.mean() / before.mean() - 1.0) < 0.2, abs(after.mean() / before.mean() - 1.0) < 0.2)]


class Track:
    """Run with one sampling: compared points, cost and the shown shape."""

    def __init__(self, world, sampling):
        session = world.vary(sampling=sampling).session()
        self.points, self.nodes_inside, begin = [], [], time.process_time()
        self.seconds = 0.0
        while session.step(n=SAMPLE) > 0:
            self.seconds += time.process_time() - begin
            count = int(session.hands["insertion"][0] / SPACING) + 1
            self.points.append(session.track(count, SPACING))
            self.nodes_inside.append(len(wires.inserted(session)))
            if session.steps == SHOWN_STEP:
                self.shown = wires.inserted(session)
            begin = time.process_time()

    def distances(self, other):
        """Distances of points at equal arc length from the tip, of all times [m]."""
        return [np.linalg.norm(a - b, axis=1) for a, b in zip(self.points, other.points)]


def samplings(folder):
    """Fig. 8: high and low resolution and adaptive sampling in a coronary artery."""
    world = endovascular_sim.World(wires.CORONARY)
    reference = Track(world, REFERENCE)
    tracks = {name: Track(world, sampling) for name, sampling in SAMPLINGS.items()}
    figure, axes = style.figure(3, columns=3, panel=(4.0, 3.6))
    low, high = (1e3 * side(reference.shown[:, list(VIEW)]) for side in (lambda p: p.min(axis=0) - 4e-3, lambda p: p.max(axis=0) + 4e-3))
    for axis, (name, track) in zip(axes, tracks.items()):
        wires.draw_wall(axis, world, VIEW, low, high)
        wires.draw_nodes(axis, track.shown, VIEW, color="#2b5c8a", markersize=3)
        axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x, to the left [mm]", title="%s: %d nodes" % (name, len(track.shown)))
    axes[0].set_ylabel("z, to the head [mm]")
    style.save(figure, folder / "fig8.png")
    counts = [len(track.shown) for track in tracks.values()]
    errors = {name: np.concatenate(track.distances(reference)) for name, track in tracks.items()}
    rms = [1e6 * np.sqrt((error ** 2).mean()) for error in errors.values()]
    largest = [1e6 * error.max() for error in errors.values()]
    gain = tracks["uniform 0.5 mm"].seconds / tracks["adaptive"].seconds
    names = ", ".join(SAMPLINGS)
    return [Measurement("nodes at 70.6 mm: %s" % names, "142, 88, 75", series(counts), "adaptive ≤ 88", counts[2] <= 88, counts[2] <= 88),
            Measurement("RMS distance to 0.125 mm edges [µm]: %s" % names, "adaptive almost identical to 0.5 mm", series(rms, 2),
                        "first and last equal within 10", abs(rms[2] - rms[0]) < 10.0, abs(rms[2] - rms[0]) < 10.0),
            Measurement("largest distance [µm]: %s" % names, "–", series(largest, 2), "adaptive < 200", largest[2] < 200.0),
            Measurement("processor time of uniform 0.5 mm over that of adaptive [1]", "almost 2", number(gain, 2), agrees=gain > 1.5,
                        kind="time")]
