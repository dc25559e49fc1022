#!/usr/bin/python3
"""Trials of the recorder: the session node of a running graph is killed at random times (SIGKILL), loses its disk, is stopped
and started by services, and its bags are searched for private names.

Requirements after a kill:

- at most the last second before it is lost, by the steps that the graph had published then;
- the simulation goes on with all steps, in real time;
- every bag replays with 0 different steps and exit code 0;
- one report covers all bags; its gaps are the steps between them, and both bags beside a gap name it.
"""

import argparse
import json
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

import yaml

from fault_trials import Session
from running_graph import RunningGraph

START = 300  # longest start of a graph: a machine with other work is slow [s]
PATIENCE = 120  # longest wait for an event [s]
LOST = 1.0  # longest time before a fault whose steps may be lost [s]
SCENE = "config/scenes/tube.yaml"
SMALL = ["haptic_device:=false", "fluoroscopy:=false", "visualization:=false"]
SCRIPT = "drive.source=script haptic_device=false"


def programs():
    return os.path.join(os.environ["CMAKE_PREFIX_PATH"].split(":")[0], "lib/endovascular_sim/")


class Listener:
    """Steps of a graph as they arrive, in a process of its own: rospy has one master per process."""

    CODE = """
import sys, time, rospy
from endovascular_sim.msg import RodStateVisual, SessionSteps
rospy.init_node("listener", disable_signals=True)
def say(kind, step):
    print("%s %.6f %d" % (kind, time.monotonic(), step), flush=True)
expected = [None]
def steps(message):
    for one in message.steps:
        if expected[0] is not None and one.step != expected[0]:
            say("jump", one.step)
        expected[0] = one.step + 1
    say("step", message.steps[-1].step)
def state(message):
    say("step", message.step)
if sys.argv[1] == "real_time":
    rospy.Subscriber("session/steps", SessionSteps, steps, queue_size=1000)
else:  # the newest state only: Python cannot follow the steps
    rospy.Subscriber("rod/state_visual", RodStateVisual, state, queue_size=1)
rospy.spin()
"""

    def __init__(self, graph, pace):
        self.lines = []
        self.process = subprocess.Popen([sys.executable, "-c", self.CODE, pace], env=graph.environment,
                                        stdout=subprocess.PIPE, universal_newlines=True)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            kind, moment, step = line.split()
            self.lines.append((kind, float(moment), int(step)))

    def step_at(self, moment):
        """Newest step at a moment; 0 before the first one."""
        return max((step for kind, at, step in list(self.lines) if kind == "step" and at <= moment), default=0)

    def jumps(self):
        return [line for line in self.lines if line[0] == "jump"]

    def end(self):
        self.process.terminate()
        self.process.wait()


