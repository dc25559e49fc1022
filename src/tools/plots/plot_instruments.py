#!/usr/bin/python3
"""Draws instruments from the tables of `instrument_shape`.

Per instrument: the rest shape from two sides, diameter and bending stiffness along the shaft with the radiopaque markers,
and the compliance chart of a balloon or the length of a stent.
"""

import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import tool_support as tools  # noqa: E402

COLOURS = {"steel": "#4c6a92", "nitinol": "#b07d2b", "platinum": "#111111", "polymer": "#8a8f98",
           "filled_polymer": "#5f6670"}
SHOWN_STRAIGHT = 0.020   # drawn length of straight shaft proximal to the first curve [m]
SHOWN_LEAST = 0.060      # minimum drawn length of an instrument [m]
ATMOSPHERE = 101325.0    # standard atmosphere [Pa]


def read_table(path, text_columns):
    """Rows of a CSV file by instrument, in the order of the file; all columns but the text columns are numbers."""
    table = {}
    if not os.path.isfile(path):
        return table
    for row in tools.read_rows(path):
        name = row.pop("instrument")
        table.setdefault(name, []).append(
            {key: value if key in text_columns else float(value) for key, value in row.items()})
    return table


def shown_from(shaft):
    """Arc length from which a shape is drawn: the curved part and SHOWN_STRAIGHT proximal to it [m]."""
    length = shaft[-1]["arc_length"]
    curved = [row["arc_length"] for row in shaft if abs(row["x"]) + abs(row["y"]) > 1e-9]
    begin = curved[0] if curved else length
    return max(0.0, min(begin - SHOWN_STRAIGHT, length - SHOWN_LEAST))


def pieces(shaft):
    """Runs of consecutive points of one material; each run includes the last point of the preceding one."""
    runs = []
    for before, row in zip(shaft, shaft[1:]):
        if not runs or runs[-1][0] != row["material"]:
            runs.append((row["material"], [before]))
        runs[-1][1].append(row)
    return runs


def marked(shaft, marker):
    """Points of a shaft covered by a marker."""
    length = shaft[-1]["arc_length"]
    end = length - marker["from_tip"]
    rows = [row for row in shaft if end - marker["length"] - 5e-4 <= row["arc_length"] <= end + 5e-4]
    return rows


def draw_view(axes, shaft, markers, across, title):
    """Draws the rest shape, the proximal side below."""
    begin = shown_from(shaft)
    shown = [row for row in shaft if row["arc_length"] >= begin]
    base = shown[0]["z"]

    def coordinates(rows):
        return [1e3 * row[across] for row in rows], [1e3 * (row["z"] - base) for row in rows]

    for material, rows in pieces(shown):
        axes.plot(*coordinates(rows), color=COLOURS[material], linewidth=1.0 + 1.5e3 * rows[-1]["diameter"],
                  solid_capstyle="butt")
    for marker in markers:
        axes.plot(*coordinates(marked(shaft, marker)), color="black", linewidth=2.5 + 1.5e3 * shown[-1]["diameter"],
                  solid_capstyle="butt")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(title, fontsize=7)


def draw_shaft(axes, shaft, markers, balloon):
    """Draws diameter, lumen (dotted) and bending stiffness of the distal 250 mm over the distance from the tip."""
    tip = shaft[-1]["arc_length"]
    from_tip = [1e3 * (tip - row["arc_length"]) for row in shaft]
    axes.step(from_tip, [1e3 * row["diameter"] for row in shaft], color="#8a8f98", where="pre")
    if shaft[-1]["inner_diameter"] > 0.0:
        axes.step(from_tip, [1e3 * row["inner_diameter"] for row in shaft], color="#8a8f98", where="pre",
                  linestyle=":")
    for marker in markers:
        axes.axvspan(1e3 * marker["from_tip"], 1e3 * (marker["from_tip"] + marker["length"]), color="black", alpha=0.6)
    if balloon:
        axes.axvspan(1e3 * balloon[0]["from_tip"], 1e3 * (balloon[0]["from_tip"] + balloon[0]["length"]),
                     color="#2a7f62", alpha=0.15)
    axes.set_ylim(0.0, 1.1e3 * max(row["diameter"] for row in shaft))
    axes.set_ylabel("diameter [mm]", fontsize=7, color="#6a6f78")
    axes.set_xlim(min(250.0, 1e3 * tip), 0.0)
    axes.set_xlabel("from the tip [mm]", fontsize=7)
    right = axes.twinx()
    right.step(from_tip, [1e6 * row["bending_stiffness"] for row in shaft], color="#b03a2e", where="pre")
    right.set_yscale("log")
    right.set_ylim(0.5, 6000.0)
    right.set_ylabel("EI [N·mm²]", fontsize=7, color="#b03a2e")
    right.tick_params(labelsize=6)


