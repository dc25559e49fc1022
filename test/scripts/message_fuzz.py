#!/usr/bin/python3
"""Mutated messages to every topic that a node of a running graph subscribes to. No node may end or hang.

The topics are those that the master lists, so that a new topic is tested too. Half of the mutations change bytes of a
recorded message, the other half its fields: empty and overlong arrays, NaN, infinities, huge numbers and indices. The
seed determines all of them.

  message_fuzz.py REPOSITORY --messages 2000 --seed 1
"""

import argparse
import io
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import time
import xmlrpc.client

from running_graph import RunningGraph

HANG = 20.0  # time without diagnostics of a node that counts as a hang [s of its processor time]
PATIENCE = 180.0  # the same where the machine is busy with something else [s]
START = 180.0  # longest start of a graph [s]
RECORDED = 6.0  # time in which messages are recorded [s]
INTERVAL = 0.015  # between two messages: queues of one message must not hide the one before [s]
ROUND = 40  # messages between two examinations

# Graphs that have every node and every kind of topic together: scene, arguments of sim.launch.
GRAPHS = [("test/data/every_node.yaml", ["robot:=true", "device:={folder}/none", "baud:=250000"]),
          ("test/data/procedure_with_balloon.yaml", ["pace:=free", "overrides:=duration=3600 flow=adult"]),
          ("test/data/catheter_in_motion.yaml", ["pace:=free", "haptic_device:=false"])]
NOT_OURS = ("/rosout", "/robot_state_publisher")


def uniform_number(rng, kind):
    """Number that is likely to be wrong, for a numeric type of ROS."""
    if kind in ("float32", "float64"):
        return rng.choice([float("nan"), float("inf"), float("-inf"), 0.0, -1.0, 1e-300, 1e30, -1e30, rng.uniform(-1, 1)])
    bits = {"bool": 8, "byte": 8, "char": 8}.get(kind) or int(kind.lstrip("uint"))
    signed = kind in ("byte",) or kind.startswith("int")
    largest = 2 ** (bits - 1) - 1 if signed else 2 ** bits - 1
    return rng.choice([0, 1, largest, largest - 1, largest // 2, -largest - 1 if signed else 2, rng.randrange(largest)])


class Mutator:
    """Mutations of the fields of a message."""

    def __init__(self, rng):
        self.rng = rng

    def fields(self, message, found):
        """All pairs of a message and the index of one of its fields, also below it."""
        for index, (name, kind) in enumerate(zip(message.__slots__, message._slot_types)):
            found.append((message, index))
            value = getattr(message, name)
            if hasattr(value, "_slot_types"):
                self.fields(value, found)
            elif isinstance(value, list) and value and hasattr(value[0], "_slot_types"):
                self.fields(self.rng.choice(value), found)
        return found

    def mutate(self, message):
        for _ in range(self.rng.choice([1, 1, 2, 4])):
            owner, index = self.rng.choice(self.fields(message, []))
            name, kind = owner.__slots__[index], owner._slot_types[index]
            setattr(owner, name, self.changed(getattr(owner, name), kind))

    def changed(self, value, kind):
        rng = self.rng
        if kind.endswith("]"):
            return self.changed_array(value, kind)
        if kind == "string":
            return rng.choice(["", "x" * 20000, "%s%n", "../../etc", "\x00\x01"])
        if kind in ("time", "duration"):
            value.secs, value.nsecs = rng.choice([(0, 0), (2 ** 31 - 1, 999999999), (2 ** 31 - 2, 0), (1, 1)])
            return value
        if hasattr(value, "_slot_types"):
            self.mutate(value)
            return value
        return uniform_number(rng, kind)

    def changed_array(self, value, kind):
        rng = self.rng
        element, size = kind[:-1].split("[")
        if isinstance(value, (bytes, bytearray)):
            value = list(value)
        value = list(value)
        if not size:
            way = rng.randrange(4)
            if way == 0:
                return []
            if way == 1 and value:
                return value[:rng.randrange(len(value))]
            if way == 2 and value:
                return (value * (1 + 2000 // len(value)))[:rng.randrange(2000)]
        if value and not hasattr(value[0], "_slot_types") and element != "string":
            for _ in range(rng.choice([1, len(value)])):
                value[rng.randrange(len(value))] = uniform_number(rng, element)
        return value


def with_changed_bytes(rng, data):
    """Serialised message with some bytes changed, removed or added."""
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 8])):
        at = rng.randrange(len(data)) if data else 0
        way = rng.randrange(6)
        if way == 0 and data:
            data[at] = rng.randrange(256)
        elif way == 1:
            data[at:at + 4] = struct.pack("<I", rng.choice([0, 1, 2 ** 32 - 1, 2 ** 31, 2 ** 28, 10 ** 6]))
        elif way == 2:
            data[at:at + 8] = struct.pack("<d", rng.choice([float("nan"), float("inf"), 1e300, -1e9, 0.0]))
        elif way == 3:
            del data[at:]
        elif way == 4:
            del data[at:at + rng.randrange(1, 64)]
        else:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 64)))
    return bytes(data)


