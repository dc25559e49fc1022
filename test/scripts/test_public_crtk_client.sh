#!/bin/bash
# The public crtk_python_client is imported beside our crtk_msgs, and its examples run as they are. Its source is searched in
# the folder CRTK_PYTHON_CLIENT (a clone of collaborative-robotics/crtk_python_client), else among the installed modules.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"
/usr/bin/python3 -c 'from crtk_msgs.srv import QueryForwardKinematics, QueryInverseKinematics, TriggerOperatingState'
client=${CRTK_PYTHON_CLIENT:-}
[ -z "$client" ] || export PYTHONPATH="$client/src:$PYTHONPATH"
if ! reason=$(ROS_VERSION=1 /usr/bin/python3 -c 'import crtk' 2>&1); then
  echo "skipped: crtk_python_client cannot be imported (${reason##*$'\n'}); clone it and set CRTK_PYTHON_CLIENT to its folder"
  exit 77
fi
examples=${client:-/nonexistent}/scripts
[ -d "$examples" ] || { echo "skipped: the examples of crtk_python_client are not there; set CRTK_PYTHON_CLIENT to a clone of it"; exit 77; }

ROS_VERSION=1 /usr/bin/python3 - "$folder" "$repository" "$examples" <<'PYTHON'
import os, subprocess, sys, time
folder, repository, examples = sys.argv[1:]
sys.path.insert(0, repository + "/test/scripts")
from running_graph import RunningGraph
with RunningGraph(repository, folder, "test/data/wire_of_a_robot.yaml", "visualization:=false") as graph:
    graph.wait(300, graph.is_running, "start")
    os.environ.update(graph.environment)
    import rospy
    from crtk_msgs.msg import StringStamped
    rospy.init_node("test", disable_signals=True)
    reasons = set()
    rospy.Subscriber("/instruments/wire/state_reason", StringStamped, lambda reason: reasons.add(reason.string))

    def run(example, *arguments):
        done = subprocess.run([sys.executable, os.path.join(examples, example), "/instruments/wire", *arguments],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=300)
        print(example, done.returncode, done.stdout[-300:])
        return done

    assert run("crtk_servo_jp_example.py").returncode == 0
    slips = [reason for reason in reasons if "the grip slips" in reason]
    assert slips, "the wire jams without a word: %s" % reasons
    print("state_reason:", slips)
    for example in ("crtk_move_cp_example.py", "crtk_servo_cp_example.py"):
        assert "setpoint_cp" in run(example).stdout, "the message names the missing topic"

    import crtk
    import numpy

    class Wire:
        def __init__(self, ral):
            utils = crtk.utils(self, ral)
            for add in (utils.add_setpoint_js, utils.add_measured_js, utils.add_move_jp, utils.add_operating_state,
                        utils.add_hold, utils.add_free):
                add()

    wire = Wire(crtk.ral("test", "/instruments/wire", rospy))
    time.sleep(1.0)
    begin = wire.setpoint_jp()[0]
    goal = numpy.array([begin[0] + 0.1, begin[1]])
    wire.move_jp(goal)
    end = time.monotonic() + 60
    while wire.setpoint_jp()[0][0] < begin[0] + 0.005:
        assert time.monotonic() < end, "no motion from %s to %s: %s\n%s" % (begin, goal, reasons, graph.text()[-2000:])
        time.sleep(0.01)
    wire.hold()
    time.sleep(1.0)
    held = wire.setpoint_jp()[0][0]
    time.sleep(0.5)
    assert wire.setpoint_jp()[0][0] == held < goal[0] - 1e-3, "hold"
    wire.free()
    time.sleep(1.0)
    assert wire.operating_state() == "ENABLED"
PYTHON
