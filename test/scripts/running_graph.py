"""Graph of nodes that a test starts by roslaunch, with a master of its own."""

import os
import signal
import socket
import subprocess
import time


class RunningGraph:
    """Graph of launch/sim.launch, which ends with the block of its `with` statement. Its log is launch.log in a folder of its own."""

    def __init__(self, repository, folder, scene, *arguments):
        os.makedirs(folder, exist_ok=True)
        with socket.socket() as free:
            free.bind(("localhost", 0))
            self.port = free.getsockname()[1]
        self.uri = "http://localhost:%d" % self.port
        self.environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_HOME=folder + "/ros", ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        self.log = folder + "/launch.log"
        self.launch = subprocess.Popen(
            ["roslaunch", "-p", str(self.port), repository + "/launch/sim.launch", "scene:=%s/%s" % (repository, scene),
             "results:=" + folder + "/results", *arguments],
            env=self.environment, stdout=open(self.log, "w"), stderr=subprocess.STDOUT, start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def text(self):
        return open(self.log, errors="replace").read()

    def is_running(self):
        return ": running" in self.text()

    def wait(self, seconds, condition, name):
        """Waits for a condition [s] while the graph lives."""
        end = time.monotonic() + seconds
        while not condition():
            assert self.launch.poll() is None, "the graph has ended\n" + self.text()[-4000:]
            assert time.monotonic() < end, "%s: not within %g s\n%s" % (name, seconds, self.text()[-4000:])
            time.sleep(0.1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.launch.send_signal(signal.SIGINT)
        try:
            self.launch.wait(timeout=300)
        except subprocess.TimeoutExpired:
            os.killpg(self.launch.pid, signal.SIGKILL)
            raise AssertionError("the graph does not end\n" + self.text()[-4000:])
