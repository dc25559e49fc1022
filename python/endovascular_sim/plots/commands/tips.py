"""Pushes one wire with a straight, an angled and a semicircular tip through the same vessel and draws the three runs.

Writes tips.png (shapes over time, final positions), tips.csv and a folder of results per run.
"""

import pathlib
import sys

import numpy as np

from .. import command, style, tables

TIPS = {
    "straight": "{shape: straight}",
    "angled": "{shape: angled, radius: 0.010, angle: 0.785398, straight: 0.006}",  # 45°, 14 mm in all
    "semicircle": "{shape: semicircle, radius: 0.006}",
}
SHAPES = 6            # number of drawn shapes of a run
ZOOM = 0.065          # half the width of the close-up around the tips [m]
BRANCH_NEAR = 0.020   # largest distance between the tip and the touched wall of its branch [m]


def shapes(folder):
    """Times and nodes of the wire beyond the introducer at equal intervals of the run."""
    nodes = tables.read(folder / "nodes.csv")
    times = np.unique(nodes["time"])
    return [(time, tables.select(nodes, nodes["time"] == time))
            for time in (times[len(times) * (k + 1) // SHAPES - 1] for k in range(SHAPES))]


def branch_of(tip, folder):
    """Region of the touched triangle of the wall nearest to a point; empty if all are farther than BRANCH_NEAR."""
    forces = tables.read_if_any(folder / "wall_forces.csv")
    if not forces:
        return ""
    distance = np.linalg.norm(np.stack([forces[key] for key in "xyz"], axis=1) - tip, axis=1)
    return forces["region"][distance.argmin()] if distance.min() < BRANCH_NEAR else ""


def outcome(name, folder):
    """Row of tips.csv."""
    result = tables.read_json(folder / "result.json")
    path = tables.read(folder / "trajectory.csv")
    tip = [path["tip_" + key][-1] for key in "xyz"]
    return {"tip": name, "branch": branch_of(tip, folder), "tip_x": tip[0], "tip_y": tip[1], "tip_z": tip[2],
            "inserted_length": result["inserted_length"], "hand_force_max": result["hand_force"]["max"],
            "hand_force_mean": result["hand_force"]["mean"], "wall_force_peak": result["wall_forces"]["peak"],
            "worst_surface_penetration": result["worst_surface_penetration"],
            "nodes_outside": result["nodes_outside"]}


def draw_view(axes, vessel, drawn, view, colours):
    """Draws the vessel and the shapes of one run along two axes."""
    style.draw_along(axes, vessel, view, ".", color="#d8d4cf", markersize=1.2, zorder=1)
    for (time, wire), colour in zip(drawn, colours):
        style.draw_along(axes, wire, view, color=colour, linewidth=1.6, zorder=2, label="%.1f s" % time)
        style.draw_along(axes, tables.select(wire, slice(-1, None)), view, "o", color=colour, markersize=3, zorder=3)


def draw(runs, rows):
    """Each run from the front, and close-ups of the final tips from the front and from the side."""
    figure, axes = style.figure(3 * len(runs), columns=len(runs), panel=(4.2, 4.8), gridspec_kw={"height_ratios": (2.4, 1.0, 1.0)})
    colours = style.pyplot().get_cmap("viridis")([k / (SHAPES - 0.5) for k in range(SHAPES)])
    middle = {key: np.mean([row["tip_" + key] for row in rows]) for key in "xyz"}
    for column, ((name, folder), row) in enumerate(zip(runs.items(), rows)):
        vessel, drawn = tables.read(folder / "vessel_points.csv"), shapes(folder)
        views = ("from the front", "from the front", "from the side")
        whole, *close = [axes[column + k * len(runs)] for k in range(3)]
        for axis, view in zip((whole, *close), views):
            draw_view(axis, vessel, drawn, style.VIEWS[view], colours)
        whole.set_aspect("equal")
        whole.set_title("%s tip: %s\nhand force: at most %.2f N" % (
            name, (row["branch"] or "no branch").replace("_", " "), row["hand_force_max"]))
        for axis, view in zip(close, views[1:]):
            across, up = style.VIEWS[view]
            axis.set_aspect("equal")
            axis.set(xlim=(1e3 * (middle[across] - ZOOM), 1e3 * (middle[across] + ZOOM)),
                     ylim=(1e3 * (middle[up] - ZOOM), 1e3 * (middle[up] + ZOOM)), title="close-up, " + view)
    axes[0].legend(loc="upper left")
    return figure


def add_arguments(parser):
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder for tips.png, tips.csv and the runs")
    parser.add_argument("--scene", type=pathlib.Path, help="default: config/scenes/tips.yaml")
    command.add_overrides(parser)


def compare(out, scene=None, overrides=()):
    """Runs the three tips into a folder; returns the folder and the row of each."""
    scene = scene or command.find_scene("tips.yaml")
    runs = {name: out / name for name in TIPS}
    for name, folder in runs.items():
        print("%s tip" % name, file=sys.stderr, flush=True)
        command.simulate(scene, folder, [*overrides, "instrument.tip=" + TIPS[name]], "--record", "nodes")
    return runs, [outcome(name, folder) for name, folder in runs.items()]


def run(options):
    """Runs the three tips and writes table and picture."""
    runs, rows = compare(options.out, options.scene, options.overrides)
    tables.write(options.out / "tips.csv", rows)
    style.save(draw(runs, rows), options.out / "tips.png")
    for row in rows:
        print("%-10s %s, hand force at most %.3f N" % (row["tip"], row["branch"] or "no branch", row["hand_force_max"]))
