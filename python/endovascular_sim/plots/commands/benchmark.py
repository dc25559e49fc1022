"""Draws the plots of `benchmark` from the CSV files of a folder into that folder."""

import pathlib

import numpy as np

from .. import style, tables

COLOURS = {"kkt": "tab:blue", "paper": "tab:orange", "mixed": "tab:green", "SOFA BeamAdapter": "tab:red",
           "PositionBasedDynamics": "tab:purple", "DisMech": "tab:brown"}
MARKERS = {"kkt": "o", "paper": "s", "mixed": "D", "SOFA BeamAdapter": "^", "PositionBasedDynamics": "v", "DisMech": "P"}


def of_scheme(scheme):
    """Look of the curve of a scheme."""
    return {"color": COLOURS[scheme], "marker": MARKERS[scheme], "label": scheme}


def curve(axes, table, x, y, **look):
    """Draws a line through the points with two positive values."""
    shown = (table[x] > 0) & (table[y] > 0)
    if shown.any():
        axes.plot(table[x][shown], table[y][shown], **look)


def panels(table, *keys, **more):
    """Figure, and its axes with the values of the key columns and the rows that have them."""
    parts = list(tables.groups(table, *keys))
    figure, axes = style.figure(len(parts), **more)
    return figure, [(axis, *part) for axis, part in zip(axes, parts)]


def accuracy(table):
    """Error of the tip over nodes, a panel per problem."""
    figure, parts = panels(table, "problem")
    for axis, (problem,), rows in parts:
        for (scheme,), points in tables.groups(rows, "scheme"):
            curve(axis, points, "nodes", "tip error / L", **of_scheme(scheme))
        style.logarithmic(axis, problem, "nodes", "tip error / L")
        axis.legend()
    return figure


def static(table):
    """Error at rest over the time of a step, a panel per problem."""
    figure, parts = panels(table, "problem")
    for axis, (problem,), rows in parts:
        for (scheme,), points in tables.groups(rows, "scheme"):
            curve(axis, points, "µs per step", "tip error / L", **of_scheme(scheme),
                  linestyle="--" if points["note"][0] == "measured" else "-")
        style.logarithmic(axis, problem, "µs per step of 1 ms", "tip error at rest / L")
        axis.legend()
    return figure


def dynamic(table):
    """Error of the falling wire over computing time, a line per scheme and number of nodes with varying Δt."""
    figure, (axis,) = style.figure(panel=(7.0, 5.0))
    for k, ((scheme, nodes), points) in enumerate(tables.groups(table, "scheme", "nodes")):
        curve(axis, points, "ms for 0.2 s", "tip error / L", **{**of_scheme(scheme), "label": "%s, %g" % (scheme, nodes)},
              alpha=(0.45, 0.7, 1.0)[k % 3])
    style.logarithmic(axis, "falling wire after 0.2 s; lines: Δt from 4 to 0.25 ms", "computing time [ms]", "tip error / L")
    axis.legend()
    return figure


def vessel(table):
    """Distance to the reference over the computing time of a second of motion."""
    figure, (axis,) = style.figure(panel=(7.0, 5.0))
    table["load"] = 1.0 / table["real-time factor"]
    for (scheme, sampling), points in tables.groups(table, "scheme", "sampling"):
        look = of_scheme(scheme)
        look["label"] += ", " + sampling.strip("{}").replace("kind: ", "")
        if "adaptive" in sampling:
            look.update(marker="*", markersize=12, linestyle="--")
        curve(axis, points, "load", "RMS distance [mm]", **look)
    style.logarithmic(axis, "wire in aortic_arch_tree.obj; lines: varying Δt", "computing time per simulated time",
                      "RMS distance to the reference [mm]")
    axis.legend()
    return figure


def speed(table):
    """Time of a step over nodes."""
    figure, (axis,) = style.figure()
    for (scheme,), points in tables.groups(table, "scheme"):
        curve(axis, points, "nodes", "µs per step", **of_scheme(scheme))
    style.logarithmic(axis, "step without contact", "nodes", "µs per step")
    axis.legend()
    return figure


def volumes(table):
    """Time of both queries per bounding volume, a panel per mesh."""
    figure, parts = panels(table, "mesh", "triangles")
    for axis, (mesh, triangles), rows in parts:
        at = np.arange(len(rows["volume"]))
        for shift, key in ((-0.2, "collect [µs]"), (0.2, "nearest [µs]")):
            axis.bar(at + shift, rows[key], width=0.4, label=key)
        axis.set_xticks(at, rows["volume"], rotation=20)
        axis.set(ylabel="µs per query", title="%s, %d triangles" % (mesh, triangles))
        axis.legend()
    return figure


