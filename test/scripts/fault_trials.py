#!/usr/bin/python3
"""Trials with faults: every node of a running session is killed (SIGKILL) and stopped (SIGSTOP for 5 s, then SIGCONT).

A simulated haptic device drives the instrument. Its trace, on its own clock, holds hand, force and state at every sample.
Requirements of a trial:

- the force at the hand becomes zero; a node without effect on the force does not interrupt it;
- the device has the expected state meanwhile, and is enabled with force again after the recovery;
- the instrument moves no further than the hand;
- the first bag of the session replays completely, without a different step.

With --rounds the force must also be zero within 0.15 s. Such a time, and an
uninterrupted force, need processors without other work. A trial that misses one of them is repeated. If other work, which
the table names, occupied the machine each time, the trial is not judged by it: the table says so.
"""

import argparse
import bisect
import fcntl
import glob
import math
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

STOPPED = 5.0  # duration of a stop [s]
BOUND = 0.15  # largest time to zero force [s]
SETTLED = 0.03  # duration of zero force that counts as zero, not as a change of sign [s]
PATIENCE = 120.0  # longest wait for an event: a machine with other work is slow [s]
OTHER_WORK = 0.25  # processors occupied by others, from which on times are not judged [1]
ATTEMPTS = 3  # of a trial that other work may have disturbed
TOLERANCE = 1e-6  # of paths, whose samples are single precision [m], [rad]
DISABLED, ENABLED, PAUSED, FAULT = range(4)
STATES = ("disabled", "enabled", "paused", "fault")

# Effects of the loss of a node: the device's states without force, an uninterrupted force, or the end of the session.
PAUSES = {"contact": (PAUSED,), "rod_dynamics": (PAUSED,), "haptic_device": (DISABLED,)}
CONTINUES = ("vessel_server", "session", "fluoroscopy", "visualization")
REQUIRED = ("rod_dynamics", "vessel_server")

SHORT = [("kill", "contact"), ("kill", "haptic_device"), ("stop", "contact"), ("stop", "rod_dynamics"),
         ("stop", "session"), ("kill", "rod_dynamics")]
FULL = [("kill", "contact"), ("kill", "haptic_device"), ("kill", "fluoroscopy"), ("kill", "visualization"),
        ("stop", "contact"), ("stop", "haptic_device"), ("stop", "rod_dynamics"), ("stop", "vessel_server"),
        ("stop", "session"), ("stop", "fluoroscopy"), ("stop", "visualization"), ("kill", "rod_dynamics")]


class Trace:
    """Samples of the device, read while the simulator writes them."""

    def __init__(self, path):
        self.file = open(path)
        self.rest = ""
        self.times, self.rows = [], []

    def read(self):
        self.rest += self.file.read()
        lines = self.rest.split("\n")
        self.rest = lines.pop()
        for line in lines:
            if line.startswith("time"):
                continue
            row = [float(field) for field in line.split(",")]
            self.times.append(row[0])
            self.rows.append(row[1:])

    def between(self, begin, end):
        return range(bisect.bisect_left(self.times, begin), bisect.bisect_right(self.times, end))

    def has_force(self, index):
        return self.rows[index][2] != 0.0 or self.rows[index][3] != 0.0

    def state(self, index):
        return int(self.rows[index][4])

    def zero_since(self, begin, end):
        """First sample from which the force is zero for SETTLED; None if there is none."""
        first = None
        for index in self.between(begin, end):
            if self.has_force(index):
                first = None
            elif first is None:
                first = index
            if first is not None and self.times[index] - self.times[first] >= SETTLED:
                return first
        return None

    def enabled_since(self, begin, end):
        """First sample with force and state enabled; None if there is none."""
        return next((k for k in self.between(begin, end) if self.has_force(k) and self.state(k) == ENABLED), None)

    def largest_gap(self, begin, end):
        """Longest time without a sample [s]: the device itself was delayed by the machine."""
        times = [self.times[k] for k in self.between(begin, end)]
        return max((b - a for a, b in zip(times, times[1:])), default=math.inf)

    def path(self, joint, begin, end):
        values = [self.rows[k][joint] for k in self.between(begin, end)]
        return sum(abs(b - a) for a, b in zip(values, values[1:]))


