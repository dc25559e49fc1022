#!/bin/bash
# While simulated time stands still, as in a paused replay, no pose on /tf is published twice: listeners would warn of each.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import os, signal, socket, subprocess, sys, time
folder, repository = sys.argv[1:]
with socket.socket() as free:
    free.bind(("localhost", 0))
    port = free.getsockname()[1]
os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros", ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
core = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
node = None
try:
    import rosgraph, rospy
    from rosgraph_msgs.msg import Clock
    from tf2_msgs.msg import TFMessage
    while not rosgraph.is_master_online():
        time.sleep(0.1)
    rospy.set_param("/use_sim_time", True)
    rospy.set_param("/scene", repository + "/test/data/every_node.yaml")
    rospy.init_node("test", disable_signals=True)
    poses = []
    rospy.Subscriber("/tf", TFMessage, lambda message: poses.extend(
        (each.child_frame_id, each.header.stamp.to_nsec()) for each in message.transforms))
    clock = rospy.Publisher("/clock", Clock, queue_size=1)
    program = os.path.join(os.environ["CMAKE_PREFIX_PATH"].split(":")[0], "lib/endovascular_sim/fluoroscopy")
    node = subprocess.Popen([program])

    def stand_still(second):
        """Publishes one time until its pose has arrived, and for five further seconds, in which 2 Hz would repeat it."""
        end = None
        while end is None or time.monotonic() < end:
            clock.publish(Clock(clock=rospy.Time(second)))
            if end is None and any(stamp == second * 10 ** 9 for _, stamp in poses):
                end = time.monotonic() + 5
            assert node.poll() is None
            time.sleep(0.05)

    for second in (10, 11):
        stand_still(second)
    repeated = sorted({pose for pose in poses if poses.count(pose) > 1})
    print("poses:", poses)
    assert not repeated, "repeated: %s" % repeated
finally:
    for process in (node, core):
        if process:
            process.send_signal(signal.SIGINT)
            process.wait(timeout=60)
PYTHON
