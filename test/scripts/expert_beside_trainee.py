"""The expert beside a played recording of a trainee: its state is that of its own recording in each alignment, and the distance of the tips
is that computed from the two bags. Arguments: REPOSITORY PROGRAMS FOLDER."""

import json
import math
import os
import shutil
import signal
import socket
import subprocess
import sys
import time

import numpy as np
import rospy

import endovascular_sim as evs
from endovascular_sim.msg import ExpertState
from endovascular_sim.srv import AlignExpert, PlayerControl

import bag_sessions

SCRIPTED = ("procedure.guided=false", "drive.source=procedure")
ALIGNMENTS = {"start": ExpertState.START, "phase": ExpertState.PHASE, "insertion": ExpertState.INSERTION}


class Run:
    """Poses of a bag with the step of the procedure at each."""

    def __init__(self, path):
        bag = evs.Bag(path)
        # Of states that were recorded at one time the player shows the last one.
        states = list({time: state for time, state in bag.read("rod/state_visual")}.values())
        steps = [step for _, step in bag.read("procedure/step")]
        self.times = np.array([state["time"] for state in states])
        self.tips = np.array([state["nodes"][-1] for state in states])
        self.insertions = np.array([state["insertion"] for state in states])
        self.steps = [max([max(step["step_of_procedure"], 1) for step in steps if step["begin"] <= time] or [0]) for time in self.times]
        self.begins = {number: min(step["begin"] for step in steps if step["step_of_procedure"] == number) for number in set(self.steps) if number}

    def at(self, time):
        """Index of the pose with this time."""
        index = int(np.abs(self.times - time).argmin())
        assert abs(self.times[index] - time) < 1e-9, "no pose at %r" % time
        return index

    def before(self, time, first, last):
        """Index of the last pose at or before a time, within a range."""
        found = [k for k in range(first, last + 1) if self.times[k] <= time + 1e-9]
        return found[-1] if found else first


def expected(alignment, trainee, k, expert):
    """Index of the expert's pose beside the trainee's pose k."""
    step = trainee.steps[k]
    of_step = [i for i, number in enumerate(expert.steps) if number == step] or [len(expert.times) - 1]
    first, last = of_step[0], of_step[-1]
    if alignment == "insertion":
        differences = np.abs(expert.insertions[first:last + 1] - trainee.insertions[k]).max(axis=1)
        return first + int(np.flatnonzero(differences == differences.min())[-1])
    if alignment == "phase":
        return expert.before(expert.times[first] + trainee.times[k] - trainee.begins[step], first, last)
    return expert.before(expert.times[0] + trainee.times[k] - trainee.times[0], 0, len(expert.times) - 1)


