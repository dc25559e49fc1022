#!/usr/bin/env python3
"""Steers a wire into a branch of the vessel: pushes, and where it enters another branch, pulls back, turns and tries again.
This program is the clock of the simulation. Start, in two terminals:

    roslaunch endovascular_sim sim.launch pace:=stepped scene:=$(rospack find endovascular_sim)/config/scenes/fork.yaml
    rosrun endovascular_sim steer_into_branch.py --branch right
"""
import argparse
import sys

import rospy
from endovascular_sim.msg import InstrumentCommand
from endovascular_sim.srv import StepSimulation
from sensor_msgs.msg import JointState

STEPS = 20  # of one call: the wire is observed every 20 ms
SPEED = 0.03  # of push and withdrawal [m/s]
TURN = 1.0  # between two attempts [rad]
DEPTH = 0.01  # in a wrong branch from which it is left [m]


class Wire:
    """Wire under the hand of this client."""

    def __init__(self, name):
        rospy.wait_for_service("simulation/step", timeout=60.0)
        self.call = rospy.ServiceProxy("simulation/step", StepSimulation, persistent=True)
        self.name = name
        self.step()

    def step(self, command=None, **joints):
        """Gives a command, if any, takes STEPS steps, and observes the wire."""
        commands = [InstrumentCommand(self.name, command, JointState(**joints))] if command else []
        answer = self.call(STEPS, commands)
        if not answer.success:
            sys.exit("simulation/step: " + answer.message)
        state = next(wire for wire in answer.instruments if wire.name == self.name)
        self.time, self.branch, self.is_busy = answer.time, state.branch, state.is_busy
        self.insertion = state.measured.position[0]

    def advance(self, speed):
        self.step("servo_jv", velocity=[speed, 0.0])

    def turn(self, angle):
        self.step("move_jr", position=[0.0, angle])
        while self.is_busy:
            self.step()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--instrument", default="guidewire")
    parser.add_argument("--branch", default="right", help="goal")
    parser.add_argument("--parent", default="trunk", help="branch from which the goal leaves")
    parser.add_argument("--seconds", type=float, default=120.0, help="longest simulated time [s]")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("steer_into_branch", anonymous=True)
    wire = Wire(options.instrument)
    attempts, begun, has_passed = 1, wire.time, False
    while wire.branch != options.branch:
        if wire.time > options.seconds:
            sys.exit("not in %s after %.0f s and %d attempts" % (options.branch, wire.time, attempts))
        has_passed = has_passed or wire.branch == options.parent
        if not has_passed or wire.branch == options.parent:
            on_way = wire.insertion  # as far as the wire has been on its way
        wire.advance(SPEED)
        if wire.insertion > on_way + DEPTH or wire.time > begun + 10.0:
            print("%6.2f s: in %s, attempt %d" % (wire.time, wire.branch, attempts))
            while wire.insertion > max(0.02, on_way - 3 * DEPTH):
                wire.advance(-SPEED)
            wire.turn(TURN)
            attempts, begun = attempts + 1, wire.time
    print("%6.2f s: reached %s with %.0f mm of wire, attempt %d" %
          (wire.time, options.branch, 1e3 * wire.insertion, attempts))


if __name__ == "__main__":
    main()
