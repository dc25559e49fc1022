#!/bin/bash
# Closing rviz neither asks nor changes a file of the repository, and the lesson ends with its window, with a complete recording.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
[ -e "${ENDOVASCULAR_DEVEL:-$repository/catkin_ws/devel}/lib/libendovascular_sim_rviz.so" ] || { echo "skipped: the plugin of rviz is not built"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

PYTHONPATH="$repository/test/scripts:$PYTHONPATH" /usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import glob, hashlib, os, subprocess, sys
import yaml
from rviz_session import RvizSession, run
folder, repository = sys.argv[1:]

def hashes():
    return {path: hashlib.sha256(open(path, "rb").read()).hexdigest() for path in sorted(glob.glob(repository + "/rviz/*"))}

def is_running(pid):
    try:
        return open("/proc/%d/stat" % pid).read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False

before = hashes()
with RvizSession(folder, repository + "/launch/lesson_bifurcation.launch", "expert:=false", "layout:=work") as session:
    rviz = session.pid_of("rviz")
    assert open("/proc/%d/comm" % rviz).read().strip() == "rviz", "another process stands for rviz"
    session.click("tip")  # another view: the configuration has changed
    session.wait(20, lambda: "*" in run("xdotool", "search", "--name", ".*rviz.*", "getwindowname", "%@", seconds=5),
                 "the mark of a changed configuration")
    session.wait(20, lambda: session.progress and session.progress.steps > 1000, "a recording")
    session.click("focus")
    run("xdotool", "key", "ctrl+s")  # into the copy
    session.click("overview")
    run("xdotool", "key", "ctrl+q")
    session.wait(30, lambda: not is_running(rviz), "the window to close without a question") if session.launch.poll() is None else None
    session.launch.wait(timeout=90)
assert hashes() == before, "rviz has written into the repository"
copy = folder + "/ros/endovascular_sim/rviz/demo.rviz"
view = yaml.safe_load(open(copy))["Visualization Manager"]["Views"]["Current"]["Class"]
assert view == "endovascular_sim/Tip", "the copy was not saved, its view is " + view
for name in ("session.bag", "report.json", "metrics.json"):
    assert os.path.isfile(os.path.join(session.results, name)), name + " is missing"
print("rviz closed without a question; the lesson ended with its recording")
PYTHON
