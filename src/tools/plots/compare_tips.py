#!/usr/bin/python3
"""Pushes one wire with a straight, an angled and a semicircular tip through the same vessel and draws the three runs.

Writes tips.png (shapes over time, final positions), tips.csv and a folder of results per run.
"""

import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import tool_support as tools  # noqa: E402

TIPS = {
    "straight": "{shape: straight}",
    "angled": "{shape: angled, radius: 0.010, angle: 0.785398, straight: 0.006}",  # 45°, 14 mm in all
    "semicircle": "{shape: semicircle, radius: 0.006}",
}
SHAPES = 6            # number of drawn shapes of a run
ZOOM = 0.065          # half the width of the close-up around the tips [m]
BRANCH_NEAR = 0.020   # largest distance between the tip and the touched wall of its branch [m]


def read(path):
    """Rows of a CSV file with numbers where the text is a number."""
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    return [{key: value(text) for key, text in row.items()} for row in tools.read_rows(path)]


def run(scene, overrides, tip, folder):
    """Simulates the scene with one tip."""
    done = tools.simulate(scene, folder, overrides + ["instrument.tip=" + TIPS[tip]], "--record", "nodes")
    if done.returncode != 0:
        tools.fail("simulate failed:\n" + done.stderr)


def shapes(folder):
    """Times and polylines of the wire beyond the introducer at equal intervals of the run."""
    frames = {}
    for row in read(folder / "nodes.csv"):
        frames.setdefault(row["time"], []).append(row)
    times = sorted(frames)
    return [(time, frames[time]) for time in (times[len(times) * (k + 1) // SHAPES - 1] for k in range(SHAPES))]


def branch_of(tip, folder):
    """Region of the touched triangle of the wall nearest to a point; empty if all are farther than BRANCH_NEAR."""
    def distance(row):
        return math.dist(tip, (row["x"], row["y"], row["z"]))
    nearest = min(read(folder / "wall_forces.csv"), key=distance, default=None)
    return nearest["region"] if nearest and distance(nearest) < BRANCH_NEAR else ""


def outcome(name, folder):
    """Row of tips.csv."""
    result = tools.read_json(folder / "result.json")
    path = read(folder / "trajectory.csv")
    tip = [path[-1][key] for key in ("tip_x", "tip_y", "tip_z")]
    return {"tip": name, "branch": branch_of(tip, folder), "tip_x": tip[0], "tip_y": tip[1], "tip_z": tip[2],
            "inserted_length": result["inserted_length"], "hand_force_max": result["hand_force"]["max"],
            "hand_force_mean": result["hand_force"]["mean"], "wall_force_peak": result["wall_forces"]["peak"],
            "worst_surface_penetration": result["worst_surface_penetration"],
            "nodes_outside": result["nodes_outside"]}


def draw_view(axes, vessel, drawn, view, colours):
    """Draws the vessel and the shapes of one run along two axes."""
    across, up = view
    axes.plot([1e3 * row[across] for row in vessel], [1e3 * row[up] for row in vessel], ".", color="#d8d4cf",
              markersize=1.2, zorder=1)
    for (time, wire), colour in zip(drawn, colours):
        axes.plot([1e3 * row[across] for row in wire], [1e3 * row[up] for row in wire], color=colour, linewidth=1.6,
                  zorder=2, label="%.1f s" % time)
        axes.plot(1e3 * wire[-1][across], 1e3 * wire[-1][up], "o", color=colour, markersize=3, zorder=3)
    axes.set_aspect("equal")
    axes.set_xlabel(across + " [mm]", fontsize=8)
    axes.tick_params(labelsize=7)


def draw(picture, runs, rows):
    """Draws each run from the front, and close-ups of the final tips from the front and from the side."""
    pyplot = tools.pyplot()
    figure, axes = pyplot.subplots(3, len(runs), figsize=(4.2 * len(runs), 14.5), constrained_layout=True,
                                   gridspec_kw={"height_ratios": (2.4, 1.0, 1.0)})
    colours = pyplot.get_cmap("viridis")([k / (SHAPES - 0.5) for k in range(SHAPES)])
    middle = {key: sum(row["tip_" + key] for row in rows) / len(rows) for key in "xyz"}
    for column, ((name, folder), row) in enumerate(zip(runs.items(), rows)):
        vessel, drawn = read(folder / "vessel_points.csv"), shapes(folder)
        for axis, view in zip(axes[:, column], (("x", "z"), ("x", "z"), ("y", "z"))):
            draw_view(axis, vessel, drawn, view, colours)
        for axis, across in ((axes[1, column], "x"), (axes[2, column], "y")):
            axis.set_xlim(1e3 * (middle[across] - ZOOM), 1e3 * (middle[across] + ZOOM))
            axis.set_ylim(1e3 * (middle["z"] - ZOOM), 1e3 * (middle["z"] + ZOOM))
        axes[0, column].set_title("%s tip: %s\nhand force: at most %.2f N" % (
            name, (row["branch"] or "no branch").replace("_", " "), row["hand_force_max"]), fontsize=9)
        axes[1, column].set_title("close-up, from the front", fontsize=8)
        axes[2, column].set_title("close-up, from the side", fontsize=8)
    axes[0, 0].legend(fontsize=7, loc="upper left")
    axes[0, 0].set_ylabel("z, to the head [mm]", fontsize=8)
    figure.savefig(picture, dpi=75)


def main():
    """Runs the three tips and writes table and picture."""
    parser = tools.argument_parser(__doc__)
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder for tips.png, tips.csv and the runs")
    parser.add_argument("--scene", type=pathlib.Path, help="default: config/scenes/tips.yaml")
    parser.add_argument("--set", action="append", default=[], dest="overrides", metavar="KEY=VALUE",
                        help="replaces a value of the scene in every run; may be repeated")
    arguments = parser.parse_args()
    scene = arguments.scene or tools.find_scene("tips.yaml")
    runs = {name: arguments.out / name for name in TIPS}
    for name, folder in runs.items():
        print("%s tip" % name, flush=True)
        run(scene, arguments.overrides, name, folder)
    rows = [outcome(name, folder) for name, folder in runs.items()]
    with open(arguments.out / "tips.csv", "w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    draw(arguments.out / "tips.png", runs, rows)
    for row in rows:
        print("%-10s %s, hand force at most %.3f N" % (row["tip"], row["branch"] or "no branch",
                                                       row["hand_force_max"]))


if __name__ == "__main__":
    main()
