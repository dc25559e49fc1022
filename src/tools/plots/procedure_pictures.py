#!/usr/bin/python3
"""Draws the phases of a procedure side by side.

Each column shows the instruments in the vessel at the end of a phase and, if images exist, the fluoroscopy image nearest to
that time.
"""

import pathlib
import sys
import textwrap

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import tool_support as tools  # noqa: E402

plt = tools.pyplot()
import numpy as np  # noqa: E402

COLOURS = ["#d62728", "#ff9900", "#111111", "#1f77b4", "#2ca02c", "#9467bd"]
WIDTHS = [1.2, 2.2, 1.6, 4.0]   # line widths of the layers, from the innermost [points]
COLUMNS = 6
ZOOM = 0.075                    # half the width of a view [m]


def phases(folder):
    """Name, end [s] and image number of every phase in order; a repeated phase counts with its last end."""
    found = {}
    before = None
    number = 0
    for step in tools.read_json(folder / "metrics.json")["steps"]:
        name = step["phase"] or step["step"]
        number += name != before
        before = name
        found[name] = (step["end"], number)
    return [(name, end, number) for name, (end, number) in found.items()]


def shapes(path, times):
    """Polyline of the nodes at the last recorded time up to each given time; streams the file, which is large."""
    found = [None] * len(times)
    rows = []
    now = None

    def keep():
        for k, wanted in enumerate(times):
            if now is not None and now <= wanted + 1e-9:
                found[k] = rows
    for row in tools.read_rows(path):
        time = float(row["time"])
        if time != now:
            keep()
            now, rows = time, []
        rows.append((float(row["x"]), float(row["y"]), float(row["z"])))
    keep()
    return found


def insertions(path, times):
    """Insertion of every instrument at the sample nearest to each time, in the order of the scene [m]."""
    found = [{} for _ in times]
    best = [{} for _ in times]
    for row in tools.read_rows(path):
        for k, wanted in enumerate(times):
            distance = abs(float(row["time"]) - wanted)
            if distance < best[k].get(row["instrument"], 1e9):
                best[k][row["instrument"]] = distance
                found[k][row["instrument"]] = float(row["insertion"])
    return found


def truncated(nodes, length):
    """Initial part of a polyline with the given length."""
    part = nodes[:1]
    for a, b in zip(nodes, nodes[1:]):
        step = sum((q - p) ** 2 for p, q in zip(a, b)) ** 0.5
        if step > length:
            share = length / step
            return part + [tuple(p + share * (q - p) for p, q in zip(a, b))]
        length -= step
        part.append(b)
    return part


def picture_of(folder, number, time, duration):
    """Fluoroscopy image at the end of a phase.

    `simulate --pictures` writes one per phase; a session writes images at equal intervals.
    """
    own = folder / "fluoroscopy" / f"phase_{number:02d}.png"
    if own.exists():
        return own
    pictures = sorted((folder / "fluoroscopy").glob("frame_*.png"))
    if not pictures:
        return None
    last = int(pictures[-1].stem.split("_")[1])
    return min(pictures, key=lambda one: abs(int(one.stem.split("_")[1]) / max(last, 1) * duration - time))


def draw(axis, vessel, nodes, inside):
    """Draws one phase from the front: the points of the vessel in grey, every instrument over its inserted length."""
    axis.scatter([p[0] for p in vessel], [p[2] for p in vessel], s=1.0, c="#c9a9a0", linewidths=0)
    names = list(inside)
    tip = (0.0, 0.0, 0.0)
    for k in reversed(range(len(names))):
        length = inside[names[k]]
        if length <= 0.002 or not nodes:
            continue
        part = truncated(nodes, length)
        axis.plot([p[0] for p in part], [p[2] for p in part], color=COLOURS[k % len(COLOURS)],
                  linewidth=WIDTHS[k % len(WIDTHS)], solid_capstyle="round", label=names[k])
    if nodes:
        tip = nodes[-1]
    axis.set_xlim(tip[0] - ZOOM, tip[0] + ZOOM)
    axis.set_ylim(tip[2] - ZOOM, tip[2] + ZOOM)
    axis.set_aspect("equal")
    axis.set_xticks([])
    axis.set_yticks([])


def main():
    """Reads the results and writes the picture."""
    parser = tools.argument_parser(__doc__)
    parser.add_argument("results", type=pathlib.Path, help="results folder of `simulate` or of a session")
    parser.add_argument("--shapes", type=pathlib.Path, metavar="DIR",
                        help="results folder of `simulate --record nodes` of the same scene [the results]")
    parser.add_argument("--out", type=pathlib.Path, default=None, help="picture to write [phases.png in the results]")
    options = parser.parse_args()
    shape_folder = options.shapes or options.results
    try:
        moments = phases(options.results)
        times = [end for _, end, _ in moments]
        nodes = shapes(shape_folder / "nodes.csv", times)
        inside = insertions(shape_folder / "instruments.csv", times)
        vessel = [(float(r["x"]), float(r["y"]), float(r["z"])) for r in tools.read_rows(shape_folder / "vessel_points.csv")]
    except (OSError, KeyError) as error:
        tools.fail(f"{error}; give the results of a procedure, recorded with --record nodes")
    pictures = [picture_of(options.results, number, end, times[-1]) for _, end, number in moments]
    layers = 2 if any(pictures) else 1
    lines = -(-len(moments) // COLUMNS)
    figure, axes = plt.subplots(lines * layers, COLUMNS, figsize=(2.2 * COLUMNS, 2.45 * lines * layers), squeeze=False)
    for axis in axes.flat:
        axis.set_visible(False)
    handles = {}
    for k, (name, end, _) in enumerate(moments):
        axis = axes[k // COLUMNS * layers][k % COLUMNS]
        axis.set_visible(True)
        draw(axis, vessel, nodes[k], inside[k])
        axis.set_title("\n".join(textwrap.wrap(f"{name}, {end:.0f} s", 30)), fontsize=7)
        for handle, label in zip(*axis.get_legend_handles_labels()):
            handles[label] = handle
        if pictures[k]:
            below = axes[k // COLUMNS * layers + 1][k % COLUMNS]
            below.set_visible(True)
            below.axis("off")
            picture = plt.imread(pictures[k])
            # The scale starts above the darkest pixels: platinum would leave no grey levels for the vessel.
            dark = 0.7 * np.percentile(picture, 2)
            below.imshow(picture, cmap="gray", vmin=dark, vmax=picture.max())
    figure.tight_layout(rect=(0, 0.05 / lines, 1, 1), h_pad=2.0)
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=len(handles), fontsize=7, frameon=False)
    figure.savefig(options.out or options.results / "phases.png", dpi=130)


if __name__ == "__main__":
    main()
