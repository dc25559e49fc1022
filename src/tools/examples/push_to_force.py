#!/usr/bin/env python3
"""Pushes an instrument until the wall resists with a force, and holds that force, by velocities in real time. Start, in two
terminals:

    roslaunch endovascular_sim sim.launch scene:=$(rospack find endovascular_sim)/config/scenes/fork.yaml
    rosrun endovascular_sim push_to_force.py --force 0.1
"""
import argparse
import math
import sys
import threading

import rospy
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

RATE = 100.0  # of the loop [Hz]
GAIN = 0.1  # speed per difference of the force [m/(s N)]
MOST = 0.03  # largest speed [m/s]


class Loop:
    """Force loop on one instrument: measured_cf in, servo_jv out."""

    def __init__(self, name):
        self.arrived = threading.Event()
        self.force = 0.0
        topic = "instruments/%s/" % name
        self.velocity = rospy.Publisher(topic + "servo_jv", JointState, queue_size=1)
        rospy.Subscriber(topic + "measured_cf", WrenchStamped, self.measure, queue_size=1, tcp_nodelay=True)

    def measure(self, wrench):
        force = wrench.wrench.force
        self.force = math.sqrt(force.x ** 2 + force.y ** 2 + force.z ** 2)
        self.arrived.set()

    def command(self, wanted):
        """Sends the velocity that reduces the difference from the wanted force. Returns the force."""
        force = self.force
        speed = max(-MOST, min(MOST, GAIN * (wanted - force)))
        self.velocity.publish(JointState(velocity=[speed, 0.0]))
        return force


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--instrument", default="guidewire")
    parser.add_argument("--force", type=float, default=0.1, help="force to hold [N]")
    parser.add_argument("--seconds", type=float, default=60.0, help="longest time until the force is reached [s]")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("push_to_force", anonymous=True)
    loop = Loop(options.instrument)
    if not loop.arrived.wait(60.0):
        sys.exit("no measurement on instruments/%s/measured_cf: is the simulation running?" % options.instrument)
    rate = rospy.Rate(RATE)
    begin = rospy.get_time()
    while loop.command(options.force) < options.force:
        if rospy.get_time() > begin + options.seconds:
            sys.exit("%.3f N after %.0f s" % (loop.force, options.seconds))
        rate.sleep()
    print("reached %.3f N after %.1f s" % (loop.force, rospy.get_time() - begin))
    sum_of_forces, count = 0.0, 200
    for _ in range(count):
        sum_of_forces += loop.command(options.force)
        rate.sleep()
    print("held %.3f N in the mean of %.0f s" % (sum_of_forces / count, count / RATE))


if __name__ == "__main__":
    main()
