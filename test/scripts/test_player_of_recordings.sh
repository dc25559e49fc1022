#!/bin/bash
# The player shows at 20 random times of recorded graphs the recorded messages byte for byte, and the wall with its displacements;
# 50 seeks in a row take neither memory nor files nor threads. It plays at 1/10 and ten times the speed, in a loop and by steps,
# plays damaged bags as far as they go, and refuses what is no bag.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import atexit, os, random, re, signal, socket, subprocess, sys, time
folder, repository = sys.argv[1:]
sys.path.insert(0, repository + "/test/scripts")
from running_graph import RunningGraph
import rosbag
import rospy

LEFT_OUT = ("/diagnostics", "/simulation/run", "/session/end", "/fluoroscopy/camera_info", "/fluoroscopy/image", "/drive/applied",
            "/vessel/mesh", "/vessel/wall_displacement", "/tf_static")
with socket.socket() as free:
    free.bind(("localhost", 0))
    port = free.getsockname()[1]
os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros")


def record(name, scene, *arguments):
    """Path of the bag of a graph that runs for its duration."""
    home = folder + "/" + name
    with RunningGraph(repository, home, scene, "pace:=free", "stop_at_duration:=true", "haptic_device:=false", "visualization:=false",
                      *arguments) as graph:
        end = time.monotonic() + 300
        while graph.launch.poll() is None:
            assert time.monotonic() < end, graph.text()[-3000:]
            time.sleep(0.2)
    bag = home + "/results/session.bag"
    assert os.path.isfile(bag), graph.text()[-3000:]
    return bag


def played(bag, *arguments):
    log = open(folder + "/replay.log", "w")
    return subprocess.Popen(["roslaunch", repository + "/launch/replay.launch", "bag:=" + bag, "rviz:=false", *arguments],
                            stdout=log, stderr=subprocess.STDOUT, start_new_session=True,
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))


def log():
    return open(folder + "/replay.log", errors="replace").read()


def end(launch):
    if launch.poll() is None:
        launch.send_signal(signal.SIGINT)
    launch.wait(timeout=60)


def frames(raw):
    from tf2_msgs.msg import TFMessage
    message = TFMessage()
    message.deserialize(raw)
    return " ".join(pose.child_frame_id for pose in message.transforms)


class Recording:
    """What a bag holds, read by Python's rosbag: (topic, frames) -> times and bytes."""

    def __init__(self, path):
        from endovascular_sim.msg import RodStateVisual, VesselMesh, WallDisplacement
        self.streams, self.states, self.moved, self.mesh = {}, [], [], None
        with rosbag.Bag(path) as bag:
            for topic, (kind, raw, *_), stamp in bag.read_messages(raw=True):
                if topic == "/rod/state_visual":
                    if self.states and self.states[-1][1] == stamp:  # the player shows the last of states of one time
                        self.states.pop()
                    self.states.append((self.read(RodStateVisual, raw).time, stamp))
                if topic == "/vessel/mesh":
                    self.mesh = self.read(VesselMesh, raw)
                if topic == "/vessel/wall_displacement":
                    self.moved.append((stamp, self.read(WallDisplacement, raw)))
                if topic not in LEFT_OUT:
                    self.streams.setdefault((topic, frames(raw) if topic == "/tf" else ""), []).append((stamp, raw))

    @staticmethod
    def read(kind, raw):
        message = kind()
        message.deserialize(raw)
        return message

    def at(self, stamp):
        """Bytes of the last message of each stream at or before a time of the recording."""
        found = {}
        for key, messages in self.streams.items():
            earlier = [raw for when, raw in messages if when <= stamp]
            if earlier:
                found[key] = earlier[-1]
        return found

    def wall(self, stamp):
        points = [(point.x, point.y, point.z) for point in self.mesh.mesh.vertices]
        for when, moved in self.moved:
            if when <= stamp:
                for index, point in zip(moved.index, moved.position):
                    points[index] = (point.x, point.y, point.z)
        return points


