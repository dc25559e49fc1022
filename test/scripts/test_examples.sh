#!/bin/bash
# The examples of src/tools/examples run: a stepped graph steers a wire into a branch and measures its calls, a graph in real
# time pushes to a force.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

/usr/bin/python3 - "$folder" "$repository" <<'PYTHON'
import glob, re, subprocess, sys
folder, repository = sys.argv[1:]
sys.path.insert(0, repository + "/test/scripts")
from running_graph import RunningGraph

for path in glob.glob(repository + "/src/tools/examples/*"):
    lines = len(open(path).readlines())
    assert lines <= 80, "%s has %d lines, more than 80" % (path, lines)


class Graph(RunningGraph):
    """Running sim.launch without a window."""

    def __init__(self, name, *arguments):
        super().__init__(repository, folder + "/" + name, "config/scenes/fork.yaml", "haptic_device:=false", "fluoroscopy:=false",
                         "visualization:=false", "session:=false", *arguments)

    def run(self, *command):
        """Output of a program of this package."""
        print("$", *command, flush=True)
        run = subprocess.run(["rosrun", "endovascular_sim", *command], env=self.environment, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, universal_newlines=True, timeout=300)
        print(run.stdout, flush=True)
        assert run.returncode == 0, self.text()[-3000:]
        return run.stdout


with Graph("stepped", "pace:=stepped") as graph:
    assert re.search(r"reached \w+ with \d+ mm of wire", graph.run("steer_into_branch.py"))
    rows = graph.run("call_rate.py", "--steps", "200", "--sizes", "1", "20", "200").splitlines()[1:]
    assert len(rows) == 3 and len({row.split()[-1] for row in rows}) == 1, "one trajectory for each size of calls"

with Graph("real_time") as graph:
    for program in (["push_to_force.py", "--force", "0.05"], ["push_to_force", "_force:=0.05"]):
        output = graph.run(*program)
        assert re.search(r"reached 0\.\d+ N", output) and re.search(r"held 0\.\d+ N", output)
PYTHON
