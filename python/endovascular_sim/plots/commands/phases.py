"""Draws the phases of a procedure side by side.

Each column shows the instruments in the vessel, rendered, at the end of a phase and, if images exist, the fluoroscopy image nearest to
that time.
"""

import csv
import pathlib
import textwrap

import numpy as np

from .. import meshes, rendering, style, tables
from ..command import Failure

COLOURS = ["#c8201e", "#f08a00", "#2b2b30", "#2f78b7", "#2ca02c", "#9467bd"]
STENT = "#26384f"
BALLOON = "#7fd0e8"
COLUMNS = 6
PIXELS = 300                    # width of a picture [1]
LEAST = 1.5                     # radius of the thinnest instrument in the picture [pixel]
WIDE, CLOSE = 0.075, 0.032      # half the width of a view, in wide vessels and in narrow ones [m]
NARROW = 0.005                  # a tip is in a narrow vessel if the wall surrounds it within this distance [m]
FAR = 0.15                      # instruments beyond this distance from a placed stent leave it in the view [m]
INFLATED = 0.5e5                # least pressure of a balloon that is drawn inflated [Pa]


def phases(folder):
    """Name, end [s] and image number of every phase in order; a repeated phase counts with its last end."""
    found = {}
    before = None
    number = 0
    for step in tables.read_json(folder / "metrics.json")["steps"]:
        name = step["phase"] or step["step"]
        number += name != before
        before = name
        found[name] = (step["end"], number)
    return [(name, end, number) for name, (end, number) in found.items()]


def shapes(path, times):
    """Polyline of the nodes at the last recorded time up to each given time; streams the file, which is large."""
    found = [None] * len(times)
    rows, now = [], None

    def keep():
        for k, wanted in enumerate(times):
            if now is not None and now <= wanted + 1e-9:
                found[k] = rows
    with open(path, newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            time = float(row["time"])
            if time != now:
                keep()
                now, rows = time, []
            rows.append((float(row["x"]), float(row["y"]), float(row["z"])))
    keep()
    return found


def states(path, times):
    """Insertion [m] and pressure [Pa] of every instrument at the sample nearest to each time, in the order of the scene."""
    found = [{} for _ in times]
    for (name,), rows in tables.groups(tables.read(path), "instrument"):
        for state, wanted in zip(found, times):
            k = np.argmin(np.abs(rows["time"] - wanted))
            state[name] = (rows["insertion"][k], rows["pressure"][k])
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


def last_part(nodes, begin, end):
    """Part of a polyline between two lengths before its end, begin > end."""
    rest = truncated(nodes[::-1], begin)
    cut = truncated(nodes[::-1], end) if end > 0 else nodes[-1:]
    return rest[len(cut) - 1:][::-1]


class Instrument:
    """Radii [m] and balloon of an instrument of scene.yaml."""

    def __init__(self, entry):
        self.radius = max(float(section["radius"]) for section in entry["sections"])
        balloon = entry.get("balloon")
        # PyYAML reads a number such as 3e-04 as a text.
        self.balloon = balloon and {key: np.array(value, dtype=float) for key, value in balloon.items()}

    def balloon_radius(self, pressure):
        """Radius of the balloon under a pressure [m]."""
        if pressure < INFLATED:
            return 0.5 * self.balloon["folded_diameter"]
        pressures, diameters = self.balloon["compliance"].T
        return 0.5 * float(np.interp(pressure, pressures, diameters))

    def balloon_part(self, line):
        """Part of the instrument's polyline that the balloon covers."""
        return last_part(line, self.balloon["from_tip"] + self.balloon["length"], self.balloon["from_tip"])


def read_instruments(path):
    """Instruments of a results folder's scene.yaml by name."""
    import yaml
    with open(path, encoding="utf-8") as stream:
        scene = yaml.load(stream, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    return {one["instrument"]["name"]: Instrument(one["instrument"]) for one in scene.get("instruments", [scene])}


def placed_stents(folder):
    """Time of placement [s], instrument, diameter, length and middle [m] of every placed stent."""
    treatment = (tables.read_json_if_any(folder / "result.json") or {}).get("treatment")
    found = []
    for balloon in (treatment or {}).get("balloons", []):
        stent = balloon.get("stent")
        times = [event["time"] for event in treatment["events"]
                 if event["event"] == "stent_placed" and event["instrument"] == balloon["instrument"]]
        if stent and stent["state"] == "placed" and times:
            found.append((times[0], balloon["instrument"], stent["inner_diameter"], stent["length"], stent["middle"]))
    return found


def stent_axis(line, middle, length):
    """Part of an instrument's polyline about the middle of its stent, as long as the stent."""
    line = np.asarray(line)
    arc = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)))
    centre = arc[np.argmin(np.linalg.norm(line - middle, axis=1))]
    at = np.linspace(centre - 0.5 * length, min(centre + 0.5 * length, arc[-1]), 41)
    axis = np.stack([np.interp(at, arc, line[:, k]) for k in range(3)], axis=1)
    return axis + (np.asarray(middle) - axis[20])


