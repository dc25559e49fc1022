"""Sessions of the node graph for tests of bags: recorded as fast as the machine allows."""

import os
import signal
import socket
import subprocess

LONGEST = 240.0  # wall time of a recording [s]


def record(repository, folder, scene, *overrides):
    """Records a scene into folder/results, and returns that folder. Raises AssertionError with the log of a failure."""
    os.makedirs(folder)
    results, log = folder + "/results", folder + "/launch.log"
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    words = ["roslaunch", "-p", str(port), repository + "/launch/sim.launch", "scene:=" + scene, "results:=" + results, "pace:=free",
             "stop_at_duration:=true", "overrides:=" + " ".join(overrides), "haptic_device:=false"]
    environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros")
    with open(log, "w") as stream:
        launch = subprocess.Popen(words, env=environment, stdout=stream, stderr=subprocess.STDOUT,
                                  preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    try:
        code = launch.wait(timeout=LONGEST)
    except subprocess.TimeoutExpired:
        launch.send_signal(signal.SIGINT)  # roslaunch ends its nodes
        launch.wait(timeout=60)
        raise AssertionError("%s does not end within %g s\n%s" % (scene, LONGEST, open(log).read()[-4000:]))
    assert code == 0 and os.path.exists(results + "/report.json"), open(log).read()[-4000:]
    return results


def run(*words):
    """Runs a program. Returns exit code, output and messages."""
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=300, check=False)
    return done.returncode, done.stdout, done.stderr
