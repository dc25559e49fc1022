#!/usr/bin/python3
"""Draws the results of a session or of `simulate`: forces.png and tip_path.png from trajectory.csv."""

import argparse
import csv
import os
import sys

COLUMNS = ("time", "insertion", "rotation", "hand_force", "hand_torque", "tip_x", "tip_y", "tip_z")


def fail(message):
    """Ends the program with a message for the user."""
    sys.exit("plot_results.py: " + message)


def read_trajectory(path):
    """Columns of a trajectory.csv as lists of floats, SI units."""
    if not os.path.isfile(path):
        fail("%s: there is no such file; give the folder that a session or `simulate` wrote" % path)
    columns = {name: [] for name in COLUMNS}
    with open(path, newline="") as stream:
        reader = csv.DictReader(stream)
        missing = [name for name in COLUMNS if name not in (reader.fieldnames or [])]
        if missing:
            fail("%s: no column %s in the head line" % (path, ", ".join(missing)))
        for row in reader:
            try:
                values = [float(row[name]) for name in COLUMNS]
            except (TypeError, ValueError):
                # The last row of a session that was cut off may be half written.
                print("plot_results.py: %s: line %d left out: not a number in every column"
                      % (path, reader.line_num), file=sys.stderr)
                continue
            for name, value in zip(COLUMNS, values):
                columns[name].append(value)
    if not columns["time"]:
        fail("%s: no row; the session ended before the first one" % path)
    return columns


def plot_forces(pyplot, data, path):
    """Force and torque at the hand over time, force over insertion."""
    figure, axes = pyplot.subplots(2, 2, figsize=(11, 7), constrained_layout=True)
    millimetres = [1e3 * value for value in data["insertion"]]
    axes[0, 0].plot(data["time"], data["hand_force"], linewidth=0.8)
    axes[0, 0].set(xlabel="time [s]", ylabel="force at the hand [N]")
    axes[0, 1].plot(millimetres, data["hand_force"], linewidth=0.8)
    axes[0, 1].set(xlabel="insertion [mm]", ylabel="force at the hand [N]")
    axes[1, 0].plot(data["time"], [1e3 * value for value in data["hand_torque"]], linewidth=0.8)
    axes[1, 0].set(xlabel="time [s]", ylabel="torque at the hand [mN·m]")
    axes[1, 1].plot(data["time"], millimetres, linewidth=0.8, label="insertion [mm]")
    rotation = axes[1, 1].twinx()
    rotation.plot(data["time"], data["rotation"], linewidth=0.8, color="tab:orange")
    rotation.set_ylabel("rotation [rad]", color="tab:orange")
    axes[1, 1].set(xlabel="time [s]", ylabel="insertion [mm]")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def plot_tip_path(pyplot, data, path):
    """The tip's path from the front, from the side and from above (patient frame)."""
    labels = {"tip_x": "x, to the left [mm]", "tip_y": "y, to the back [mm]", "tip_z": "z, to the head [mm]"}
    views = (("tip_x", "tip_z", "from the front"), ("tip_y", "tip_z", "from the side"), ("tip_x", "tip_y", "from below"))
    figure, axes = pyplot.subplots(1, 3, figsize=(13, 5), constrained_layout=True)
    for axis, (across, up, title) in zip(axes, views):
        horizontal = [1e3 * value for value in data[across]]
        vertical = [1e3 * value for value in data[up]]
        axis.plot(horizontal, vertical, linewidth=0.9)
        axis.plot(horizontal[0], vertical[0], "o", label="start")
        axis.plot(horizontal[-1], vertical[-1], "s", label="end")
        axis.set(xlabel=labels[across], ylabel=labels[up], title=title)
        axis.set_aspect("equal", adjustable="datalim")
        axis.grid(alpha=0.3)
    axes[0].legend()
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", help="folder with trajectory.csv")
    parser.add_argument("--out", metavar="DIR", help="where the pictures go (default: the same folder)")
    arguments = parser.parse_args()

    data = read_trajectory(os.path.join(arguments.folder, "trajectory.csv"))
    out = arguments.out or arguments.folder
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
    except ImportError as error:
        fail("%s; install the Debian package python3-matplotlib and run with /usr/bin/python3" % error)
    try:
        os.makedirs(out, exist_ok=True)
        plot_forces(pyplot, data, os.path.join(out, "forces.png"))
        plot_tip_path(pyplot, data, os.path.join(out, "tip_path.png"))
    except OSError as error:
        fail("%s" % error)
    return 0


if __name__ == "__main__":
    sys.exit(main())