def draw_stent(picture, axis, radius):
    """Draws rings of zigzag struts about an axis."""
    axis = np.asarray(axis)
    tangent = axis[-1] - axis[0]
    side = np.cross(tangent, [0.0, 1.0, 0.0])
    side /= max(np.linalg.norm(side), 1e-12)
    other = np.cross(tangent, side)
    other /= max(np.linalg.norm(other), 1e-12)
    rings = 9
    angles = np.linspace(0.0, 2.0 * np.pi, 13)
    for ring in range(rings):
        share = (ring + np.where(np.arange(13) % 2, 0.9, 0.1)) / rings * (len(axis) - 1)
        centres = np.stack([np.interp(share, np.arange(len(axis)), axis[:, k]) for k in range(3)], axis=1)
        strut = centres + radius * (np.cos(angles)[:, None] * side + np.sin(angles)[:, None] * other)
        picture.add_tube(strut, 0.0, rgb(STENT), 0.7, 0.02)


def rgb(colour):
    """Red, green and blue of a colour such as #102030, from 0 to 1."""
    return [int(colour[k:k + 2], 16) / 255.0 for k in (1, 3, 5)]


def view_of(vessel, nodes, inside, stents):
    """Centre [m] and half width [m] of the view: the foremost tip, or a placed stent that the instruments have left."""
    tip = np.array(nodes[-1]) if nodes and max(inside.values())[0] > 0.002 else None
    if stents and (tip is None or np.linalg.norm(tip - stents[-1][4]) > FAR):
        return np.array(stents[-1][4]), CLOSE
    if tip is None:
        return vessel[0].mean(axis=0), WIDE
    near = np.linalg.norm(vessel[0] - tip, axis=1) < NARROW
    # Beside the wall of a wide vessel all normals are similar; around a narrow lumen they cancel.
    if near.sum() < 8 or np.linalg.norm(vessel[2][near].mean(axis=0)) > 0.5:
        return tip, WIDE
    return np.array(last_part(nodes, 0.012, 0.0)[0]), CLOSE


def render(vessel, instruments, nodes, inside, stents):
    """Picture of one phase; `stents` are those placed, each with its axis."""
    picture = rendering.ScenePicture(*view_of(vessel, nodes, inside, stents), PIXELS)
    picture.add_wall(*vessel)
    thinnest = min(one.radius for one in instruments.values())
    for k, (name, (length, pressure)) in enumerate(inside.items()):
        if length <= 0.002 or not nodes:
            continue
        part = truncated(nodes, length)
        one = instruments[name]
        least = LEAST * (one.radius / thinnest) ** 0.5
        # Inner instruments in front of outer ones: the lumen is shown open.
        picture.add_tube(part, one.radius, rgb(COLOURS[k % len(COLOURS)]), least, 0.002 * (len(inside) - k))
        if one.balloon:
            covered, radius = one.balloon_part(part), one.balloon_radius(pressure)
            inflated = pressure >= INFLATED
            picture.add_tube(covered, radius, rgb(BALLOON if inflated else STENT), least + 0.8, 0.015)
            if inflated and not stents:
                draw_stent(picture, covered, radius)
    for _, _, diameter, _, _, axis in stents:
        draw_stent(picture, axis, 0.5 * diameter)
    return picture.image()


