#!/bin/bash
# A baud rate of Arduino boards works, and one that no line has is refused once: the node is not started again and again.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import os, pty, signal, socket, subprocess, sys, time
folder, repository = sys.argv[1:]


def run(name, baud, scene, wanted):
    """Log of the node haptic_device, until the wanted text and five further seconds, in which a restart would show."""
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    master, slave = pty.openpty()
    log = "%s/%s.log" % (folder, name)
    nodes = ["%s:=false" % node for node in ("vessel_server", "contact", "rod_dynamics", "fluoroscopy", "session", "visualization")]
    launch = subprocess.Popen(
        ["roslaunch", "-p", str(port), repository + "/launch/sim.launch", "scene:=%s/%s" % (repository, scene), *nodes,
         "device:=" + os.ttyname(slave), "baud:=%d" % baud],
        env=dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros_" + name,
                 ROSCONSOLE_STDOUT_LINE_BUFFERED="1"),
        stdout=open(log, "w"), stderr=subprocess.STDOUT, start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    try:
        while wanted not in open(log).read():
            assert launch.poll() is None, open(log).read()[-3000:]
            time.sleep(0.1)
        time.sleep(5)
    finally:
        launch.send_signal(signal.SIGINT)
        launch.wait(timeout=120)
        os.close(slave)
        os.close(master)
    text = open(log).read()
    assert text.count("process[haptic_device") == 1 and "has died" not in text.split("shutting down")[0], text
    return text


scene = "test/data/hand_in_tube.yaml"
assert run("refused", 96, scene, "is no speed of a serial line").count("is no speed of a serial line") == 1
text = run("arduino", 250000, scene, "haptic device")
assert "baud" not in text.split("process[haptic_device")[1], text
run("without_a_device", 230400, "config/scenes/tube.yaml", "no haptic device in the scene")
PYTHON