class Nodes:
    """Master, player and expert, which end with the block of the `with` statement."""

    def __init__(self, programs, folder, bag, expert):
        with socket.socket() as free:
            free.bind(("localhost", 0))
            port = free.getsockname()[1]
        os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros")
        self.log = open(folder + "/nodes.log", "w")
        self.processes = [self.start("roscore", "-p", str(port))]
        self.wait(30, lambda: subprocess.run(["rosparam", "set", "/expert_results", expert], stderr=subprocess.DEVNULL, check=False).returncode == 0,
                  "the master")
        subprocess.run(["rosparam", "set", "/use_sim_time", "true"], check=True)
        self.processes += [self.start(programs + "/expert", "_alignment:=start"), self.start(programs + "/player", bag, "--rate=2", "--pause")]

    def start(self, *words):
        return subprocess.Popen(words, stdout=self.log, stderr=subprocess.STDOUT,
                                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def wait(self, seconds, condition, name):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "%s: not within %g s\n%s" % (name, seconds, open(self.log.name).read()[-3000:])
            time.sleep(0.1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.send_signal(signal.SIGINT)
            process.wait(timeout=30)


def seek_and_compare(name, nodes, seen, control, trainee, expert):
    """Seeks to several times of the trainee and compares what the expert shows. Returns the number of comparisons."""
    compared = 0
    for target in np.linspace(trainee.times[5], trainee.times[-5], 12):
        shown = control(PlayerControl._request_class.SEEK_TIME, target).time
        k = trainee.at(shown)
        wanted = expected(name, trainee, k, expert)

        def stands():
            # The state and the step of the procedure arrive one after the other.
            return seen and abs(seen[-1].time - shown) < 1e-9 and abs(seen[-1].expert_time - expert.times[wanted]) < 1e-9

        try:
            nodes.wait(20, stands, "the expert")
        except AssertionError as late:
            newest = " ".join(str(seen[-1]).split()) if seen else "nothing"
            raise AssertionError("%s: the expert at %r s beside the trainee at %r s; shown is %s" % (name, expert.times[wanted], shown, newest)) from late
        state = seen[-1]
        distance = np.linalg.norm(trainee.tips[k] - expert.tips[wanted])
        assert abs(distance - state.distance) < 1e-12, (name, state.time, distance, state.distance)
        compared += 1
    return compared


def main():
    repository, programs, folder = sys.argv[1:]
    scene = repository + "/config/scenes/lesson_bifurcation.yaml"
    code, out, err = bag_sessions.run(programs + "/expert_recording", scene, "--cache", folder + "/experts")
    assert code == 0, err
    expert_folder = out.strip()
    code, out, err = bag_sessions.run(programs + "/replay", expert_folder + "/session.bag")
    assert code == 0 and " 0 different" in out, out + err
    live = bag_sessions.record(repository, folder + "/trainee", scene, *SCRIPTED, "duration=12", "drive.initial_rotation=1.0")
    trainee, expert = Run(live + "/session.bag"), Run(expert_folder + "/session.bag")
    with Nodes(programs, folder, live + "/session.bag", expert_folder) as nodes:
        rospy.init_node("test", disable_signals=True)
        seen = []
        rospy.Subscriber("/expert/state", ExpertState, seen.append, queue_size=100)
        for service in ("/player/control", "/expert/align"):
            rospy.wait_for_service(service, 30)
        control = rospy.ServiceProxy("/player/control", PlayerControl)
        align = rospy.ServiceProxy("/expert/align", AlignExpert)
        nodes.wait(30, lambda: align(ExpertState.START).success, "the expert's recording")
        compared = 0
        for name, number in ALIGNMENTS.items():
            assert align(number).success
            compared += seek_and_compare(name, nodes, seen, control, trainee, expert)
        assert not align(9).success
        assert align(ExpertState.HIDDEN).success
        nodes.wait(10, lambda: seen[-1].alignment == ExpertState.HIDDEN and math.isnan(seen[-1].distance), "the hidden expert")
    distances = [state.distance for state in seen if math.isfinite(state.distance)]
    assert max(distances) > 1e-3, "trainee and expert do not differ"
    print("%d states compared, largest distance %.1f mm" % (compared, 1e3 * max(distances)))
    # A recorded session becomes the expert, and one of another scene does not.
    finished = shutil.copytree(expert_folder, folder + "/finished")
    shutil.rmtree(expert_folder)
    code, out, err = bag_sessions.run(programs + "/expert_recording", scene, "--cache", folder + "/experts", "--from", finished)
    assert code == 0 and evs.Bag(out.strip() + "/session.bag").hashes == evs.Bag(finished + "/session.bag").hashes, err
    with open(live + "/metrics.json") as stream:
        metrics = json.load(stream)
    metrics["lesson"]["marks"][0]["value"] = 2.0  # steps that are not done
    with open(live + "/metrics.json", "w") as stream:
        json.dump(metrics, stream)
    code, out, err = bag_sessions.run(programs + "/expert_recording", scene, "--cache", folder + "/experts", "--from", live)
    assert code == 1 and "is not finished: 2 steps" in err, err
    code, out, err = bag_sessions.run(programs + "/expert_recording", repository + "/config/scenes/demo.yaml", "--cache", folder + "/experts",
                                      "--from", finished)
    assert code == 1 and "is a session of lesson_bifurcation" in err, err


main()