def growth(table):
    """Time of a detection over the number of triangles of one surface."""
    figure, (axis,) = style.figure()
    same = table["mesh"] == table["mesh"][0]
    for key, colour in (("steady [µs]", "tab:blue"), ("cold [µs]", "tab:red"), ("nearest triangle [µs]", "tab:green")):
        curve(axis, tables.select(table, same), "triangles", key, color=colour, marker="o", label=key)
        curve(axis, tables.select(table, ~same), "triangles", key, color=colour, marker="*", markersize=12, linestyle="")
    style.logarithmic(axis, "380 nodes on the wall; stars: aorta_coronary_female.obj", "triangles", "µs")
    axis.legend()
    return figure


def sampling(table):
    """Distance to the reference, the first row of each case, over the time of a step, a panel per case."""
    figure, parts = panels(table, "case")
    for axis, (case,), rows in parts:
        for (name,), points in list(tables.groups(rows, "sampling"))[1:]:
            adaptive = "adaptive" in name
            curve(axis, points, "µs per step", "RMS distance [mm]", marker="*" if adaptive else "o", linestyle="",
                  markersize=13 if adaptive else 7, label=name)
        style.logarithmic(axis, case, "µs per step", "RMS distance to uniform 0.125 mm [mm]")
        axis.set_xscale("linear")  # logarithmic ticks of less than a decade overlap
        axis.legend()
    return figure


def hand_force(table):
    """Force at the hand (C: torque; D: force on the tip) over insertion."""
    shown = {"A": ("pushing speed", "force [mN]", "force at the hand [mN]"),
             "B": ("bending modulus", "force [mN]", "force at the hand [mN]"),
             "C": ("shear modulus, angle of twist", "torque [µN·m]", "torque at the hand [µN·m]"),
             "D": ("shape of the tip", "tip [mN]", "force on the tip [mN]")}
    figure, parts = panels(table, "panel", columns=2)
    for axis, (panel,), rows in parts:
        title, key, label = shown[panel]
        for (name,), points in tables.groups(rows, "curve"):
            axis.plot(points["insertion [mm]"], points[key], label=name)
        axis.set(xlabel="insertion [mm]", ylabel=label, title="%s: %s" % (panel, title))
        axis.legend()
    return figure


def reversal(table):
    """Torque at the hand over the angle of the hand, a panel per case and a line per motion; the first one is the reference."""
    figure, parts = panels(table, "case")
    for axis, (case,), rows in parts:
        look = {"linewidth": 3, "color": "black", "alpha": 0.4}
        for (rate, step), points in tables.groups(rows, "rate [rad/s]", "step [ms]"):
            axis.plot(points["angle [rad]"], points["torque [µN·m]"], label="%g rad/s, %g ms" % (rate, step), **look)
            look = {}
        axis.set(xlabel="angle of the hand [rad]", ylabel="torque at the hand [µN·m]", title=case)
        axis.legend()
    return figure


def mouth(table):
    """Force at the hand over the inserted length while an instrument passes the introducer's mouth."""
    figure, parts = panels(tables.select(table, (table["nodes"] == "adaptive") & (table["speed [mm/s]"] == 25)), "instrument", "tube")
    for axis, (instrument, tube), rows in parts:
        at = rows["inserted length [mm]"]
        axis.plot(at, rows["reference [N]"], color="black", linewidth=3, alpha=0.4, label="reference")
        axis.plot(at, rows["in [N]"], label="in")
        axis.plot(at, rows["out [N]"], "--", label="out")
        axis.set(xlabel="inserted length [mm]", ylabel="force at the hand [N]", title="%s, %s tube" % (instrument, tube))
        axis.legend()
    return figure


# Picture: its table, and how it is drawn.
PICTURES = {"accuracy": ("accuracy", accuracy), "work_precision_static": ("work_precision_static", static),
            "work_precision_dynamic": ("work_precision_dynamic", dynamic), "work_precision_vessel": ("work_precision_vessel", vessel),
            "speed": ("speed_growth", speed), "contact_volumes": ("contact_volumes", volumes),
            "contact_growth": ("contact_growth", growth), "sampling": ("sampling_runs", sampling),
            "hand_force": ("hand_force_curves", hand_force), "reversal": ("reversal_curves", reversal), "mouth": ("mouth", mouth)}


def add_arguments(parser):
    parser.add_argument("folder", type=pathlib.Path, help="folder with the CSV files of `benchmark`")


def run(options):
    """Draws the plots of all tables in the folder; a study that was not run has none."""
    for picture, (name, draw) in PICTURES.items():
        table = tables.read_if_any(options.folder / (name + ".csv"))
        if table:
            style.save(draw(table), options.folder / (picture + ".png"))
