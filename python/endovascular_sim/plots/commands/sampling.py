"""Measures the error of the hand force by the distance of the nodes.

Runs a straight wire in bends of a tube, and the J wire of config/scenes/peer_wire.yaml in a straight tube, with several
numbers of nodes. Writes sampling_error.csv: mean hand force in two intervals and its difference to the finest sampling.
"""

import math
import pathlib
import sys

from .. import command, tables

STRAIGHT = 0.05   # m, straight pieces of tube.yaml before and after its bend
WIRE = 0.300      # m, guidewire_035_straight.yaml
J_WIRE = 0.450    # m, peer_j_wire.yaml
# Radius of the bend, radius of the lumen [m], friction.
BENDS = ((0.03, 3e-3, 0.1), (0.03, 3e-3, 0.0), (0.015, 3e-3, 0.1), (0.03, 1.5e-3, 0.1), (0.06, 3e-3, 0.1))
BEND_NODES = (1201, 601, 301, 201, 151, 101, 76)
LUMENS = (6e-3, 3e-3)  # m, of the straight tube
J_NODES = (1921, 961, 481, 241, 181, 121)


def mean_force(table, column, begin, end):
    """Mean hand force of the rows with a column between two values [N]."""
    return table["hand_force"][(table[column] >= begin) & (table[column] <= end)].mean()


def run_tube(folder, overrides):
    """Table of hand_force.csv of a run of tube.yaml."""
    command.simulate(command.find_scene("tube.yaml"), folder, ["drive.rotation.amplitude=0"] + overrides, accepted=(0, 1))
    return tables.read(folder / "hand_force.csv")


def bend_forces(folder, nodes, radius, lumen, friction):
    """Mean forces while the tip is in the bend, and after it has left."""
    arc = 0.5 * math.pi * radius
    travel = 2.0 * STRAIGHT + arc - 0.012
    rows = run_tube(folder, ["vessel.tube.radius=%g" % lumen, "vessel.tube.pieces.1.length=%.12g" % arc,
                        "vessel.tube.pieces.1.curvature=%.12g" % (1.0 / radius), "vessel.tube.facets_around=96",
                        "vessel.tube.facet_length=%g" % min(1e-3, radius / 40), "vessel.friction=%g" % friction,
                        "sampling.nodes=%d" % nodes, "drive.travel=%g" % travel, "drive.speed=0.05",
                        "duration=%g" % (travel / 0.05)])
    return (mean_force(rows, "insertion", STRAIGHT, STRAIGHT + arc),
            mean_force(rows, "insertion", STRAIGHT + arc + 0.01, STRAIGHT + arc + 0.045))


def j_forces(folder, nodes, lumen):
    """Mean forces in the first and in the second second of the J wire's insertion."""
    rows = run_tube(folder, ["instrument=instruments/peer_j_wire.yaml", "vessel.tube.radius=%g" % lumen,
                        "vessel.tube.pieces.1.curvature=0", "vessel.tube.facets_around=96",
                        "vessel.tube.facet_length=2e-3", "sampling.nodes=%d" % nodes, "drive.initial_insertion=0.0042",
                        "drive.travel=0.08", "drive.speed=0.035", "duration=2.2"])
    return mean_force(rows, "time", 0.05, 1.0), mean_force(rows, "time", 1.0, 2.1)


def cases():
    """Name, radius of the bend, of the lumen [m], friction, length of the wire [m], numbers of nodes, measurement."""
    for radius, lumen, friction in BENDS:
        yield ("straight wire in a bend of 90°", radius, lumen, friction, WIRE, BEND_NODES,
               lambda folder, nodes, b=(radius, lumen, friction): bend_forces(folder, nodes, *b))
    for lumen in LUMENS:
        yield ("J wire of peer_wire in a straight tube", math.inf, lumen, 0.1, J_WIRE, J_NODES,
               lambda folder, nodes, r=lumen: j_forces(folder, nodes, r))


def add_arguments(parser):
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder for the table and the runs")


def run(options):
    """Runs all cases and writes the table."""
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for number, (name, radius, lumen, friction, length, counts, measure) in enumerate(cases()):
        reference = None
        for nodes in counts:
            print("%s, case %d, %d nodes …" % (name, number + 1, nodes), file=sys.stderr, flush=True)
            forces = measure(options.out / ("%d_%d" % (number, nodes)), nodes)
            reference = reference or forces
            row = {"case": name, "bend radius [mm]": "%g" % (1e3 * radius), "lumen radius [mm]": "%g" % (1e3 * lumen),
                   "friction": "%g" % friction, "edge [mm]": "%.3g" % (1e3 * length / (nodes - 1))}
            for which, force, exact in zip(("first", "second"), forces, reference):
                row["force of the %s interval [N]" % which] = "%.5f" % force
                row["error of the %s interval" % which] = "%.4f" % (force / exact - 1.0)
            rows.append(row)
            tables.write(options.out / "sampling_error.csv", rows)
