#!/usr/bin/env python3
"""Measures calls of simulation/step per second, by the number of steps per call. Start, in two terminals:

    roslaunch endovascular_sim sim.launch pace:=stepped scene:=$(rospack find endovascular_sim)/config/scenes/fork.yaml
    rosrun endovascular_sim call_rate.py
"""
import argparse
import sys
import time

import rospy
from endovascular_sim.srv import StepSimulation
from std_srvs.srv import Trigger


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=2000, help="steps of each measurement, from the scene's beginning")
    parser.add_argument("--sizes", type=int, nargs="+", default=[1, 5, 10, 100, 1000], help="steps per call")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("call_rate", anonymous=True)
    for service in ("simulation/reset", "simulation/step"):
        rospy.wait_for_service(service, timeout=60.0)
    reset = rospy.ServiceProxy("simulation/reset", Trigger)
    step = rospy.ServiceProxy("simulation/step", StepSimulation, persistent=True)
    print("steps per call   calls per second   steps per second   trajectory")
    for size in options.sizes:
        answer = reset()
        if not answer.success:
            sys.exit("simulation/reset: " + answer.message)
        calls = max(1, options.steps // size)
        begin = time.monotonic()
        for _ in range(calls):
            answer = step(size, [])
            if not answer.success:
                sys.exit("simulation/step: " + answer.message)
        seconds = time.monotonic() - begin
        print("%14d   %16.1f   %16.0f   %016x" %
              (size, calls / seconds, calls * size / seconds, answer.trajectory_hash), flush=True)


if __name__ == "__main__":
    main()
