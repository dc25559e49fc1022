"""Sheet of many instruments: tips to a common scale, shafts with diameter and bending stiffness."""

import numpy as np

from . import style

TIP = 0.060          # drawn length of the straight part before a curve [m]
CELL = (54.0, 100.0)  # width and height of a tip's cell [mm]
COLUMNS = 9
BASE = 26.0          # height of a tip's proximal end above the lower side of its cell [mm]
SHAFT = 300.0        # drawn distal length of a shaft [mm]
WIDER = 7.0          # factor of the diameters of shafts
ROW = 17.0           # height of a shaft's row [mm of its diameter times WIDER]
STIFFNESS = (1.0, 5000.0)  # range of the colours [N·mm²]
GROUPS = (("guidewire", "wire"), ("catheter", "catheter"), ("guide_", "guide"), ("microcatheter", "microcatheter"),
          ("balloon", "balloon"), ("stent_system", "stent system"), ("stent", "stent"))


def group_of(name):
    """Position of an instrument's group in the sheet; unknown names follow the guidewires."""
    return next((k for k, (begin, _) in enumerate(GROUPS) if name.startswith(begin)), 0)


def outline(points, diameter):
    """Polygon of a tube in the plane of a picture: its line with half the diameter to both sides [mm]."""
    tangent = np.gradient(points, axis=0)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1) * 0.5 * diameter[:, None]
    return np.concatenate([points + normal, (points - normal)[::-1]])


def distal(shaft, length):
    """Rows of the last part of a shaft, whose lengths are in m."""
    keep = shaft["arc_length"] >= shaft["arc_length"][-1] - length
    return {name: column[keep] for name, column in shaft.items()}


def shown_length(shaft):
    """Length that shows the curve of an instrument and some straight shaft [m]."""
    curved = np.flatnonzero(np.hypot(shaft["x"], shaft["y"]) > 1e-9)
    total = shaft["arc_length"][-1]
    return max(TIP, total - shaft["arc_length"][curved[0]] + 0.012) if len(curved) else TIP


def colours(scale, values):
    """Colours of bending stiffnesses [N·mm²]."""
    low, high = np.log(STIFFNESS)
    return scale(np.clip((np.log(np.maximum(values, 1e-9)) - low) / (high - low), 0.0, 1.0))


def visible_scale(plt):
    """Scale of colours without the bright yellow, which is hard to see on white."""
    from matplotlib.colors import ListedColormap
    return ListedColormap(plt.get_cmap("viridis_r")(np.linspace(0.12, 1.0, 256)))


def draw_pieces(axes, points, rows, wider, scale):
    """Draws a tube in pieces of equal stiffness. A row of the table describes the part before its point."""
    from matplotlib.patches import Polygon
    if len(points) < 2:
        return
    stiffness, diameter = 1e6 * rows["bending_stiffness"], 1e3 * rows["diameter"] * wider
    bounds = [1, *(np.flatnonzero(np.diff(stiffness[1:])) + 2), len(stiffness)]
    for begin, end in zip(bounds, bounds[1:]):
        part = slice(begin - 1, end)
        widths = np.full(end - part.start, diameter[end - 1])
        axes.add_patch(Polygon(outline(points[part], widths), facecolor=colours(scale, stiffness[end - 1]), linewidth=0.4,
                               edgecolor=colours(scale, stiffness[end - 1])))


def draw_markers(axes, points, rows, markers, wider):
    """Draws the radiopaque markers, given by their distances from the tip."""
    from matplotlib.patches import Polygon
    from_tip = rows["arc_length"][-1] - rows["arc_length"]
    for begin, length in zip(markers.get("from_tip", ()), markers.get("length", ())):
        part = (from_tip >= begin - 2.5e-4) & (from_tip <= begin + length + 2.5e-4)
        if part.sum() > 1:
            axes.add_patch(Polygon(outline(points[part], 1.25e3 * rows["diameter"][part] * wider), facecolor="black", edgecolor="none"))


def draw_tip(axes, name, shaft, markers, place, scale):
    """Draws the rest shape of a tip and its name below."""
    rows = distal(shaft, shown_length(shaft))
    points = 1e3 * np.stack([rows["y"], rows["z"]], axis=1)
    low, high = points.min(axis=0), points.max(axis=0)
    middle, base = place[0] + 0.5 * CELL[0], place[1] + BASE
    points = points - [0.5 * (low[0] + high[0]), low[1]] + [middle, base]
    draw_pieces(axes, points, rows, 1.0, scale)
    draw_markers(axes, points, rows, markers, 1.0)
    stiffness = 1e6 * shaft["bending_stiffness"]
    label(axes, middle, place[1], name, "%.2f mm\n%s N·mm²" % (
        1e3 * shaft["diameter"].max(), "–".join("%.0f" % one if one >= 10 else "%.2g" % one
                                                for one in dict.fromkeys((stiffness.max(), stiffness.min())))))