def output(program, *arguments):
    """Exit code and both streams of a tool."""
    done = subprocess.run([programs() + program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          universal_newlines=True)
    return done.returncode, done.stdout


def survey(bag):
    return json.loads(subprocess.run([programs() + "bag_check", "--json", "--quick", bag], stdout=subprocess.PIPE,
                                     universal_newlines=True).stdout)[0]


def bags_of(folder):
    names = [folder + "/session.bag"]
    while os.path.exists(folder + "/session_%d.bag" % (len(names) + 1)):
        names.append(folder + "/session_%d.bag" % (len(names) + 1))
    return names


def check(condition, text):
    if not condition:
        raise AssertionError(text)


def require_equal_replay(bag, code=0):
    done, text = output("replay", bag)
    check(done == code and (" 0 different" in text or "all of them equal" in text),
          "replay of %s ends with code %d: %s\n%s" % (bag, done, text, json.dumps(survey(bag)["steps"])))
    return text.strip().split("\n")[-1]


def require_one_report(folder, bags):
    """The report covers all bags, and names the gaps between them as the bags do."""
    with open(folder + "/report.json") as file:
        report = json.load(file)
    surveys = [survey(bag) for bag in bags]
    recorded = sum(one["steps"]["number"] for one in surveys)
    check(report["steps"] == recorded, "the report has %d steps, the bags %d" % (report["steps"], recorded))
    gaps = []
    for before, after, bag, next_ in zip(surveys, surveys[1:], bags, bags[1:]):
        if after["steps"]["first"] > before["steps"]["last"] + 1:
            gaps.append({"first_step": before["steps"]["last"] + 1, "last_step": after["steps"]["first"] - 1,
                         "previous": os.path.basename(bag), "next": os.path.basename(next_)})
            wanted = {"first": gaps[-1]["first_step"], "last": gaps[-1]["last_step"],
                      "previous": gaps[-1]["previous"], "next": gaps[-1]["next"]}
            for one in (before, after):
                check(wanted in one["gaps_between_bags"], "%s does not name the gap %s: %s" % (
                    one["file"], wanted, one["gaps_between_bags"]))
    check(report["gaps"] == gaps, "gaps of the report: %s, of the bags: %s" % (report["gaps"], gaps))
    missing = sum(gap["last_step"] - gap["first_step"] + 1 for gap in gaps)
    check(report["steps_missing_from_recording"] == missing, "the report lacks %d steps, the bags %d" % (
        report["steps_missing_from_recording"], missing))
    page = open(folder + "/metrics.html").read()
    check(not gaps or "Not recorded" in page, "metrics.html does not name the gaps")
    for gap in gaps:
        check(">%d<" % gap["first_step"] in page, "metrics.html does not name step %d" % gap["first_step"])
    return report, gaps


def kill_at_random_times(repository, folder, pace, kills, seed):
    """@return rows of a table"""
    chance = random.Random(seed)
    rows = []
    with RunningGraph(repository, folder, SCENE, "overrides:=" + SCRIPT, "pace:=" + pace, *SMALL) as graph:
        graph.wait(START, graph.is_running, "start")
        listener = Listener(graph, pace)
        results = folder + "/results"
        graph.wait(PATIENCE, lambda: listener.step_at(time.monotonic()) > 500, "steps")
        for k in range(kills):
            time.sleep(chance.uniform(0.5, 4.0))
            process = Session.node_of(graph.launch, "session")
            moment = time.monotonic()
            os.kill(process, signal.SIGKILL)
            step = listener.step_at(moment - LOST)
            now = listener.step_at(moment)
            bag = results + "/session_%d.bag" % (k + 2)
            graph.wait(PATIENCE, lambda: os.path.exists(bag) and "in " + bag in graph.text(), bag)
            back = time.monotonic() - moment
            before = survey(bags_of(results)[k])
            check(before["steps"]["last"] >= step, "kill %d: the bag ends at step %d, one second before the fault it was %d" % (
                k + 1, before["steps"]["last"], step))
            seen = listener.step_at(time.monotonic())
            graph.wait(PATIENCE, lambda: listener.step_at(time.monotonic()) > seen + 100, "further steps")
            rows.append((k + 1, now, now - before["steps"]["last"], back))
        time.sleep(2.0)
        jumps = listener.jumps()
        listener.end()
    check(not jumps, "steps are missing in the simulation: %s" % jumps)
    bags = bags_of(results)
    check(len(bags) == kills + 1, "%d bags after %d kills" % (len(bags), kills))
    for bag in bags:
        require_equal_replay(bag)
    _, gaps = require_one_report(results, bags)
    print("pace %s\n| kill | step at the kill | steps lost before it | new bag after [s] | steps of the gap |\n|---|---|---|---|---|" % pace)
    for (k, now, lost, back), gap in zip(rows, gaps):
        print("| %d | %d | %d | %.2f | %d |" % (k, now, max(0, lost), back, gap["last_step"] - gap["first_step"] + 1))
    print("%d bags replay with 0 different steps; one report with %d gaps" % (len(bags), len(gaps)))


def call(graph, service, request="{}"):
    done = subprocess.run(["rosservice", "call", service, request], env=graph.environment, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True, timeout=PATIENCE)
    answer = yaml.safe_load(done.stdout)
    return "%s %s" % (answer["success"], answer["message"]) if isinstance(answer, dict) else done.stdout


def services(repository, folder):
    """Remarks, stop and start of a recording."""
    results = folder + "/results"
    with RunningGraph(repository, folder, SCENE, "overrides:=" + SCRIPT + " record.subject=scene", "subject:=trainee_7",
                      *SMALL) as graph:
        graph.wait(START, graph.is_running, "start")
        time.sleep(2.0)
        check("True" in call(graph, "/session/mark", "{text: 'too fast here'}"), "the remark is refused")
        check("one line" in call(graph, "/session/mark", "{text: ''}"), "an empty remark is accepted")
        check("one line" in call(graph, "/session/mark", "{text: '%s'}" % (201 * "x")), "a long remark is accepted")
        check("one line" in call(graph, "/session/mark", "{text: \"a\\nb\"}"), "a remark of two lines is accepted")
        check("call session/stop first" in call(graph, "/session/start"), "a second recording begins")
        check("True" in call(graph, "/session/stop"), "the recording does not stop")
        check("no recording is open" in call(graph, "/session/mark", "{text: 'unheard'}"), "a remark without a recording")
        time.sleep(1.0)
        check("session_2.bag" in call(graph, "/session/start"), "no further recording begins")
        time.sleep(1.0)
        check("True" in call(graph, "/session/mark", "{text: 'better'}"), "the second remark is refused")
        time.sleep(1.0)
    bags = bags_of(results)
    check(len(bags) == 2, "bags: %s" % bags)
    for bag in bags:
        require_equal_replay(bag)
    report, gaps = require_one_report(results, bags)
    check([mark["text"] for mark in report["marks"]] == ["too fast here", "better"], "marks: %s" % report["marks"])
    check(report["subject"] == "trainee_7", "subject: %s" % report["subject"])
    check(len(gaps) == 1, "gaps: %s" % gaps)
    page = open(results + "/metrics.html").read()
    check("too fast here" in page and "better" in page, "metrics.html lacks a remark")
    print("remarks, stop and start: %d steps of the gap" % (gaps[0]["last_step"] - gaps[0]["first_step"] + 1))


def texts_of(value):
    """All texts of a message, of any depth."""
    if isinstance(value, str):
        return [value]
    if isinstance(value, (list, tuple)) and not (value and isinstance(value[0], (int, float))):
        return [text for item in value for text in texts_of(item)]
    return [text for slot in getattr(value, "__slots__", ()) for text in texts_of(getattr(value, slot))]


def private_names(repository, folder):
    """Nothing in a bag names the computer, the user, the home directory or the working directory."""
    home = folder + "/home_of_secretname"
    data = home + "/data"
    os.makedirs(data)
    shutil.copy(repository + "/config/anatomies/fork.yaml", data + "/own_fork.yaml")
    os.environ.update(HOME=home, USER="secretname", LOGNAME="secretname")
    os.chdir(home)
    graph = RunningGraph(repository, home + "/run", "config/scenes/fork.yaml",
                         "overrides:=drive.source=script vessel.anatomy=%s/own_fork.yaml" % data, *SMALL)
    with graph:
        graph.wait(START, graph.is_running, "start")
        time.sleep(4.0)
    import rosbag  # the module of ROS, after its environment
    found = set()
    hosts = {socket.gethostname(), socket.getfqdn()} - {"localhost", ""}
    with rosbag.Bag(home + "/run/results/session.bag") as bag:
        headers = [("header of " + one.topic, repr(one.header)) for one in bag._get_connections()]
        texts = [(where, text.encode()) for where, text in headers]
        texts += [(topic, raw[1]) for topic, raw, _ in bag.read_messages(raw=True)]
        words = headers + [(topic, text) for topic, message, _ in bag.read_messages() for text in texts_of(message)]
    for name in {"secretname", home, folder, repository}:
        found |= {(name, where) for where, bytes_ in texts if name.encode() in bytes_}
    # The name of a computer may be as short as two letters, which the bytes of numbers hold by chance.
    for name in hosts:
        found |= {(name, where) for where, text in words if re.search(r"\b%s\b" % re.escape(name), text)}
    check(not found, "the bag holds private names: %s" % sorted(found))
    require_equal_replay(home + "/run/results/session.bag")
    print("%d messages and headers hold none of %d names" % (len(texts), len(hosts) + 4))


def full_disk(repository, folder, disk):
    """@param disk empty file system of 80 MB"""
    for name, leaves in (("a little space", 20 << 20), ("no space", 0)):
        results = disk + "/results"
        with RunningGraph(repository, folder + "/" + name.replace(" ", "_"), SCENE, "overrides:=" + SCRIPT,
                          "results:=" + results, *SMALL) as graph:
            graph.wait(START, graph.is_running, "start")
            time.sleep(3.0)
            free = os.statvfs(disk).f_bavail * os.statvfs(disk).f_frsize
            try:
                with open(disk + "/filler", "wb", buffering=0) as filler:
                    filler.write(bytes(free - leaves))
            except OSError:
                pass
            graph.wait(PATIENCE, lambda: "ended early" in graph.text(), "end of the recording")
            listener = Listener(graph, "real_time")
            graph.wait(PATIENCE, lambda: len(listener.lines) > 100, "further steps")
            check(not listener.jumps(), "steps are missing in the simulation")
            listener.end()
            os.remove(disk + "/filler")
        line = require_equal_replay(results + "/session.bag", 3)
        found = survey(results + "/session.bag")
        check(found["steps"]["last"] > 2000, "the bag holds %s" % found["steps"])
        with open(results + "/report.json") as file:
            error = json.load(file)["recording"]["error"]
        check(error and ("free" in error or "space" in error), "the report's error: %s" % error)
        print("full disk, %s: %s; index: %s; %s" % (name, line, "no" if found["damage"] else "yes", error))
        shutil.rmtree(results)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository")
    parser.add_argument("--kills", type=int, default=0, help="kills of the session node per pace")
    parser.add_argument("--pace", action="append", default=[], choices=["real_time", "free"], help="may be repeated")
    parser.add_argument("--seed", type=int, default=1, help="of the random times")
    parser.add_argument("--services", action="store_true", help="remarks, stop and start of a recording")
    parser.add_argument("--private-names", action="store_true", help="searches a bag for names of user and computer")
    parser.add_argument("--disk", default="", help="empty file system of 80 MB, which the trial fills")
    parser.add_argument("--keep", default="", help="folder of the sessions, which is kept")
    arguments = parser.parse_args()
    repository = os.path.realpath(arguments.repository)
    folder = arguments.keep or tempfile.mkdtemp()
    try:
        for pace in arguments.pace:
            kill_at_random_times(repository, folder + "/" + pace, pace, arguments.kills, arguments.seed)
        if arguments.services:
            services(repository, folder + "/services")
        if arguments.disk:
            full_disk(repository, folder + "/disk", arguments.disk)
        if arguments.private_names:
            private_names(repository, folder)
    except AssertionError as failure:
        print("FAILED: %s" % failure)
        return 1
    finally:
        if not arguments.keep:
            shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