class Listener:
    """Newest bytes of every topic of a recording, from the player."""

    def __init__(self, recording):
        from endovascular_sim.msg import PlayerState, VesselMesh
        self.newest, self.state, self.mesh, self.counts = {}, None, None, {}
        topics = {topic for topic, _ in recording.streams}
        self.subscribers = [rospy.Subscriber(topic, rospy.AnyMsg, self.take, topic, queue_size=1000, tcp_nodelay=True) for topic in topics]
        self.subscribers.append(rospy.Subscriber("/player/state", PlayerState, lambda message: setattr(self, "state", message), queue_size=1))
        self.subscribers.append(rospy.Subscriber("/vessel/mesh", VesselMesh, lambda message: setattr(self, "mesh", message), queue_size=1))

    def take(self, message, topic):
        key = (topic, frames(message._buff) if topic == "/tf" else "")
        if message._connection_header["callerid"] == "/player":
            self.newest[key] = message._buff
            self.counts[topic] = self.counts.get(topic, 0) + 1

    def end(self):
        for subscriber in self.subscribers:
            subscriber.unregister()


def wait(seconds, condition, name):
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, "%s: not within %g s\n%s" % (name, seconds, log()[-3000:])
        time.sleep(0.02)


def control(command, value=0.0, succeeds=True):
    answer = service(command, value)
    assert answer.success == succeeds, (command, value, answer)
    return answer


def compare(recording, listener, moment):
    """Seeks a simulated time and compares what is shown; number of compared topics."""
    answer = control(PlayerControlRequest.SEEK_TIME, moment)
    shown = max((state for state in recording.states if state[0] <= moment + 1e-9), default=recording.states[0])
    assert answer.time == shown[0], (moment, answer, shown)
    wait(10, lambda: listener.state is not None and listener.state.time == answer.time, "the state of the player")
    stamp = listener.state.header.stamp
    following = [when for _, when in recording.states if when > shown[1]]
    assert shown[1] <= stamp and all(stamp < when for when in following[:1]), (shown, stamp, following[:1])
    expected = recording.at(stamp)
    for attempt in (1, 2):  # on a busy machine a pose, which is given once, may be lost
        try:
            wait(10, lambda: all(listener.newest.get(key) == raw for key, raw in expected.items()), "the recorded messages")
            break
        except AssertionError:
            print("attempt %d:" % attempt, [key for key, raw in expected.items() if listener.newest.get(key) != raw])
            if attempt == 2:
                raise
            control(PlayerControlRequest.SEEK_TIME, moment)
    points = recording.wall(stamp)
    wait(10, lambda: [(point.x, point.y, point.z) for point in listener.mesh.mesh.vertices] == points, "the wall")
    return len(expected)


def resources(pid):
    status = open("/proc/%d/status" % pid).read()
    return (int(re.search(r"VmRSS:\s+(\d+)", status).group(1)), len(os.listdir("/proc/%d/fd" % pid)), len(os.listdir("/proc/%d/task" % pid)))


inflation = record("inflation", "test/data/scenes/good_inflation.yaml", "overrides:=duration=2.5")
procedure = record("procedure", "test/data/procedure_with_balloon.yaml", "overrides:=duration=4")

