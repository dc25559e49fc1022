#!/bin/bash
# A baud rate of Arduino boards works, and one that no line has is refused once: the node is not started again and again.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import os, pty, sys, time
folder, repository = sys.argv[1:]
sys.path.insert(0, repository + "/test/scripts")
from running_graph import RunningGraph


def run(name, baud, scene, wanted):
    """Log of the node haptic_device, until the wanted text and five further seconds, in which a restart would show."""
    master, slave = pty.openpty()
    nodes = ["%s:=false" % node for node in ("vessel_server", "contact", "rod_dynamics", "fluoroscopy", "session", "visualization")]
    with RunningGraph(repository, folder + "/" + name, scene, *nodes, "device:=" + os.ttyname(slave), "baud:=%d" % baud) as graph:
        graph.wait(300, lambda: wanted in graph.text(), wanted)
        time.sleep(5)
    os.close(slave)
    os.close(master)
    text = graph.text()
    assert text.count("process[haptic_device") == 1 and "has died" not in text.split("shutting down")[0], text
    return text


scene = "test/data/hand_in_tube.yaml"
assert run("refused", 96, scene, "is no speed of a serial line").count("is no speed of a serial line") == 1
text = run("arduino", 250000, scene, "haptic device")
assert "baud" not in text.split("process[haptic_device")[1], text
run("without_a_device", 230400, "config/scenes/tube.yaml", "no haptic device in the scene")
PYTHON