def filled(rng, message, depth=0):
    """Message without a recorded example, with short arrays."""
    for name, kind in zip(message.__slots__, message._slot_types):
        value = getattr(message, name)
        if hasattr(value, "_slot_types"):
            filled(rng, value, depth + 1)
        elif kind.endswith("[]") and depth < 4:
            element = kind[:-2]
            if element == "string":
                setattr(message, name, ["insertion", "rotation"])
            elif "/" in element:
                setattr(message, name, [filled(rng, new_message(element), depth + 1) for _ in range(3)])
            elif element not in ("time", "duration", "uint8", "char"):
                setattr(message, name, [rng.choice([0, 1]) for _ in range(3)])
    return message


def new_message(kind):
    import roslib.message
    return roslib.message.get_message_class(kind)()


class Topic:
    """A topic with recorded messages, and its publisher of raw bytes."""

    def __init__(self, rospy, name, kind):
        import roslib.message
        self.rospy, self.name = rospy, name
        self.type = roslib.message.get_message_class(kind)
        assert self.type is not None, kind
        self.recorded = []
        self.raw = type("Raw", (self.type,), {"__slots__": self.type.__slots__ + ["raw"],
                                              "serialize": lambda message, buffer: buffer.write(message.raw)})
        self.subscriber = rospy.Subscriber(name, rospy.AnyMsg, self.record, queue_size=2)

    def record(self, message):
        if len(self.recorded) >= 20:
            return
        if isinstance(message, self.rospy.AnyMsg):
            self.recorded.append(message._buff)
        else:  # of a subscription that shares the connection
            buffer = io.BytesIO()
            message.serialize(buffer)
            self.recorded.append(buffer.getvalue())

    def advertise(self):
        self.subscriber.unregister()
        self.publisher = self.rospy.Publisher(self.name, self.raw, queue_size=100)

    def example(self, rng):
        if self.recorded and rng.random() < 0.9:
            return rng.choice(self.recorded)
        buffer = io.BytesIO()
        filled(rng, self.type()).serialize(buffer)
        return buffer.getvalue()

    def mutated(self, rng):
        import genpy
        example = self.example(rng)
        message = self.type()
        if rng.random() < 0.5 or not message.__slots__:
            return with_changed_bytes(rng, example)
        message.deserialize(example)
        try:
            Mutator(rng).mutate(message)
            buffer = io.BytesIO()
            message.serialize(buffer)
            return buffer.getvalue()
        except (genpy.SerializationError, struct.error, ValueError):
            return with_changed_bytes(rng, example)

    def publish(self, data):
        message = self.raw()
        message.raw = data
        self.publisher.publish(message)


class Graph(RunningGraph):
    """A running graph, and the last diagnostics of its nodes."""

    def __init__(self, repository, folder, scene, arguments):
        super().__init__(repository, folder, scene, "stop_at_duration:=true",
                         *[argument.format(folder=folder) for argument in arguments])
        os.environ.update(self.environment)
        self.heard = {}
        self.lock = threading.Lock()

    def hear(self, message):
        with self.lock:
            self.heard[message._connection_header["callerid"]] = time.monotonic()

    def pids(self):
        """Processes of the nodes, by their names."""
        master = xmlrpc.client.ServerProxy(self.uri)
        nodes = set(node for kind in master.getSystemState("/fuzz")[2] for _, names in kind for node in names)
        pids = {}
        for node in nodes:
            if node.startswith(NOT_OURS) or node.startswith("/fuzz"):
                continue
            try:
                pids[node] = xmlrpc.client.ServerProxy(master.lookupNode("/fuzz", node)[2]).getPid("/fuzz")[2]
            except OSError:
                pids[node] = None
        return pids

    def topics(self):
        """Topics that a node of this package subscribes to, with their types."""
        master = xmlrpc.client.ServerProxy(self.uri)
        _, subscriptions, _ = master.getSystemState("/fuzz")[2]
        kinds = dict(master.getTopicTypes("/fuzz")[2])
        return {name: kinds[name] for name, nodes in subscriptions
                if any(not node.startswith(NOT_OURS + ("/fuzz",)) for node in nodes) and kinds.get(name, "*") != "*"}