# One master for all launches, so that the subscriptions of this process stay.
master = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT)
atexit.register(lambda: (master.terminate(), master.wait()))
wait(60, lambda: subprocess.run(["rosparam", "list"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0, "the master")

from endovascular_sim.srv import PlayerControl, PlayerControlRequest  # noqa: E402
for name, bag in (("inflation", inflation), ("procedure", procedure)):
    recording = Recording(bag)
    launch = played(bag, "paused:=true")
    try:
        if name == "inflation":
            wait(60, lambda: "process[player" in log(), "the player")
            rospy.init_node("test_of_the_player", anonymous=True, disable_signals=True)
        rospy.wait_for_service("/player/control", 60)
        service = rospy.ServiceProxy("/player/control", PlayerControl)
        listener = Listener(recording)
        wait(30, lambda: listener.state is not None and listener.mesh is not None, "the first state")
        assert not listener.state.missing, listener.state.missing
        steps = [chapter for chapter in listener.state.chapters if chapter.kind == chapter.STEP]
        assert (name == "procedure") == bool(steps), listener.state.chapters
        first, last = listener.state.first, listener.state.last
        numbers = random.Random(20)
        compared = sum(compare(recording, listener, numbers.uniform(first - 0.1, last + 0.1)) for _ in range(20))
        print("%s: %d recorded messages shown byte for byte at 20 times; %d displacements of the wall" % (name, compared, len(recording.moved)))
        assert compared > 20 * 8 and (name == "procedure") == (len(recording.moved) == 0)

        pid = int(re.search(r"process\[player-\d+\]: started with pid \[(\d+)\]", log()).group(1))
        for _ in range(50):  # the kept chunks and the kept walls are full
            control(PlayerControlRequest.SEEK_TIME, numbers.uniform(first, last))
        time.sleep(1.5)
        before = resources(pid)
        for _ in range(50):
            control(PlayerControlRequest.SEEK_TIME, numbers.uniform(first, last))
        time.sleep(1.5)
        after = resources(pid)
        print("%s: 50 seeks: memory %d -> %d kB, files %d -> %d, threads %d -> %d" % (name, before[0], after[0], before[1], after[1], before[2], after[2]))
        assert after[0] < before[0] + 4096 and after[1] <= before[1] and after[2] <= before[2]

        def passed(rate, seconds):
            """Simulated time that passes while it plays."""
            control(PlayerControlRequest.SEEK_TIME, first)
            control(PlayerControlRequest.RATE, rate)
            begin = time.monotonic()
            control(PlayerControlRequest.PLAY)
            time.sleep(seconds)
            answer = control(PlayerControlRequest.PAUSE)
            return (answer.time - first) / (time.monotonic() - begin)

        for rate, seconds in ((0.1, 3.0), (1.0, 1.5)):
            measured = passed(rate, seconds)
            assert 0.5 * rate < measured < 1.3 * rate, (rate, measured)
        control(PlayerControlRequest.RATE, 10.0)
        control(PlayerControlRequest.LOOP, 1.0)
        jumps = listener.state.jumps
        control(PlayerControlRequest.PLAY)
        wait(20, lambda: listener.state.jumps >= jumps + 3 and listener.state.playing, "three loops")
        control(PlayerControlRequest.LOOP, 0.0)
        wait(20, lambda: not listener.state.playing and listener.state.time == last, "the end")
        control(PlayerControlRequest.SEEK_STEP, listener.state.first_step + 500)
        times = [state for state, _ in recording.states]
        position = times.index(control(PlayerControlRequest.STEP, 0.0).time)
        assert control(PlayerControlRequest.STEP, 1.0).time == times[position + 1]
        assert control(PlayerControlRequest.STEP, -2.0).time == times[position - 1]
        for command, value in ((PlayerControlRequest.RATE, 11.0), (PlayerControlRequest.SEEK_CHAPTER, 999.0), (77, 0.0)):
            assert control(command, value, succeeds=False).message
        if name == "procedure":  # the X-ray image is rendered from the recording, at the recorded pose of the C-arm
            from sensor_msgs.msg import Image
            image = rospy.wait_for_message("/fluoroscopy/image", Image, 60)
            assert image.width == 128, image.width
        listener.end()
    finally:
        end(launch)
    assert "terminate called" not in log() and "exit code" not in log(), log()[-3000:]

# A bag that is cut off is played up to its end, and says so.
cut = folder + "/cut.bag"
with open(procedure, "rb") as source, open(cut, "wb") as target:
    content = source.read()
    target.write(content[:len(content) * 6 // 10])
launch = played(cut, "paused:=true")
try:
    rospy.wait_for_service("/player/control", 60)
    from endovascular_sim.msg import PlayerState
    state = rospy.wait_for_message("/player/state", PlayerState, 30)
    assert any("damaged" in text for text in state.missing), state.missing
    assert 0.2 < state.last < 4.0, state.last
    assert rospy.ServiceProxy("/player/control", PlayerControl)(PlayerControlRequest.SEEK_TIME, 100.0).time == state.last
finally:
    end(launch)

# What is no bag, and an option that the player lacks, end the launch with one message.
for arguments, message in (([folder + "/replay.sh"], "replay.sh"), ([inflation, "options:=--hz=5"], "--hz=5: is unknown")):
    open(folder + "/replay.sh", "w").write("name: scene\n")
    launch = played(*arguments)
    try:
        launch.wait(timeout=60)
    except subprocess.TimeoutExpired:
        end(launch)
        raise AssertionError("the launch goes on\n" + log()[-2000:])
    assert message in log(), log()[-2000:]
sys.stdout.flush()
os._exit(0)
PYTHON