def images(vessel, instruments, moments, nodes, inside, stents):
    """One picture per phase."""
    axes = {}
    result = []
    for k, (_, end, _) in enumerate(moments):
        present = []
        for stent in stents:
            time, name, _, length, middle = stent
            if time > end:
                continue
            if name not in axes:
                axes[name] = stent_axis(truncated(nodes[k], inside[k][name][0]), middle, length)
            present.append(stent + (axes[name],))
        result.append(render(vessel, instruments, nodes[k], inside[k], present))
    return result


def legend(inside, stents):
    """Names and colours of the instruments, and of the stent."""
    from matplotlib.patches import Patch
    handles = [Patch(color=COLOURS[k % len(COLOURS)], label=name.replace("_", " ")) for k, name in enumerate(inside)]
    return handles + ([Patch(color=STENT, label="stent in place")] if stents else [])


def add_arguments(parser):
    parser.add_argument("results", type=pathlib.Path, help="results folder of `simulate` or of a session")
    parser.add_argument("--shapes", type=pathlib.Path, metavar="DIR",
                        help="results folder of `simulate --record nodes` of the same scene [the results]")
    parser.add_argument("--out", type=pathlib.Path, default=None, help="picture to write [phases.png in the results]")


def run(options):
    """Reads the results and writes the picture."""
    shape_folder = options.shapes or options.results
    try:
        moments = phases(options.results)
        times = [end for _, end, _ in moments]
        nodes = shapes(shape_folder / "nodes.csv", times)
        inside = states(shape_folder / "instruments.csv", times)
        vertices, faces = meshes.read_obj(shape_folder / "vessel.obj")
        instruments = read_instruments(shape_folder / "scene.yaml")
        stents = placed_stents(shape_folder)
    except (OSError, KeyError, ValueError) as error:
        raise Failure(f"{error}; give the results of a procedure, recorded with --record nodes") from error
    vessel = (vertices, faces, meshes.vertex_normals(vertices, faces))
    rendered = images(vessel, instruments, moments, nodes, inside, stents)
    pictures = [picture_of(options.results, number, end, times[-1]) for _, end, number in moments]
    layers = 2 if any(pictures) else 1
    columns = min(len(moments), COLUMNS)
    lines = -(-len(moments) // columns)
    figure, axes = style.figure(lines * layers * columns, columns=columns, panel=(2.2, 2.45), font=7)
    for axis in axes:
        axis.axis("off")
    for k, (name, end, _) in enumerate(moments):
        axis = axes[k // columns * layers * columns + k % columns]
        axis.imshow(rendered[k])
        axis.set_title("\n".join(textwrap.wrap(f"{name}, {end:.0f} s", 30)))
        if pictures[k]:
            below = axes[(k // columns * layers + 1) * columns + k % columns]
            picture = style.pyplot().imread(pictures[k])
            # The scale starts above the darkest pixels: platinum would leave no grey levels for the vessel.
            dark = 0.7 * np.percentile(picture, 2)
            below.imshow(picture, cmap="gray", vmin=dark, vmax=picture.max())
    handles = legend(inside[0], stents)
    figure.get_layout_engine().set(rect=(0.0, 0.05 / lines, 1.0, 1.0 - 0.05 / lines))  # above the legend
    figure.legend(handles=handles, loc="lower center", ncol=len(handles), frameon=False)
    style.save(figure, options.out or options.results / "phases.png")
