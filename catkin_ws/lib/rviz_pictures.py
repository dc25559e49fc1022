#!/usr/bin/python3
"""Pictures of rviz at the moments of a session that matter, from its recording.

usage: rviz_pictures.py FOLDER     moments of the results, one a line: time [s], name of the picture
       rviz_pictures.py FOLDER --play    leads the paused player to each of them and saves FOLDER/NAME.png

The moments are the ends of a procedure's phases with an instrument in the vessel, at most 8. Without a procedure it is the last
one with the instruments deep in the vessel. rviz.png is the picture of the last moment before an instrument is withdrawn for good.
"""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import time

MOST = 8         # pictures
EARLIER = 0.3    # time before the end of a phase [s]
DEEP = 0.9       # share of the largest insertion
DRAWING = 4.0    # time for rviz to draw a state in software [s]
LIMIT = 200.0    # time for all pictures [s]


def insertions(folder):
    """Time [s] and largest insertion of all instruments [m] of every row of trajectory.csv."""
    rows = []
    with open(os.path.join(folder, "trajectory.csv"), newline="") as stream:
        for row in csv.DictReader(stream):
            try:
                rows.append((float(row["time"]), float(row["insertion"])))
            except (TypeError, ValueError):
                continue  # the last row of an interrupted session may be incomplete
    return rows


def ends_of_phases(folder):
    """Name and end [s] of every completed phase of the procedure, in order; a repeated phase counts with its last end."""
    try:
        with open(os.path.join(folder, "metrics.json")) as stream:
            steps = json.load(stream).get("steps") or []
    except (OSError, ValueError):
        return []
    found = {}
    for step in steps:
        name = step["phase"] or step["step"]
        found.pop(name, None)
        found[name] = step["end"]
    return list(found.items())


def moments(folder):
    """Times [s] and names of the pictures, and the name of the most telling one; nothing without a recorded insertion."""
    rows = insertions(folder)
    deepest = max((insertion for _, insertion in rows), default=0.0)
    if deepest <= 0.0:
        return [], None
    deep = [when for when, insertion in rows if insertion >= DEEP * deepest]
    found = []
    for name, end in ends_of_phases(folder):
        when = max(0.0, end - EARLIER)
        # The vessel is empty, or nearly so, after the instruments are withdrawn.
        nearest = min(rows, key=lambda row: abs(row[0] - when))
        if nearest[1] > 0.2 * deepest:
            found.append((when, name))
    if not found:
        return [(deep[-1], "rviz")], "rviz"
    if len(found) > MOST:
        found = [found[round(k * (len(found) - 1) / (MOST - 1))] for k in range(MOST)]
    named = [(when, "rviz_%d_%s" % (k, re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")))
             for k, (when, name) in enumerate(found, 1)]
    telling = [name for when, name in named if when <= deep[-1]] or [named[0][1]]
    return named, telling[-1]


def play(folder):
    """Takes the pictures; returns whether rviz.png exists."""
    import rospy
    from endovascular_sim.srv import PlayerControl, PlayerControlRequest
    rospy.init_node("pictures", anonymous=True, disable_signals=True)
    end = time.monotonic() + LIMIT
    rospy.wait_for_service("/player/control", 60)
    player = rospy.ServiceProxy("/player/control", PlayerControl)
    wanted, telling = moments(folder)
    time.sleep(2.0 * DRAWING)  # rviz needs some seconds for its first picture
    for when, name in wanted:
        if time.monotonic() > end:
            return False
        player(PlayerControlRequest.SEEK_TIME, when)
        time.sleep(DRAWING)
        picture = os.path.join(folder, name + ".png")
        subprocess.run(["timeout", "-s", "KILL", "20", "import", "-window", "root", picture], check=False)
        if name == telling and os.path.isfile(picture) and name != "rviz":
            shutil.copyfile(picture, os.path.join(folder, "rviz.png"))
    return os.path.isfile(os.path.join(folder, "rviz.png"))


def main():
    """Prints the moments, or takes the pictures."""
    folder = sys.argv[1]
    if sys.argv[2:] == ["--play"]:
        return 0 if play(folder) else 1
    for when, name in moments(folder)[0]:
        print("%.3f %s" % (when, name))
    return 0


if __name__ == "__main__":
    # A node without a handler of signals may not end by itself.
    status = main()
    sys.stdout.flush()
    os._exit(status)
