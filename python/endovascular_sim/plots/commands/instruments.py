"""Draws instruments from the tables of `instrument_shape`.

Up to five instruments: for each one the rest shape from two sides, diameter and bending stiffness along the shaft with the radiopaque
markers, and the compliance chart of a balloon or the length of a stent. More: a sheet of all tips to a common scale, and of all shafts.
"""

import pathlib

import numpy as np

from .. import library, style, tables
from ..command import Failure

COLOURS = {"steel": "#4c6a92", "nitinol": "#b07d2b", "platinum": "#111111", "polymer": "#8a8f98",
           "filled_polymer": "#5f6670"}
SHOWN_STRAIGHT = 0.020   # drawn length of straight shaft proximal to the first curve [m]
SHOWN_LEAST = 0.060      # minimum drawn length of an instrument [m]
ATMOSPHERE = 101325.0    # standard atmosphere [Pa]
MOST_ROWS = 5            # instruments with a row of their own
FILES = {"shaft": "shaft.csv", "markers": "shaft_markers.csv", "balloon": "shaft_balloon.csv", "stent": "shaft_stent.csv"}


def read_by_instrument(path):
    """Tables by instrument, in the order of the file; empty without the file."""
    table = tables.read_if_any(path, ("instrument",))
    return {name: rows for (name,), rows in tables.groups(table, "instrument")} if table else {}


def shown_from(shaft):
    """Arc length from which a shape is drawn: the curved part and SHOWN_STRAIGHT proximal to it [m]."""
    arc = shaft["arc_length"]
    curved = arc[np.abs(shaft["x"]) + np.abs(shaft["y"]) > 1e-9]
    begin = curved[0] if len(curved) else arc[-1]
    return max(0.0, min(begin - SHOWN_STRAIGHT, arc[-1] - SHOWN_LEAST))


def pieces(shaft):
    """Runs of consecutive points of one material; each run includes the last point of the preceding one."""
    material = shaft["material"][1:]
    bounds = np.flatnonzero(material[1:] != material[:-1]) + 1
    for begin, end in zip([0, *bounds], [*bounds, len(material)]):
        yield material[begin], tables.select(shaft, slice(begin, end + 1))


def draw_view(axes, shaft, markers, across, title):
    """Draws the rest shape, the proximal side below."""
    shown = tables.select(shaft, shaft["arc_length"] >= shown_from(shaft))
    base, tip = shown["z"][0], shaft["arc_length"][-1]

    def draw(rows, width, colour):
        axes.plot(1e3 * rows[across], 1e3 * (rows["z"] - base), color=colour, linewidth=width, solid_capstyle="butt")

    for material, rows in pieces(shown):
        draw(rows, 1.0 + 1.5e3 * rows["diameter"][-1], COLOURS[material])
    for from_tip, length in zip(markers.get("from_tip", ()), markers.get("length", ())):
        end = tip - from_tip
        covered = (shaft["arc_length"] >= end - length - 5e-4) & (shaft["arc_length"] <= end + 5e-4)
        draw(tables.select(shaft, covered), 2.5 + 1.5e3 * shown["diameter"][-1], "black")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(title)


def draw_shaft(axes, shaft, markers, balloon):
    """Draws diameter, lumen (dotted) and bending stiffness of the distal 250 mm over the distance from the tip."""
    tip = shaft["arc_length"][-1]
    from_tip = 1e3 * (tip - shaft["arc_length"])
    axes.step(from_tip, 1e3 * shaft["diameter"], color="#8a8f98", where="pre")
    if shaft["inner_diameter"][-1] > 0.0:
        axes.step(from_tip, 1e3 * shaft["inner_diameter"], color="#8a8f98", where="pre", linestyle=":")
    for spans, look in ((markers, {"color": "black", "alpha": 0.6}), (balloon, {"color": "#2a7f62", "alpha": 0.15})):
        for begin, length in set(zip(spans.get("from_tip", ()), spans.get("length", ()))):
            axes.axvspan(1e3 * begin, 1e3 * (begin + length), **look)
    axes.set(ylim=(0.0, 1.1e3 * shaft["diameter"].max()), xlim=(min(250.0, 1e3 * tip), 0.0), xlabel="from the tip [mm]")
    axes.set_ylabel("diameter [mm]", color="#6a6f78")
    right = axes.twinx()
    right.step(from_tip, 1e6 * shaft["bending_stiffness"], color="#b03a2e", where="pre")
    right.set(yscale="log", ylim=(0.5, 6000.0))
    right.set_ylabel("EI [N·mm²]", color="#b03a2e")
    right.grid(False)


def draw_balloon(axes, balloon):
    """Draws diameter over pressure, with nominal and rated burst pressure."""
    axes.plot(balloon["pressure"] / ATMOSPHERE, 1e3 * balloon["diameter"], color="#2a7f62")
    for key, colour in (("nominal_pressure", "#2a7f62"), ("rated_burst_pressure", "#b03a2e")):
        axes.axvline(balloon[key][0] / ATMOSPHERE, color=colour, linestyle="--", linewidth=0.8)
    axes.set(xlabel="pressure [atm]; nominal, rated burst", ylabel="balloon [mm]")


def draw_stent(axes, stent):
    """Draws length over inner diameter."""
    axes.plot(1e3 * stent["diameter"], 1e3 * stent["length"], "o-", color="#4c6a92", markersize=3)
    axes.axvline(1e3 * stent["nominal_diameter"][0], color="#4c6a92", linestyle="--", linewidth=0.8)
    axes.set(ylim=(0.0, 1.2e3 * stent["length"][0]), xlabel="inner diameter [mm]; nominal", ylabel="stent's length [mm]")


def draw_row(axes, name, shaft, markers, balloon, stent):
    """Draws one instrument in a row of four axes; what it has not is an empty table."""
    if shaft:
        draw_view(axes[0], shaft, markers, "y", name)
        draw_view(axes[1], shaft, markers, "x", "from the side [mm]")
        draw_shaft(axes[2], shaft, markers, balloon)
    else:
        axes[0].set_title(name)
    if balloon:
        draw_balloon(axes[3], balloon)
    elif stent:
        draw_stent(axes[3], stent)
    for each in axes:
        if not each.has_data():
            each.axis("off")


def rows_of(names, found):
    """Figure with a row per instrument."""
    figure, axes = style.figure(4 * len(names), columns=4, panel=(2.3, 1.9), font=7, gridspec_kw={"width_ratios": (1.0, 0.6, 1.2, 1.0)})
    for k, name in enumerate(names):
        draw_row(axes[4 * k:4 * k + 4], name, *(found[key].get(name, {}) for key in FILES))
    return figure


def add_arguments(parser):
    parser.add_argument("folder", type=pathlib.Path, help="folder with the tables of `instrument_shape --out shaft.csv`")
    parser.add_argument("picture", help="PNG or SVG file to write")


def run(options):
    """Reads the tables and writes the picture."""
    found = {key: read_by_instrument(options.folder / file) for key, file in FILES.items()}
    names = list(dict.fromkeys([*found["shaft"], *found["stent"]]))
    if not names:
        raise Failure("%s: no instrument in shaft.csv" % options.folder)
    figure = rows_of(names, found) if len(names) <= MOST_ROWS else library.draw(*(found[key] for key in FILES))
    try:
        style.save(figure, options.picture)
    except (OSError, ValueError) as error:
        raise Failure("%s: cannot be written: %s" % (options.picture, error)) from error
