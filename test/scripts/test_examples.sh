#!/bin/bash
# The examples of src/tools/examples run: a stepped graph steers a wire into a branch and measures its calls, a graph in real
# time pushes to a force.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import glob, os, re, signal, socket, subprocess, sys
folder, repository = sys.argv[1:]

for path in glob.glob(repository + "/src/tools/examples/*"):
    lines = len(open(path).readlines())
    assert lines <= 80, "%s has %d lines, more than 80" % (path, lines)


class Graph:
    """Running sim.launch without a window."""

    def __init__(self, *arguments):
        with socket.socket() as free:
            free.bind(("localhost", 0))
            port = free.getsockname()[1]
        self.environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME="%s/ros_%d" % (folder, port),
                                ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        self.log = open("%s/%d.log" % (folder, port), "w")
        self.launch = subprocess.Popen(
            ["roslaunch", "-p", str(port), repository + "/launch/sim.launch", "haptic_device:=false", "fluoroscopy:=false",
             "visualization:=false", "session:=false", "scene:=%s/config/scenes/fork.yaml" % repository, *arguments],
            env=self.environment, stdout=self.log, stderr=subprocess.STDOUT, start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def run(self, *command):
        """Output of a program of this package."""
        print("$", *command, flush=True)
        run = subprocess.run(["rosrun", "endovascular_sim", *command], env=self.environment, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, universal_newlines=True, timeout=300)
        print(run.stdout, flush=True)
        assert run.returncode == 0, open(self.log.name).read()[-3000:]
        return run.stdout

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.launch.send_signal(signal.SIGINT)
        self.launch.wait(timeout=90)


with Graph("pace:=stepped") as graph:
    assert re.search(r"reached \w+ with \d+ mm of wire", graph.run("steer_into_branch.py"))
    rows = graph.run("call_rate.py", "--steps", "200", "--sizes", "1", "20", "200").splitlines()[1:]
    assert len(rows) == 3 and len({row.split()[-1] for row in rows}) == 1, "one trajectory for each size of calls"

with Graph() as graph:
    for program in (["push_to_force.py", "--force", "0.05"], ["push_to_force", "_force:=0.05"]):
        output = graph.run(*program)
        assert re.search(r"reached 0\.\d+ N", output) and re.search(r"held 0\.\d+ N", output)
PYTHON
