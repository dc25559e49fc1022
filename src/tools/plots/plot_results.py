#!/usr/bin/python3
"""Draws the results of a session or of `simulate`.

Writes forces.png from instruments.csv (without it, from trajectory.csv), tip_path.png from trajectory.csv, wall_forces.png
from wall_forces.csv and vessel_points.csv, and energy_audit.png from energy_audit.csv, if these exist.
"""

import csv
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import tool_support as tools  # noqa: E402

AXES = {"x": "x, to the left [mm]", "y": "y, to the back [mm]", "z": "z, to the head [mm]"}
VIEWS = (("x", "z", "from the front"), ("y", "z", "from the side"), ("x", "y", "from below"))
STORED = ("kinetic", "bending", "twist", "guide", "wall", "gravity")
DISSIPATED = ("wall_friction", "wall_rolling", "layer_friction", "valve", "damping", "drag")
NUMERICAL = ("inertia", "positions", "twisting", "lengths", "iteration", "contact", "resampling", "rejected")
SUMS = ("work", "stored", "dissipated", "numerical", "error")
COLUMNS = ("time", "insertion", "rotation", "hand_force", "hand_torque", "tip_x", "tip_y", "tip_z")
CURVES = ("time", "insertion", "rotation", "hand_force", "hand_torque")
TIP = "tip_rotation"  # absent in results of earlier versions


def read_trajectory(path):
    """Columns of a trajectory.csv as lists of floats, SI units."""
    if not os.path.isfile(path):
        tools.fail("%s: no such file; give the results folder of a session or of `simulate`" % path)
    columns = {name: [] for name in COLUMNS + (TIP,)}
    with open(path, newline="") as stream:
        reader = csv.DictReader(stream)
        missing = [name for name in COLUMNS if name not in (reader.fieldnames or [])]
        if missing:
            tools.fail("%s: no column %s in the header line" % (path, ", ".join(missing)))
        for row in reader:
            try:
                values = [float(row[name]) for name in COLUMNS] + [float(row.get(TIP, "nan"))]
            except (TypeError, ValueError):
                # The last row of an interrupted session may be incomplete.
                tools.warn("%s: line %d skipped: not a number in every column" % (path, reader.line_num))
                continue
            for name, value in zip(COLUMNS + (TIP,), values):
                columns[name].append(value)
    if not columns["time"]:
        tools.fail("%s: no row; the session ended before the first one" % path)
    return columns


def read_columns(path, names):
    """Columns of a CSV file as lists of floats; None without the file or without numbers in these columns."""
    if not os.path.isfile(path):
        return None
    rows = list(tools.read_rows(path))
    try:
        return {name: [float(row[name]) for row in rows] for name in names}
    except (KeyError, TypeError, ValueError):
        tools.warn("%s: not plotted: not a number in every column" % path)
        return None


def read_instruments(path):
    """Curves of instruments.csv by instrument, in the order of the scene; None without the file."""
    if not os.path.isfile(path):
        return None
    curves = {}
    for row in tools.read_rows(path):
        try:
            values = [float(row[name]) for name in CURVES] + [float(row.get(TIP, "nan"))]
        except (KeyError, TypeError, ValueError):
            continue  # the last row of an interrupted session may be incomplete
        curve = curves.setdefault(row["instrument"], {name: [] for name in CURVES + (TIP,)})
        for name, value in zip(CURVES + (TIP,), values):
            curve[name].append(value)
    return curves or None