def draw_balloon(axes, rows):
    """Draws diameter over pressure, with nominal and rated burst pressure."""
    axes.plot([row["pressure"] / ATMOSPHERE for row in rows], [1e3 * row["diameter"] for row in rows], color="#2a7f62")
    for key, colour in (("nominal_pressure", "#2a7f62"), ("rated_burst_pressure", "#b03a2e")):
        axes.axvline(rows[0][key] / ATMOSPHERE, color=colour, linestyle="--", linewidth=0.8)
    axes.set_xlabel("pressure [atm]; nominal, rated burst", fontsize=7)
    axes.set_ylabel("balloon [mm]", fontsize=7)


def draw_stent(axes, rows):
    """Draws length over inner diameter."""
    axes.plot([1e3 * row["diameter"] for row in rows], [1e3 * row["length"] for row in rows], "o-", color="#4c6a92",
              markersize=3)
    axes.axvline(1e3 * rows[0]["nominal_diameter"], color="#4c6a92", linestyle="--", linewidth=0.8)
    axes.set_ylim(0.0, 1.2e3 * rows[0]["length"])
    axes.set_xlabel("inner diameter [mm]; nominal", fontsize=7)
    axes.set_ylabel("stent's length [mm]", fontsize=7)


def draw_row(axes, name, tables):
    """Draws one instrument in a row of four axes."""
    shaft = tables["shaft"].get(name)
    markers = tables["markers"].get(name, [])
    balloon = tables["balloon"].get(name)
    stent = tables["stent"].get(name)
    for each in axes:
        each.tick_params(labelsize=6)
    if shaft:
        draw_view(axes[0], shaft, markers, "y", name)
        draw_view(axes[1], shaft, markers, "x", "from the side [mm]")
        draw_shaft(axes[2], shaft, markers, balloon)
    else:
        axes[0].set_title(name, fontsize=7)
        for each in axes[:3]:
            each.axis("off")
    if balloon:
        draw_balloon(axes[3], balloon)
    elif stent:
        draw_stent(axes[3], stent)
    else:
        axes[3].axis("off")


def main():
    """Reads the tables and writes the picture."""
    parser = tools.argument_parser(__doc__)
    parser.add_argument("folder", help="folder with the tables of `instrument_shape --out shaft.csv`")
    parser.add_argument("picture", help="PNG or SVG file to write")
    arguments = parser.parse_args()
    pyplot = tools.pyplot()
    files = {"shaft": "shaft.csv", "markers": "shaft_markers.csv", "balloon": "shaft_balloon.csv",
             "stent": "shaft_stent.csv"}
    tables = {key: read_table(os.path.join(arguments.folder, file), ("material",)) for key, file in files.items()}
    names = list(dict.fromkeys(name for key in ("shaft", "stent") for name in tables[key]))
    if not names:
        tools.fail("%s: no instrument in shaft.csv" % arguments.folder)
    columns = 1 if len(names) < 6 else 2
    rows = -(-len(names) // columns)
    figure, axes = pyplot.subplots(rows, 4 * columns, figsize=(9.0 * columns, 0.4 + 1.9 * rows), squeeze=False,
                                   constrained_layout=True, gridspec_kw={"width_ratios": (1.0, 0.6, 1.2, 1.0) * columns})
    for k, name in enumerate(names):
        row, column = k % rows, k // rows
        draw_row(axes[row][4 * column:4 * column + 4], name, tables)
    for k in range(len(names), rows * columns):
        for each in axes[k % rows][4 * (k // rows):4 * (k // rows) + 4]:
            each.axis("off")
    try:
        figure.savefig(arguments.picture, dpi=80)
    except (OSError, ValueError) as error:
        tools.fail("%s: cannot be written: %s" % (arguments.picture, error))


if __name__ == "__main__":
    main()
