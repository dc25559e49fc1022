#!/bin/bash
# Topics and services of docs/ROS_INTERFACE.md, of src/nodes/runtime/ros_names.h and of running graphs are the same, and
# `rostopic echo` reads a topic of every message type.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import concurrent.futures, glob, os, re, subprocess, sys, time
import xmlrpc.client
folder, repository = sys.argv[1:]
sys.path.insert(0, repository + "/test/scripts")
from running_graph import RunningGraph
OTHERS = {"rosout", "rosout_agg", "tf", "tf_static", "diagnostics", "clock"}  # of ROS; /diagnostics is in the table too
ONLY_IN_RECORDINGS = {"session/end", "session/gap"}
FIRST_WORDS = r"(?:vessel|rod|wire|treatment|contact|drive|instruments|haptic|procedure|session|simulation|fluoroscopy|robot|sensors|hemodynamics|motion|contrast|player|ghost|expert)"
# test_player_of_recordings.sh and test_expert_beside_trainee.sh start them.
ONLY_IN_REPLAYS = {"player/state", "player/control", "expert/state", "expert/state_visual", "expert/treatment_visual", "expert/scene",
                   "expert/align", "expert/show"}


def text(name):
    return open(os.path.join(repository, name)).read()


def general(name):
    """A name without the graph's own names of instruments and channels."""
    name = re.sub(r"^sensors/[^/]+$", "sensors/*", name.lstrip("/"))
    return re.sub(r"^(instruments|haptic)/[^/]+/", lambda match: match.group(1) + "/*/", name)


def documented():
    """Names of the first column of the tables of topics and services."""
    names = set()
    for section in re.split(r"^## ", text("docs/ROS_INTERFACE.md"), flags=re.MULTILINE):
        if not section.startswith(("Topics", "Services")):
            continue
        for row in re.findall(r"^\| (`[^|]*`) \|", section, flags=re.MULTILINE):
            names.update(general(name) for name in re.findall(r"`([^`]+)`", row))
    return names


def mentioned():
    """Names of topics anywhere in the documents, which folders of src with the same first word are not, nor former names."""
    names = {}
    former = set(re.findall(r'\{"/([a-z_/]+)",', text("src/nodes/session/former_names.cpp")))
    for path in glob.glob(repository + "/docs/*.md") + [repository + "/README.md", repository + "/CONTRIBUTING.md"]:
        present = re.sub(r"^## Names agreed for coming parts.*?(?=^## |\Z)", "", open(path).read(), flags=re.MULTILINE | re.DOTALL)
        for name in re.findall(r"`/?(%s/[a-z_<>/]+)`" % FIRST_WORDS, present):
            if not os.path.exists(os.path.join(repository, "src", name.strip("/"))) and "..." not in name and name.strip("/") not in former:
                names.setdefault(general(name), set()).add(os.path.basename(path))
    return names


def in_code():
    """Names of ros_names.h. The CRTK names begin with a slash and belong below instruments/ and haptic/."""
    values = dict(re.findall(r"constexpr auto (k\w+) =\s*\"([^\"]+)\"", text("src/nodes/runtime/ros_names.h")))
    crtk = {value for key, value in values.items() if value.startswith("/") and key not in ("kDiagnostics", "kClock", "kClickedPoint")}
    assert {"/measured_js", "/servo_jp", "/operating_state"} < crtk, crtk
    crtk.remove(values["kFault"])  # of instruments only
    of_devices = {"/measured_js", "/operating_state", "/state_reason"}
    topics = {value for value in values.values() if re.fullmatch(FIRST_WORDS + "(?:/[a-z_]+)+", value)}
    topics |= {values["kClickedPoint"][1:], values["kSensors"] + "*", "instruments/*" + values["kFault"]}
    return topics | {prefix + name for prefix in ("instruments/*", "robot") for name in crtk} | {"haptic/*" + name for name in of_devices}


echoed = {}  # output of `rostopic echo` per message type