def plot_forces(pyplot, curves, path):
    """Draws force and torque at every handle over time, force over insertion, and over time insertion and the rotations of
    handle (dotted) and tip (dashed).

    `curves`: values of CURVES and TIP by instrument. Outside of the introducer an instrument has no force: its curves have a gap."""
    figure, axes = pyplot.subplots(2, 2, figsize=(11, 7), constrained_layout=True)
    rotation = axes[1, 1].twinx()
    for k, (name, data) in enumerate(curves.items()):
        colour = "C%d" % k
        inside = [value > 0.0 for value in data["insertion"]]

        def shown(values, scale=1.0):
            return [scale * value if one else float("nan") for value, one in zip(values, inside)]

        insertion = shown(data["insertion"], 1e3)
        style = {"linewidth": 0.8, "color": colour, "label": name.replace("_", " ")}
        axes[0, 0].plot(data["time"], shown(data["hand_force"]), **style)
        axes[0, 1].plot(insertion, shown(data["hand_force"]), **style)
        axes[1, 0].plot(data["time"], shown(data["hand_torque"], 1e3), **style)
        axes[1, 1].plot(data["time"], insertion, **style)
        rotation.plot(data["time"], shown(data["rotation"]), linewidth=0.8, color=colour, linestyle=":")
        rotation.plot(data["time"], shown(data[TIP]), linewidth=0.8, color=colour, linestyle="--")
    axes[0, 0].set(xlabel="time [s]", ylabel="force at the handle [N]")
    axes[0, 1].set(xlabel="insertion [mm]", ylabel="force at the handle [N]")
    axes[1, 0].set(xlabel="time [s]", ylabel="torque at the handle [mN·m]")
    axes[1, 1].set(xlabel="time [s]", ylabel="insertion [mm]")
    rotation.set_ylabel("rotation of handle (dotted) and tip (dashed) [rad]")
    axes[0, 0].legend(fontsize="small")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def plot_tip_path(pyplot, data, path):
    """Draws the path of the tip from the front, from the side and from below (patient frame)."""
    figure, axes = pyplot.subplots(1, 3, figsize=(13, 5), constrained_layout=True)
    for axis, (across, up, title) in zip(axes, VIEWS):
        horizontal = [1e3 * value for value in data["tip_" + across]]
        vertical = [1e3 * value for value in data["tip_" + up]]
        axis.plot(horizontal, vertical, linewidth=0.9)
        axis.plot(horizontal[0], vertical[0], "o", label="start")
        axis.plot(horizontal[-1], vertical[-1], "s", label="end")
        axis.set(xlabel=AXES[across], ylabel=AXES[up], title=title)
        axis.set_aspect("equal", adjustable="datalim")
        axis.grid(alpha=0.3)
    axes[0].legend()
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def plot_wall_forces(pyplot, wall, forces, path):
    """Draws the vessel as grey points, and its touched triangles coloured by the largest force at one contact."""
    from matplotlib.colors import LinearSegmentedColormap
    # Colours of rviz; the scale ends at the largest force of the run.
    colours = LinearSegmentedColormap.from_list("force", ["#ffe633", "#ff800d", "#d90d0d"])
    order = sorted(range(len(forces["peak"])), key=lambda k: forces["peak"][k])  # the largest on top
    peaks = [forces["peak"][k] for k in order]
    figure, axes = pyplot.subplots(1, 3, figsize=(13, 5), constrained_layout=True)
    for axis, (across, up, title) in zip(axes, VIEWS):
        axis.plot([1e3 * value for value in wall[across]], [1e3 * value for value in wall[up]], ".", color="0.8",
                  markersize=1.5, markeredgewidth=0)
        touched = axis.scatter([1e3 * forces[across][k] for k in order], [1e3 * forces[up][k] for k in order], c=peaks,
                               s=14, linewidths=0, cmap=colours, vmin=0.0, vmax=max(peaks, default=1.0), zorder=2)
        axis.set(xlabel=AXES[across], ylabel=AXES[up], title=title)
        axis.set_aspect("equal", adjustable="datalim")
    figure.colorbar(touched, ax=axes, label="largest force at one contact [N]", shrink=0.8)
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def plot_energy_audit(pyplot, audit, path):
    """Draws the balance of the energy and its terms over time."""
    figure, axes = pyplot.subplots(2, 2, figsize=(12, 8), constrained_layout=True)
    panels = (("balance", SUMS), ("stored", STORED), ("dissipated", DISSIPATED), ("numerical", NUMERICAL + ("error",)))
    for axis, (title, names) in zip(axes.flat, panels):
        for name in names:
            if name in SUMS or any(audit[name]):
                axis.plot(audit["time"], [1e3 * value for value in audit[name]], linewidth=0.9, label=name)
        axis.set(xlabel="time [s]", ylabel="energy [mJ]", title=title)
        axis.grid(alpha=0.3)
        axis.legend(fontsize="small")
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def main():
    """Reads the results and writes the pictures."""
    parser = tools.argument_parser(__doc__)
    parser.add_argument("folder", help="folder with trajectory.csv")
    parser.add_argument("--out", metavar="DIR", help="folder for the pictures [the same folder]")
    arguments = parser.parse_args()

    data = read_trajectory(os.path.join(arguments.folder, "trajectory.csv"))
    out = arguments.out or arguments.folder
    pyplot = tools.pyplot()
    try:
        os.makedirs(out, exist_ok=True)
        curves = read_instruments(os.path.join(arguments.folder, "instruments.csv"))
        plot_forces(pyplot, curves or {"instrument": data}, os.path.join(out, "forces.png"))
        plot_tip_path(pyplot, data, os.path.join(out, "tip_path.png"))
        forces = read_columns(os.path.join(arguments.folder, "wall_forces.csv"), ("x", "y", "z", "peak"))
        wall = read_columns(os.path.join(arguments.folder, "vessel_points.csv"), ("x", "y", "z"))
        if forces and wall:
            plot_wall_forces(pyplot, wall, forces, os.path.join(out, "wall_forces.png"))
        audit = read_columns(os.path.join(arguments.folder, "energy_audit.csv"),
                             ("time",) + SUMS + STORED + DISSIPATED + NUMERICAL)
        if audit:
            plot_energy_audit(pyplot, audit, os.path.join(out, "energy_audit.png"))
    except OSError as error:
        tools.fail("%s" % error)
    return 0


if __name__ == "__main__":
    sys.exit(main())
