#!/bin/bash
# Every node of the launch files is required or respawned, except the windows of demo and robot, and the
# recording of a lesson's expert and the start at a step.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
/usr/bin/python3 - "$repository"/launch/*.launch <<'PYTHON'
import os, sys
import xml.etree.ElementTree as tree
EXCLUDED = {("demo.launch", "rviz"), ("robot.launch", "rviz"),
            ("lesson.launch", "expert_recording"), ("lesson.launch", "lesson_step")}
found, failed = set(), False
for path in sys.argv[1:]:
    for node in tree.parse(path).getroot().iter("node"):
        key = (os.path.basename(path), node.get("name"))
        found.add(key)
        required, respawn = node.get("required") == "true", node.get("respawn") == "true"
        if (required or respawn) == (key in EXCLUDED) or (required and respawn):
            print("%s: node %s: required=%s respawn=%s" % (*key, required, respawn))
            failed = True
names = {name for launch, name in found if launch == "sim.launch"}
wanted = {"vessel_server", "contact", "hemodynamics", "rod_dynamics", "fluoroscopy", "haptic_device", "robot", "session", "visualization"}
if names != wanted:
    print("sim.launch starts %s instead of %s" % (sorted(names), sorted(wanted)))
    failed = True
sys.exit(failed)
PYTHON
