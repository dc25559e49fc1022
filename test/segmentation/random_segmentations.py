#!/usr/bin/env python3
"""Random synthetic CTs and clicks through vessel_segment: PROGRAMS FOLDER COUNT SEED. Prints a table, one line per image.

Tubes and trees of random course, radius and noise; clicks at the ends, or close together, at one place, outside of the lumen, in
wrong order (which is told), or without the trunk. vessel_segment ends with exit code 1 and a message that names a file and a remedy, or with 0 and a
vessel with which `simulate` runs by the arguments that are printed. Equal seeds give equal images."""
import collections
import math
import os
import random
import shlex
import subprocess
import sys

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
import image_files as files  # noqa: E402

PROGRAMS, FOLDER, COUNT, SEED = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
REPOSITORY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
KINDS = ("ends", "ends", "ends", "close", "close", "same", "outside", "three", "fold", "no_trunk")


def course(chance, start, direction, length, bend):
    """Smooth random curve: points every 0.5 mm."""
    points, d = [numpy.array(start, float)], numpy.array(direction, float)
    turn = numpy.zeros(3)
    for _ in range(int(length / 0.5)):
        turn = 0.9 * turn + numpy.array([chance.gauss(0, 1) for _ in range(3)]) * bend
        d = d + turn
        d /= numpy.linalg.norm(d)
        points.append(points[-1] + 0.5 * d)
    return numpy.array(points)


def tree(chance):
    """Branches: list of (name, points [mm], radius [mm])."""
    radius = chance.uniform(1.5, 6.0)
    trunk = course(chance, (0, 0, 0), (0, 0, 1), chance.uniform(35, 70), 0.004)
    branches = [("trunk", trunk, radius)]
    for k in range(chance.choice((0, 0, 1, 2))):
        at = chance.uniform(0.3, 0.7)
        side = chance.uniform(0, 2 * math.pi)
        start = trunk[int(at * (len(trunk) - 1))]
        direction = numpy.array([math.cos(side), math.sin(side), chance.uniform(0.3, 1.2)])
        direction /= numpy.linalg.norm(direction)
        branches.append(("side_%d" % (k + 1), course(chance, start, direction, chance.uniform(20, 40), 0.006),
                         radius * chance.uniform(0.5, 0.9)))
    return branches


def image(chance, branches):
    """Writes the CT; the lumen ends inside of the image or leaves it. Returns its path."""
    spacing = chance.choice((0.6, 0.8, 1.0))
    everything = numpy.concatenate([points for _, points, _ in branches])
    margin = chance.choice((-2.0, 6.0))  # negative: vessels leave the image
    low, high = everything.min(axis=0) - [9, 9, margin], everything.max(axis=0) + [9, 9, margin]
    size = numpy.maximum(numpy.ceil((high - low) / spacing).astype(int), 12)
    axes = [low[a] + spacing * numpy.arange(size[a]) for a in range(3)]
    inside = numpy.full(size[::-1], 1e9)  # distance from the wall [mm], over (k, j, i)
    for _, points, radius in branches:
        for p in points[::2]:
            first = [max(0, int((p[a] - low[a] - radius - 3) / spacing)) for a in range(3)]
            last = [min(size[a], int((p[a] - low[a] + radius + 3) / spacing) + 2) for a in range(3)]
            part = [axes[a][first[a]:last[a]] - p[a] for a in range(3)]
            distance = numpy.sqrt(part[2][:, None, None]**2 + part[1][None, :, None]**2 + part[0][None, None, :]**2) - radius
            region = inside[first[2]:last[2], first[1]:last[1], first[0]:last[0]]
            numpy.minimum(region, distance, out=region)
    lumen = chance.uniform(250, 500)
    share = 1 / (1 + numpy.exp(numpy.clip(inside / 0.35, -40, 40)))
    values = 50 + (lumen - 50) * share
    values += numpy.random.RandomState(chance.randrange(2**31)).normal(0, chance.choice((5, 25, 60)), values.shape)
    values[:, 0, :] = -1000  # air
    files.SIZE, files.SPACING, files.ORIGIN = tuple(int(n) for n in size), (spacing,) * 3, tuple(low)
    files.rotation = lambda: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    path = os.path.join(FOLDER, "image.mha")
    files.write_mha(path, data=numpy.rint(values).astype("<i2").tobytes())
    return path