def processor_time(pid):
    """Processor time of a process [s]; 0 when it has ended."""
    try:
        fields = open("/proc/%d/stat" % pid).read().rsplit(")", 1)[1].split()
    except FileNotFoundError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def examine(graph, pids, talkers, last):
    """Every node lives, and publishes diagnostics again."""
    assert "has died" not in graph.text() and graph.launch.poll() is None, \
        "a node has ended after %s\n%s" % (last, graph.text()[-4000:])
    begin = time.monotonic()
    spent = {node: processor_time(pids[node]) for node in talkers}
    waiting = set(talkers)
    while waiting:
        with graph.lock:
            waiting = {node for node in waiting if graph.heard[node] < begin}
        for node in waiting:
            busy = processor_time(pids[node]) - spent[node]
            assert busy < HANG and time.monotonic() < begin + PATIENCE, \
                "%s hangs (%.0f s of processor time) after %s\n%s" % (node, busy, last, graph.text()[-3000:])
        assert "has died" not in graph.text() and graph.launch.poll() is None, \
            "a node has ended after %s\n%s" % (last, graph.text()[-4000:])
        time.sleep(0.1)


def fuzz(repository, folder, scene, arguments, messages, seed):
    import rospy
    from diagnostic_msgs.msg import DiagnosticArray
    with Graph(repository, folder, scene, arguments) as graph:
        graph.wait(START, graph.is_running, "start of " + scene)
        rospy.init_node("fuzz", disable_signals=True, disable_rostime=True)
        rospy.Subscriber("/diagnostics", DiagnosticArray, graph.hear, queue_size=100)
        time.sleep(RECORDED)
        topics = [Topic(rospy, name, kind) for name, kind in sorted(graph.topics().items())]
        time.sleep(RECORDED)
        pids = graph.pids()
        with graph.lock:
            talkers = [node for node in graph.heard if node in pids]
        for topic in topics:
            topic.advertise()
        time.sleep(2.0)
        print("%s: %d nodes, %d topics, %d of them with recorded messages" %
              (scene, len(pids), len(topics), sum(bool(topic.recorded) for topic in topics)), flush=True)
        rng = random.Random(seed)
        last = []
        for number in range(messages):
            topic = topics[number % len(topics)]
            topic.publish(topic.mutated(rng))
            last = last[-ROUND:] + [topic.name]
            time.sleep(INTERVAL)
            if number % ROUND == ROUND - 1:
                examine(graph, pids, talkers, last)
        examine(graph, pids, talkers, last)
        assert graph.pids() == pids, "nodes were restarted: %s, %s\n%s" % (pids, graph.pids(), graph.text()[-4000:])
        print("%s: %d mutated messages, no node ended" % (scene, messages), flush=True)
    ignored = graph.text().count("an invalid message on")
    print("%s: %d topics on which nodes reported invalid messages" % (scene, ignored), flush=True)
    assert os.path.exists(folder + "/results/report.json"), "no report\n" + graph.text()[-4000:]
    assert ignored > 0, "no node reported an invalid message"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository")
    parser.add_argument("--messages", type=int, default=2000, help="number of messages to all graphs together [2000]")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--graph", type=int, default=-1, help="index of the only graph; -1: each in a process of its own")
    parser.add_argument("--keep", default="", help="folder of logs and recordings, which is kept")
    arguments = parser.parse_args()
    if arguments.graph < 0:
        return max(subprocess.call([sys.executable, *sys.argv, "--graph", str(k)]) for k in range(len(GRAPHS)))
    folder = arguments.keep or tempfile.mkdtemp()
    scene, launch_arguments = GRAPHS[arguments.graph]
    try:
        fuzz(os.path.realpath(arguments.repository), "%s/%d" % (folder, arguments.graph), scene, launch_arguments,
             arguments.messages // len(GRAPHS), arguments.seed + arguments.graph)
    finally:
        if not arguments.keep:
            shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
