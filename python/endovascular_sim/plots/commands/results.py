"""Draws the results of a session or of `simulate`.

Writes forces.png from instruments.csv (without it, from trajectory.csv), tip_path.png from trajectory.csv, wall_forces.png
from wall_forces.csv and vessel_points.csv, and energy_audit.png from energy_audit.csv, if these exist.
"""

import pathlib

import numpy as np

from .. import style, tables
from ..command import Failure

STORED = ("kinetic", "bending", "twist", "guide", "wall", "gravity")
DISSIPATED = ("wall_friction", "wall_rolling", "layer_friction", "valve", "damping", "drag")
NUMERICAL = ("inertia", "positions", "twisting", "lengths", "iteration", "contact", "resampling", "rejected")
SUMS = ("work", "stored", "dissipated", "numerical", "error")
CURVES = ("time", "insertion", "rotation", "hand_force", "hand_torque")


def curves_of(folder):
    """Curves by instrument, in the order of the scene; of the innermost one only, without instruments.csv."""
    table = tables.read_if_any(folder / "instruments.csv", ("instrument",) + CURVES)
    if table is None:
        return {"instrument": tables.read(folder / "trajectory.csv", CURVES)}
    return {name: rows for (name,), rows in tables.groups(table, "instrument")}


def draw_forces(curves):
    """Force and torque at every handle over time, force over insertion, and over time insertion and the rotations of
    handle (dotted) and tip (dashed). Outside of the introducer an instrument has no force: its curves have a gap."""
    figure, (force, over_insertion, torque, motion) = style.figure(4, columns=2, panel=(5.5, 3.5))
    rotation = motion.twinx()
    rotation.grid(False)
    for k, (name, data) in enumerate(curves.items()):
        look = {"linewidth": 0.8, "color": "C%d" % k}
        inside = {key: np.where(data["insertion"] > 0.0, column, np.nan) for key, column in data.items() if key != "instrument"}
        force.plot(data["time"], inside["hand_force"], label=name.replace("_", " "), **look)
        over_insertion.plot(1e3 * inside["insertion"], inside["hand_force"], **look)
        torque.plot(data["time"], 1e3 * inside["hand_torque"], **look)
        motion.plot(data["time"], 1e3 * inside["insertion"], **look)
        rotation.plot(data["time"], inside["rotation"], linestyle=":", **look)
        if "tip_rotation" in inside:  # absent in results of earlier versions
            rotation.plot(data["time"], inside["tip_rotation"], linestyle="--", **look)
    force.set(xlabel="time [s]", ylabel="force at the handle [N]")
    over_insertion.set(xlabel="insertion [mm]", ylabel="force at the handle [N]")
    torque.set(xlabel="time [s]", ylabel="torque at the handle [mN·m]")
    motion.set(xlabel="time [s]", ylabel="insertion [mm]")
    rotation.set_ylabel("rotation of handle (dotted) and tip (dashed) [rad]")
    force.legend()
    return figure


def draw_tip_path(data):
    """Path of the tip from the front, from the side and from below."""
    figure, axes = style.figure(3, panel=(4.3, 5.0))
    tip = {axis: data["tip_" + axis] for axis in "xyz"}
    for axis, (title, view) in zip(axes, style.VIEWS.items()):
        style.draw_along(axis, tip, view, linewidth=0.9)
        for k, marker, name in ((0, "o", "start"), (-1, "s", "end")):
            style.draw_along(axis, {key: column[k] for key, column in tip.items()}, view, marker, label=name)
        axis.set_title(title)
    axes[0].legend()
    return figure


def draw_wall_forces(wall, forces):
    """Vessel as grey points, and its touched triangles coloured by the largest force at one contact."""
    figure, axes = style.figure(3, panel=(4.3, 5.0))
    from matplotlib.colors import LinearSegmentedColormap
    # Colours of rviz; the scale ends at the largest force of the run.
    colours = LinearSegmentedColormap.from_list("force", ["#ffe633", "#ff800d", "#d90d0d"])
    forces = tables.select(forces, np.argsort(forces["peak"], kind="stable"))  # the largest on top
    for axis, (title, view) in zip(axes, style.VIEWS.items()):
        style.draw_along(axis, wall, view, ".", color="0.8", markersize=1.5, markeredgewidth=0)
        touched = axis.scatter(*(1e3 * forces[key] for key in view), c=forces["peak"], s=14, linewidths=0, cmap=colours,
                               vmin=0.0, vmax=max(forces["peak"], default=1.0), zorder=2)
        axis.set_title(title)
        axis.grid(False)
    figure.colorbar(touched, ax=axes, label="largest force at one contact [N]", shrink=0.8)
    return figure


def draw_energy_audit(audit):
    """Balance of the energy and its terms over time."""
    figure, axes = style.figure(4, columns=2, panel=(6.0, 4.0))
    panels = {"balance": SUMS, "stored": STORED, "dissipated": DISSIPATED, "numerical": NUMERICAL + ("error",)}
    for axis, (title, names) in zip(axes, panels.items()):
        for name in names:
            if name in SUMS or audit[name].any():
                axis.plot(audit["time"], 1e3 * audit[name], linewidth=0.9, label=name)
        axis.set(xlabel="time [s]", ylabel="energy [mJ]", title=title)
        axis.legend()
    return figure


def add_arguments(parser):
    parser.add_argument("folder", type=pathlib.Path, help="folder with trajectory.csv")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="folder for the pictures [the same folder]")


def run(options):
    """Reads the results and writes the pictures."""
    folder, out = options.folder, options.out or options.folder
    if not (folder / "trajectory.csv").is_file():
        raise Failure("%s: no such file; give the results folder of a session or of `simulate`" % (folder / "trajectory.csv"))
    path = tables.read_if_any(folder / "trajectory.csv", CURVES + ("tip_x", "tip_y", "tip_z"))
    if path is None:
        raise Failure("%s: no row; the session ended before the first one" % (folder / "trajectory.csv"))
    out.mkdir(parents=True, exist_ok=True)
    style.save(draw_forces(curves_of(folder)), out / "forces.png")
    style.save(draw_tip_path(path), out / "tip_path.png")
    forces = (tables.read(folder / "wall_forces.csv", ("x", "y", "z", "peak"))  # also of a wire that touched nothing
              if (folder / "wall_forces.csv").is_file() else None)
    wall = tables.read_if_any(folder / "vessel_points.csv", ("x", "y", "z"))
    if forces and wall:
        style.save(draw_wall_forces(wall, forces), out / "wall_forces.png")
    audit = tables.read_if_any(folder / "energy_audit.csv", ("time",) + SUMS + STORED + DISSIPATED + NUMERICAL)
    if audit:
        style.save(draw_energy_audit(audit), out / "energy_audit.png")
