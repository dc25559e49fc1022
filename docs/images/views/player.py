"""Recording of a scripted procedure in the player, after a seek."""
import time

from pictures import REPOSITORY, RvizSession, SETTLED, launch, photograph, rospy
from endovascular_sim.srv import PlayerControl, PlayerControlRequest
from running_graph import RunningGraph

DURATION, SHOWN = 60.0, 48.0  # of the recording, and shown moment [simulated s]


def record(folder, overrides):
    """Path of the bag of a procedure."""
    words = " ".join(["duration=%g" % DURATION, *overrides])
    with RunningGraph(str(REPOSITORY), folder + "/recording", "config/scenes/pci.yaml", "pace:=free", "stop_at_duration:=true", "haptic_device:=false",
                      "visualization:=false", "overrides:=" + words) as graph:
        while graph.launch.poll() is None:
            time.sleep(0.5)
    return folder + "/recording/results/session.bag"


def take(folder, out, overrides):
    bag = record(folder, overrides)
    with RvizSession(folder, launch("replay.launch"), "bag:=" + bag, "paused:=true") as session:
        control = rospy.ServiceProxy("/player/control", PlayerControl)
        control(PlayerControlRequest.SEEK_TIME, SHOWN)
        time.sleep(SETTLED)
        photograph(session, out)