def claims_of_others(*own):
    """Processors that other sessions of this machine claim. @param own ports of the masters of own sessions"""
    found = []
    for path in glob.glob("/dev/shm/endovascular_sim/[0-9]*-*"):
        if any(str(port) in path for port in own):
            continue
        try:
            with open(path) as claim:
                fcntl.flock(claim, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            found.append(int(os.path.basename(path).split("-")[0]))
        except OSError:
            pass
    return found


def tree_of(root):
    """A process and all processes that it has started."""
    pids = [root]
    for pid in pids:
        for children in glob.glob("/proc/%d/task/*/children" % pid):
            try:
                pids += [int(child) for child in open(children).read().split()]
            except FileNotFoundError:
                pass
    return pids


class OtherWork:
    """Processor time that others use: processes that are none of a session's, and other virtual machines."""

    def __init__(self, roots):
        self.roots = [os.getpid(), *roots]
        self.begin = time.monotonic()
        self.before = self.used()

    def used(self):
        fields = [int(field) for field in open("/proc/stat").readline().split()[1:9]]
        user, nice, system, _, _, irq, soft, steal = fields
        own = 0
        for pid in {pid for root in self.roots for pid in tree_of(root)}:
            try:
                times = open("/proc/%d/stat" % pid).read().rsplit(")", 1)[1].split()
                own += int(times[11]) + int(times[12])
            except (FileNotFoundError, ProcessLookupError):
                pass
        return user + nice + system + irq + soft + steal - own

    def processors(self):
        """Mean number of processors since the begin."""
        elapsed = max(time.monotonic() - self.begin, 1e-3)
        return max(0.0, (self.used() - self.before) / os.sysconf("SC_CLK_TCK") / elapsed)


class Session:
    """A simulated device and the graph of a scene, in a folder of their own."""

    def __init__(self, repository, scene, folder, moving):
        self.folder = folder
        os.makedirs(folder)
        self.wall_offset = time.time() - time.monotonic()
        with open(folder + "/hand.csv", "w") as script:
            self.write_hand(script, moving)
        with socket.socket() as free:
            free.bind(("localhost", 0))
            self.port = port = free.getsockname()[1]
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros",
                           ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        programs = os.path.join(environment["CMAKE_PREFIX_PATH"].split(":")[0], "lib/endovascular_sim/")
        self.replay_program = programs + "replay"
        self.processes = []
        self.start("device", [programs + "device_simulator", "--link", folder + "/device", "--script",
                              folder + "/hand.csv", "--start", "enabled", "--baud", "460800",
                              "--trace", folder + "/trace.csv"], environment)
        self.wait("the device", lambda: os.path.exists(folder + "/device"))
        self.trace = Trace(folder + "/trace.csv")
        self.graph = self.launch(repository, scene, environment)

    def launch(self, repository, scene, environment):
        """Starts the graph. roslaunch waits ten seconds for its master, which a busy machine may exceed."""
        command = ["roslaunch", "-p", str(self.port), repository + "/launch/sim.launch", "scene:=" + scene,
                   "device:=" + self.folder + "/device", "baud:=460800", "results:=" + self.folder + "/results"]
        for attempt in range(ATTEMPTS):
            graph = self.start("launch", command, environment)
            self.wait("start of the graph", lambda: graph.poll() is not None or self.node_of(graph, "session") is not None)
            if graph.poll() is None or "could not contact master" not in self.log():
                break
        return graph

    @staticmethod
    def write_hand(script, moving):
        """Three seconds of insertion; then the hand holds still, or moves to and fro by 1 mm and 0.1 rad."""
        script.write("0, 0, 0\n3, 0.06, 0.5\n")
        for second in range(4, 600):
            away = moving and second % 2 == 0
            script.write("%d, %g, %g\n" % (second, 0.061 if away else 0.06, 0.6 if away else 0.5))

    def start(self, name, command, environment):
        log = open("%s/%s.log" % (self.folder, name), "w")
        process = subprocess.Popen(command, env=environment, stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.processes.append(process)
        return process

    def wait(self, event, condition, patience=PATIENCE):
        end = time.monotonic() + patience
        while not condition():
            if time.monotonic() > end or self.processes[0].poll() is not None:
                raise AssertionError("%s: not within %g s\n%s" % (event, patience, self.log()))
            time.sleep(0.02)

    def log(self):
        return "".join("-- %s\n%s" % (name, open(self.folder + "/" + name).read()[-3000:])
                       for name in ("device.log", "launch.log") if os.path.exists(self.folder + "/" + name))

    def wait_for_hand(self):
        """Waits until the hand has inserted the instrument, and holds it with force."""
        def is_held():
            if self.graph.poll() is not None:
                raise AssertionError("the graph has ended\n" + self.log())
            self.trace.read()
            return bool(self.trace.rows) and self.trace.rows[-1][0] >= 0.0599 and self.has_recovered(time.monotonic() - 0.2)
        self.wait("insertion by the hand", is_held, 3 * PATIENCE)
        time.sleep(1.5)

    def has_recovered(self, since):
        self.trace.read()
        return self.trace.enabled_since(since, math.inf) is not None

    def process_of(self, node):
        return self.node_of(self.graph, node)

    @staticmethod
    def node_of(graph, node):
        """Process of a node: the child of roslaunch with its name."""
        # A thread of roslaunch starts it again, hence the children of every thread.
        for children in glob.glob("/proc/%d/task/*/children" % graph.pid):
            for pid in open(children).read().split():
                try:
                    words = open("/proc/%s/cmdline" % pid, "rb").read().split(b"\0")
                except FileNotFoundError:
                    continue
                if ("__name:=" + node).encode() in words:
                    return int(pid)
        return None

    def is_running(self, node):
        return self.process_of(node) is not None

    def end(self):
        for process in (self.graph, self.processes[0]):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
            try:
                process.wait(timeout=60)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        self.trace.read()

    def replay(self):
        """Exit code and output of the comparison of the bag."""
        bag = self.folder + "/results/session.bag"
        if not os.path.exists(bag):
            bag += ".active"
        done = subprocess.run([self.replay_program, bag], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              universal_newlines=True)
        return done.returncode, done.stdout.strip()

    def applied(self):
        """Time of the device's clock [s], insertion [m] and rotation [rad] of every step in the bag."""
        import rosbag  # the module of ROS, after its environment
        rows = []
        with rosbag.Bag(self.folder + "/results/session.bag") as bag:
            for _, message, _ in bag.read_messages(topics=["/drive/applied"]):
                rows.append((message.header.stamp.to_sec() - self.wall_offset, message.insertion[0], message.rotation[0]))
        return rows


class Trial:
    """One fault of one node, its measurements and its failures."""

    def __init__(self, session, kind, node, ends):
        self.session, self.kind, self.node, self.ends = session, kind, node, ends
        self.failures = []
        self.zero = self.recovery = None
        self.paths = None
        self.states = set()
        self.remark = ""
        self.other_work = 0.0  # processors
        self.disturbed = False  # other work may have caused a missed time or an interruption

    @property
    def is_busy(self):
        return self.other_work > OTHER_WORK or bool(claims_of_others(self.session.port))

    @property
    def is_interrupted(self):
        return self.ends or self.node in PAUSES

    def run(self):
        trace = self.session.trace
        pid = self.session.process_of(self.node)
        work = OtherWork([self.session.graph.pid, self.session.processes[0].pid])
        self.begin = time.monotonic()
        os.kill(pid, signal.SIGKILL if self.kind == "kill" else signal.SIGSTOP)
        if self.kind == "stop":
            time.sleep(STOPPED)
            self.wait_for_zero()
            observed = time.monotonic()
            os.kill(pid, signal.SIGCONT)
        else:
            time.sleep(0.6)
            self.wait_for_zero()
            observed = time.monotonic()
        if self.ends:
            self.session.wait("end of the graph", lambda: self.session.graph.poll() is not None)
            observed = time.monotonic()
        trace.read()
        time.sleep(0.1)
        trace.read()
        self.other_work = work.processors()
        self.examine(trace, observed)
        if not self.ends:
            self.recover(trace, observed)
        self.finish = time.monotonic()
        self.gap = trace.largest_gap(self.begin, observed)

    def wait_for_zero(self):
        """Waits until the force has become zero where it must; on a busy machine that takes a while."""
        def is_zero():
            self.session.trace.read()
            return self.session.trace.zero_since(self.begin, math.inf) is not None
        if self.is_interrupted and not self.ends:
            self.session.wait("zero force", is_zero)

    def examine(self, trace, observed):
        """Force and state until the end of the observation."""
        zero = trace.zero_since(self.begin, observed)
        if not self.is_interrupted:
            self.disturbed = zero is not None
            self.states = {ENABLED}
            return
        if zero is None:
            self.failures.append("the force never becomes zero")
            return
        self.zero = trace.times[zero] - self.begin
        until = max(self.begin + 0.6, trace.times[zero] + SETTLED) if self.kind == "kill" and not self.ends else observed
        samples = [k for k in trace.between(trace.times[zero] + SETTLED, until)]
        self.states = {trace.state(k) for k in samples}
        wanted = {DISABLED, PAUSED} if self.ends else set(PAUSES[self.node])
        may_recover = self.kind == "kill" and self.node == "contact"  # within the observation
        if not self.states <= wanted | ({ENABLED} if may_recover else set()):
            self.failures.append("the device's states are %s" % [STATES[state] for state in self.states])
        if self.kind == "stop" and any(trace.has_force(k) for k in samples):
            self.failures.append("force during the stop")

    def recover(self, trace, observed):
        since = trace.times[trace.zero_since(self.begin, observed)] if self.zero is not None else observed
        if self.kind == "stop":
            since = observed
        self.session.wait("recovery after %s of %s" % (self.kind, self.node), lambda: self.session.has_recovered(since))
        self.recovery = trace.times[trace.enabled_since(since, math.inf)] - (observed if self.kind == "stop" else self.begin)
        self.session.wait("restart of " + self.node, lambda: self.session.is_running(self.node))
        time.sleep(1.0)  # motion after the recovery belongs to the trial

    def is_late(self, judges_times):
        return judges_times and self.zero is not None and self.zero > BOUND

    def judge(self, judges_times):
        """Adds missed times and interruptions, unless other work of the machine may be their cause."""
        text = ""
        if self.disturbed:
            text = "the force is interrupted"
        elif self.is_late(judges_times):
            text = "the force is zero after %.3f s only" % self.zero
        if text and self.is_busy:
            self.remark = "not judged, %.1f processors are used by others: %s" % (self.other_work, text)
        elif text:
            self.failures.append(text)

    def compare_motion(self, applied):
        """The instrument moves no further than the hand."""
        rows = [row for row in applied if self.begin - 0.5 <= row[0] <= self.finish]
        if len(rows) < 100:
            self.failures.append("the bag holds %d steps of the trial" % len(rows))
        self.paths = []
        for joint, name in enumerate(("insertion", "rotation")):
            wire = sum(abs(b[joint + 1] - a[joint + 1]) for a, b in zip(rows, rows[1:]))
            hand = self.session.trace.path(joint, self.begin - 1.0, self.finish)
            self.paths.append((wire, hand))
            if wire > hand + TOLERANCE:
                self.failures.append("%s: the instrument moved by %.6g, the hand by %.6g" % (name, wire, hand))


def run_session(repository, scene, folder, moving, faults, ends, judges_times):
    """Runs trials in one session. @return trials, failures of the session, line of the replay"""
    session = Session(repository, scene, folder, moving)
    trials, failures = [], []
    try:
        session.wait_for_hand()
        for kind, node in faults:
            is_last = ends and (kind, node) == faults[-1]
            for attempt in range(1 if is_last else ATTEMPTS):
                trial = Trial(session, kind, node, is_last)
                trial.run()
                if trial.failures or not (trial.disturbed or trial.is_late(judges_times)):
                    break
                print("missed: %s of %s, attempt %d, %.1f processors used by others" %
                      (kind, node, attempt + 1, trial.other_work), flush=True)
            trials.append(trial)
    finally:
        session.end()
    for trial in trials:
        trial.judge(judges_times)
    was_killed = faults[-1] == ("kill", "session")
    code, line = session.replay()
    if code != 0 or not (line.find(" 0 different") > 0 or line.find("all of them equal") > 0):
        failures.append("replay ends with code %d: %s" % (code, line))
    if not was_killed:
        applied = session.applied()
        for trial in trials:
            trial.compare_motion(applied)
    return trials, failures, line


def row_of(round_, trial):
    def of(value, form, factor=1.0):
        return "–" if value is None else form % (factor * value)
    motion = "–" if trial.paths is None else "%.3f of %.3f" % tuple(1e3 * path for path in trial.paths[0])
    states = "/".join(STATES[state] for state in sorted(trial.states))
    return "| %d | %s | `%s` | %s | %s | %s | %s | %.1f | %s |" % (
        round_, trial.kind, trial.node,
        of(trial.zero, "%.0f", 1e3) if trial.is_interrupted else "uninterrupted", states,
        "the session ends" if trial.ends else of(trial.recovery, "%.2f"), motion, trial.other_work,
        "; ".join(trial.failures) or trial.remark or "ok")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository")
    parser.add_argument("--rounds", type=int, default=0,
                        help="rounds over all nodes, the hand moves in every second one; 0: one short round")
    parser.add_argument("--keep", default="", help="folder of the sessions, which is kept")
    arguments = parser.parse_args()
    data = os.path.realpath(arguments.repository) + "/test/data/"
    if claims_of_others():
        print("another session runs on this machine: times and interruptions of the force are not judged")
    plans = []
    for round_ in range(1, max(1, arguments.rounds) + 1):
        moving = round_ % 2 == 0
        plans.append((round_, "hand_in_tube", moving, FULL if arguments.rounds else SHORT, True))
        plans.append((round_, "hand_in_tube", moving, [("kill", "vessel_server")], True))
        if arguments.rounds:
            plans.append((round_, "hand_in_tube", moving, [("kill", "session")], False))
        plans.append((round_, "hand_with_balloon", moving, [("kill", "haptic_device")], False))
    folder = arguments.keep or tempfile.mkdtemp()
    table, lines, failed = [], [], False
    try:
        for number, (round_, scene, moving, faults, ends) in enumerate(plans):
            judges_times = arguments.rounds > 0
            trials, failures, line = run_session(os.path.realpath(arguments.repository), data + scene + ".yaml",
                                                 "%s/%d" % (folder, number), moving, faults, ends, judges_times)
            if ends and trials[-1].is_late(judges_times):
                print("repeated in a new session: zero force after %.3f s" % trials[-1].zero, flush=True)
                repeated, more, line_of_repetition = run_session(
                    os.path.realpath(arguments.repository), data + scene + ".yaml", "%s/%d_again" % (folder, number), moving,
                    faults[-1:], True, judges_times)
                trials[-1:], failures, line = repeated, failures + more, line + "; repeated: " + line_of_repetition
            rows = [row_of(round_, trial) for trial in trials]
            print("\n".join(rows), flush=True)
            table += rows
            lines.append("%s, %s hand: %s" % (scene, "moving" if moving else "still", line))
            for failure in failures:
                print("FAILED: " + failure)
            failed = failed or bool(failures) or any(trial.failures for trial in trials)
    finally:
        if not arguments.keep:
            shutil.rmtree(folder, ignore_errors=True)
    print("\n| round | fault | node | zero force [ms] | device | recovery [s] | instrument of hand [mm] | processors used by others | result |")
    print("|---|---|---|---|---|---|---|---|---|")
    print("\n".join(table))
    print("\n".join(lines))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
