#!/bin/bash
# Two sessions at once use different processors, and each reports its own.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
[ "$(nproc)" -ge 2 ] || { echo "skipped: this machine has one processor"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import json, os, re, signal, socket, subprocess, sys, time
folder, repository = sys.argv[1:]


def start(name):
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
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
    end = time.monotonic() + 25
    while time.monotonic() < end and not all(running(name) for name in sessions) and \
            all(process.poll() is None for process in sessions.values()):
        time.sleep(0.2)
    time.sleep(4)  # both sessions publish their diagnostics several times
finally:
    for process in sessions.values():
        process.send_signal(signal.SIGINT)
    for process in sessions.values():
        process.wait(timeout=60)

processors = {}
for name in sessions:
    assert running(name), open("%s/%s.log" % (folder, name)).read()
    diagnostics = json.load(open("%s/%s/report.json" % (folder, name)))["diagnostics"]
    texts = [diagnostics[node]["scheduling"] for node in ("rod_dynamics", "contact")]
    print(name, texts)
    if any("refused" in text for text in texts):
        print("skipped: real-time scheduling is not permitted")
        sys.exit(77)
    held = [int(re.search(r", processor (\d+)", text).group(1)) for text in texts]
    assert held[0] == held[1], "the rod and the contact node share a processor"
    processors[name] = held[0]
    assert diagnostics["rod_dynamics"]["other sessions on the processor"] == 0, diagnostics["rod_dynamics"]
assert processors["a"] != processors["b"], processors
PYTHON
