#!/bin/bash
# Two sessions at once use different processors, and each reports its own.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
[ "$(nproc)" -ge 2 ] || { echo "skipped: this machine has one processor"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import json, os, re, signal, socket, subprocess, sys, time
folder, repository = sys.argv[1:]
sys.path.insert(0, repository + "/test/scripts")
from fault_trials import claims_of_others

START = 300  # longest start: a machine with other work is slow [s]
ports = []


def skip_beside_others():
    """Two processors must be free of other sessions."""
    others = claims_of_others(*ports)
    if len(os.sched_getaffinity(0)) - len(set(others)) < 2:
        print("skipped: other sessions use the processors %s of this machine, so fewer than two are free" % sorted(others))
        sys.exit(77)


def hear(name, node):
    """Waits until a node has published its diagnostics."""
    subprocess.run(["timeout", "120", "rostopic", "echo", "-n", "2", "--filter",
                    "'%s' in m.status[0].name" % node, "/diagnostics"], stdout=subprocess.DEVNULL,
                   env=dict(os.environ, ROS_MASTER_URI=uris[name]), check=True)


uris = {}
skip_beside_others()

def start(name):
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    ports.append(port)
    uris[name] = "http://localhost:%d" % port
    environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros_" + name,
                       ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
    log = open("%s/%s.log" % (folder, name), "w")
    return subprocess.Popen(
        ["roslaunch", "-p", str(port), repository + "/launch/sim.launch",
         "scene:=%s/config/scenes/tube.yaml" % repository, "haptic_device:=false",
         "fluoroscopy:=false", "visualization:=false", "results:=%s/%s" % (folder, name)],
        env=environment, stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))


def running(name):
    return ": running" in open("%s/%s.log" % (folder, name)).read()


sessions = {name: start(name) for name in ("a", "b")}
try:
    end = time.monotonic() + START
    while time.monotonic() < end and not all(running(name) for name in sessions) and \
            all(process.poll() is None for process in sessions.values()):
        time.sleep(0.2)
    skip_beside_others()
    for name in sessions:
        assert running(name), open("%s/%s.log" % (folder, name)).read()
        for node in ("rod_dynamics", "contact"):
            hear(name, node)
    time.sleep(2)  # the recorder hears the same messages
finally:
    for process in sessions.values():
        process.send_signal(signal.SIGINT)
    for process in sessions.values():
        process.wait(timeout=START)

processors = {}
for name in sessions:
    assert running(name), open("%s/%s.log" % (folder, name)).read()
    diagnostics = json.load(open("%s/%s/report.json" % (folder, name)))["diagnostics"]
    texts = [diagnostics[node]["scheduling"] for node in ("rod_dynamics", "contact")]
    print(name, texts)
    if any("refused" in text for text in texts):
        print("skipped: real-time scheduling is not permitted")
        sys.exit(77)
    skip_beside_others()
    held = [int(re.search(r", processor (\d+)", text).group(1)) for text in texts]
    assert held[0] == held[1], "the rod and the contact node share a processor"
    processors[name] = held[0]
    assert diagnostics["rod_dynamics"]["other sessions on the processor"] == 0, diagnostics["rod_dynamics"]
assert processors["a"] != processors["b"], processors
PYTHON