def draw_stent(axes, name, stent, place):
    """Draws an expanded stent of nominal diameter as rings of zigzags."""
    diameter = 1e3 * stent["nominal_diameter"][0]
    length = 1e3 * np.interp(stent["nominal_diameter"][0], stent["diameter"], stent["length"])
    middle, base, rings = place[0] + 0.5 * CELL[0], place[1] + BASE, 8
    across = middle + 0.5 * diameter * np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    for ring in range(rings):
        heights = base + (ring + np.array([0.1, 0.9, 0.1, 0.9, 0.1])) * length / rings
        axes.plot(across, heights, color="#26384f", linewidth=0.9)
    label(axes, middle, place[1], name, "%.2f mm\n%.0f mm long" % (diameter, length))


def label(axes, x, y, name, values):
    """Name and values of a cell."""
    words = name.split("_")
    half = (len(words) + 1) // 2
    lines = [" ".join(words[:half]), " ".join(words[half:])] if len(name) > 14 else [" ".join(words)]
    axes.text(x, y + BASE - 3.0, "\n".join(lines), ha="center", va="top", fontsize=8.5, fontweight="bold")
    axes.text(x, y + BASE - 14.5, values, ha="center", va="top", fontsize=7.5)


def draw_shaft(axes, shaft, markers, balloon, height, scale):
    """Draws the distal part of a shaft from the left to its tip, with lumen and balloon; diameters times WIDER."""
    from matplotlib.patches import Rectangle
    rows = distal(shaft, 1e-3 * SHAFT)
    from_tip = 1e3 * (rows["arc_length"] - rows["arc_length"][-1])
    points = np.stack([from_tip, np.full(len(from_tip), height)], axis=1)
    if balloon:
        width = 1e3 * balloon["length"][0]
        axes.add_patch(Rectangle((-1e3 * balloon["from_tip"][0] - width, height - 0.45 * ROW), width, 0.9 * ROW, color="#7fd0e8", alpha=0.6))
    draw_pieces(axes, points, rows, WIDER, scale)
    inner = 1e3 * WIDER * rows["inner_diameter"]
    if inner.max() > 0:
        axes.fill_between(from_tip, height - 0.5 * inner, height + 0.5 * inner, color="white", alpha=0.75, linewidth=0)
    draw_markers(axes, points, rows, markers, WIDER)


def draw(shafts, markers, balloons, stents):
    """Sheet of instruments: tables of `plots instruments` by the name of the instrument."""
    plt = style.pyplot()
    plt.rcParams["font.size"] = 9
    names = sorted({*shafts, *stents}, key=lambda name: (group_of(name), name))
    long = [name for name in names if name in shafts]
    lines = -(-len(names) // COLUMNS)
    scale = visible_scale(plt)
    width = 12.0
    heights = (width * lines * CELL[1] / (COLUMNS * CELL[0]) + 0.3, 0.23 * len(long) + 1.3)
    figure = plt.figure(figsize=(width, sum(heights)))
    above, below = (part.subplots() for part in figure.subfigures(2, 1, height_ratios=heights))
    for k, name in enumerate(names):
        place = (k % COLUMNS * CELL[0], -(k // COLUMNS + 1) * CELL[1])
        if name in shafts:
            draw_tip(above, name, shafts[name], markers.get(name, {}), place, scale)
        else:
            draw_stent(above, name, stents[name], place)
    above.plot([4.0, 24.0], [-2.0, -2.0], color="black", linewidth=2)
    above.text(26.0, -2.0, "20 mm", va="center")
    above.set(xlim=(0.0, COLUMNS * CELL[0]), ylim=(-lines * CELL[1], 0.0), aspect="equal",
              title="Tips at rest, to scale; black: radiopaque. Below: largest diameter, bending stiffness of the shaft and of the tip")
    above.axis("off")
    for k, name in enumerate(long):
        draw_shaft(below, shafts[name], markers.get(name, {}), balloons.get(name), -ROW * k, scale)
    below.set(xlim=(-SHAFT, 4.0), ylim=(-ROW * (len(long) - 0.4), 0.6 * ROW), xlabel="distance from the tip [mm]",
              title="Shafts, distal %g mm; diameters %g times larger, pale: lumen, light blue: balloon" % (SHAFT, WIDER))
    below.set_yticks([-ROW * k for k in range(len(long))], [name.replace("_", " ") for name in long])
    below.set_xticks(range(-int(SHAFT), 1, 50), [str(k) for k in range(int(SHAFT), -1, -50)])
    below.grid(axis="y", visible=False)
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm
    below.figure.colorbar(ScalarMappable(LogNorm(*STIFFNESS), scale), ax=below, label="bending stiffness EI [N·mm²]", orientation="horizontal", aspect=60,
                    fraction=0.04)
    return figure
