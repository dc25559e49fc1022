#!/bin/bash
# Two sessions at once use different processors, and each reports its own.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
[ "$(nproc)" -ge 2 ] || { echo "skipped: this machine has one processor"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import contextlib, json, os, re, subprocess, sys, time
folder, repository = sys.argv[1:]
sys.path.insert(0, repository + "/test/scripts")
from fault_trials import claims_of_others
from running_graph import RunningGraph

START = 300  # longest start: a machine with other work is slow [s]
sessions = {}


def skip_beside_others():
    """Two processors must be free of other sessions."""
    others = claims_of_others(*(session.port for session in sessions.values()))
    if len(os.sched_getaffinity(0)) - len(set(others)) < 2:
        print("skipped: other sessions use the processors %s of this machine, so fewer than two are free" % sorted(others))
        sys.exit(77)


def hear(name, node):
    """Waits until a node has published its diagnostics."""
    subprocess.run(["timeout", "120", "rostopic", "echo", "-n", "2", "--filter",
                    "'%s' in m.status[0].name" % node, "/diagnostics"], stdout=subprocess.DEVNULL,
                   env=sessions[name].environment, check=True)


skip_beside_others()
with contextlib.ExitStack() as ends:
    for name in ("a", "b"):
        sessions[name] = ends.enter_context(RunningGraph(repository, folder + "/" + name, "config/scenes/tube.yaml",
                                                         "haptic_device:=false", "fluoroscopy:=false", "visualization:=false"))
    for session in sessions.values():
        session.wait(START, session.is_running, "start")
    skip_beside_others()
    for name in sessions:
        for node in ("rod_dynamics", "contact"):
            hear(name, node)
    time.sleep(2)  # the recorder hears the same messages

processors = {}
for name in sessions:
    diagnostics = json.load(open("%s/%s/results/report.json" % (folder, name)))["diagnostics"]
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
