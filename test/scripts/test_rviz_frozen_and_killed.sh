#!/bin/bash
# A frozen rviz ends the motion that its panel commands, and neither a frozen nor a killed rviz affects simulation and recording.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
[ -e "${ENDOVASCULAR_DEVEL:-$repository/catkin_ws/devel}/lib/libendovascular_sim_rviz.so" ] || { echo "skipped: the plugin of rviz is not built"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"

PYTHONPATH="$repository/test/scripts:$PYTHONPATH" /usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import os, re, signal, subprocess, sys, time
from rviz_session import RvizSession, run
folder, repository = sys.argv[1:]

with RvizSession(folder, repository + "/launch/demo.launch", "haptic_device:=false",
                 "scene:=%s/config/scenes/demo.yaml" % repository, "fluoroscopy:=false",
                 "overrides:=duration=3600 drive.source=topic haptic_device=false sampling.nodes=80") as session:
    rviz = session.pid_of("rviz")
    begin = session.state.insertion[0]
    session.mouse("push", "mousedown", "1")
    session.wait(20, lambda: session.state.insertion[0] > begin + 5e-3, "the button to push")
    os.kill(rviz, signal.SIGSTOP)
    time.sleep(2.0)
    stopped, steps = session.state.insertion[0], session.progress.steps
    time.sleep(4.0)
    assert session.state.insertion[0] == stopped, "the wire moves on after rviz has stopped"
    assert session.progress.steps > steps + 1000, "the recording stands still"
    print("frozen: wire at rest at %.1f mm, %d steps recorded in 4 s" % (1e3 * stopped, session.progress.steps - steps))
    os.kill(rviz, signal.SIGCONT)
    run("xdotool", "mouseup", "1")
    os.kill(rviz, signal.SIGKILL)
    steps = session.progress.steps
    time.sleep(3.0)
    assert session.progress.steps > steps + 1000, "the recording stands still after rviz was killed"
    print("killed: %d steps recorded in 3 s" % (session.progress.steps - steps))
    assert session.launch.poll() is None

output = run("rosrun", "endovascular_sim", "replay", folder + "/results/session.bag", seconds=200)
print(output[-400:])
assert re.search(r"\b0 different", output) or "all steps are equal" in output, output
PYTHON