def clicks(chance, branches, kind):
    """Text of a file of clicks."""
    lines = ["branches:"]
    for name, points, radius in branches[1 if kind == "no_trunk" and len(branches) > 1 else 0:]:
        def at(distance, points=points, radius=radius):
            p = points[max(0, min(len(points) - 1, int(distance / 0.5)))]
            return p + [chance.uniform(-0.3, 0.3) * radius for _ in range(3)]

        length = 0.5 * (len(points) - 1)
        margin = radius + 2
        ends = [at(margin), at(length - margin)]
        if kind == "same":
            ends = [ends[0], ends[0]]
        elif kind == "close":
            gap = chance.choice((0.3, 1, 2, 3, 5, 8, 10, 12, 15, 18))
            ends = [at(length / 2), at(length / 2 + gap)]
        elif kind == "outside":
            ends[1] = ends[1] + [0, 2 * radius + chance.choice((1, 6)), 0]
        elif kind == "three":
            ends = [ends[0], at(length / 2), ends[1]]
        elif kind == "fold":
            ends = [ends[0], ends[1], at(length / 2)]
        lines.append("  - name: %s" % name)
        lines.append("    clicks: [%s]" % ", ".join("[%.2f, %.2f, %.2f]" % tuple(p) for p in ends))
    return "\n".join(lines) + "\n"


def result_of(command):
    """Exit code and texts of a command; a time-out counts as a failure."""
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False, cwd=REPOSITORY)
        return result.returncode, result.stdout, result.stderr
    except subprocess.TimeoutExpired:
        return -1, "", "more than 300 s"


def trial(number):
    """Returns kind, result and failure ("" if there is none)."""
    chance = random.Random("%d %d" % (SEED, number))
    branches = tree(chance)
    kind = KINDS[number % len(KINDS)]
    path = image(chance, branches)
    place = os.path.join(FOLDER, "clicks.yaml")
    out = os.path.join(FOLDER, "result.obj")
    if os.path.exists(out):
        os.remove(out)
    with open(place, "w") as file:
        file.write(clicks(chance, branches, kind))
    code, text, message = result_of([PROGRAMS + "/vessel_segment", path, "--clicks", place, "--out", out, "--max-distance", "0.0005",
                                     "--quiet"])
    if code == 1:
        lines = [line for line in message.splitlines() if "warning" not in line]
        failure = "" if len(lines) == 1 and lines[0].startswith("vessel_segment: ") else "message: " + message
        return kind, lines[0][-90:] if lines else "", failure or ("an output was left" if os.path.exists(out) else "")
    if code != 0:
        return kind, "", "exit code %d: %s" % (code, message[-300:])
    arguments = [line for line in text.splitlines() if line.startswith("to use the vessel: rosrun endovascular_sim simulate ")]
    if kind == "same" or len(arguments) != 1 or (kind == "fold" and "order along the branch: 1, 3, 2" not in message):
        return kind, "", "accepted: " + text[-200:]
    run = [PROGRAMS + "/simulate"] + shlex.split(arguments[0].split("simulate ", 1)[1])
    code, _, message = result_of(run + ["--seconds", "0.02", "--no-plots", "--quiet", "--out", os.path.join(FOLDER, "run")])
    return kind, "runs", "" if code == 0 else "simulate refuses it: " + message[-300:]


def main():
    count = collections.Counter()
    failures = 0
    for number in range(COUNT):
        kind, result, failure = trial(number)
        count[kind, "runs" if result == "runs" else "refused"] += 1
        failures += bool(failure)
        print("%4d  %-9s %s%s" % (number, kind, result, failure and "  FAILURE: " + failure), flush=True)
    for kind, outcome in sorted(count):
        print("%-9s %-8s %4d" % (kind, outcome, count[kind, outcome]))
    print("%d failures" % failures)
    return 1 if failures else 0


sys.exit(main())