def echo(uri):
    """Runs `rostopic echo` on a topic of every new message type; most topics publish within seconds, others never do."""
    topics = xmlrpc.client.ServerProxy(uri).getTopicTypes("/test")[2]
    chosen = {kind: name for name, kind in topics if kind != "*" and kind not in echoed}

    def read(name):
        try:
            run = subprocess.run(["rostopic", "echo", "-n", "1", "--noarr", name], env=dict(os.environ, ROS_MASTER_URI=uri),
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=12)
            return run.stdout.decode(errors="replace")
        except subprocess.TimeoutExpired as late:
            return (late.stdout or b"").decode(errors="replace")

    # Those that never publish wait beside each other.
    with concurrent.futures.ThreadPoolExecutor(8) as readers:
        echoed.update(zip(chosen, readers.map(read, chosen.values())))


def running(scene, arguments, extra):
    """Topics and services of a running graph, as the master lists them."""
    name = os.path.splitext(os.path.basename(scene))[0]
    names = set()
    with RunningGraph(repository, folder + "/" + name, scene, *arguments) as graph:
        end = time.monotonic() + 180
        while True:  # until the last node has advertised its topics, and two readings are equal
            time.sleep(1.0)
            assert time.monotonic() < end and graph.launch.poll() is None, graph.text()[-5000:]
            try:
                publishers, subscribers, services = xmlrpc.client.ServerProxy(graph.uri).getSystemState("/test")[2]
            except OSError:
                continue
            now = {general(name) for name, _ in publishers + subscribers}
            now |= {general(name) for name, _ in services if not re.search(r"/(get_loggers|set_logger_level)$", name)}
            if now == names and extra <= now and graph.is_running():
                echo(graph.uri)
                return names
            names = now


# A scene with every kind of topic except those of contrast medium and a moving patient, the haptic device and the robot, and
# scenes with these.
graph = running("test/data/procedure_with_balloon.yaml", ["haptic_device:=false", "overrides:=flow=adult"], {"fluoroscopy/image_raw", "wire/marker"})
graph |= running("test/data/catheter_with_contrast.yaml", ["haptic_device:=false"], {"motion/state", "motion/set", "contrast/state", "contrast/inject"})
graph |= running("test/data/hand_in_tube.yaml", ["device:=%s/none" % folder], {"haptic/*/operating_state"})
graph |= running("test/data/robot_in_tube.yaml", ["haptic_device:=false", "robot:=true"], {"robot/operating_state"})
graph -= OTHERS | ONLY_IN_REPLAYS
documents, code = documented() - {"diagnostics"} - ONLY_IN_REPLAYS, in_code() - ONLY_IN_REPLAYS

failed = False
for kind, output in sorted(echoed.items()):
    if re.search(r"ERROR|Error|Traceback|Cannot load", output):
        print("rostopic echo of %s: %s" % (kind, output[:1000]))
        failed = True
read = sorted(kind for kind, output in echoed.items() if "---" in output)
print("rostopic echo read messages of %d of %d types: %s" % (len(read), len(echoed), " ".join(read)))
if len(read) < 15:
    print("expected messages of at least 15 types")
    failed = True
for difference, reason in (
        (documents - graph, "documented, but in no running graph"),
        (graph - documents, "in a running graph, but not documented"),
        (code - graph - ONLY_IN_RECORDINGS, "in ros_names.h, but in no running graph"),
        (graph - code, "in a running graph, but not in ros_names.h"),
        ({"%s (%s)" % (name, ", ".join(sorted(files))) for name, files in mentioned().items()
          if name not in graph | ONLY_IN_RECORDINGS | ONLY_IN_REPLAYS}, "mentioned in a document, but in no running graph")):
    for name in sorted(difference):
        print("%s: %s" % (name, reason))
        failed = True
print("%d names in the graphs, %d documented, %d in ros_names.h" % (len(graph), len(documents), len(code)))
sys.exit(failed)
PYTHON
