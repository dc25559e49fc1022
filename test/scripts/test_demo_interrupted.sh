#!/bin/bash
# Ctrl-C at any moment of a demo ends it with exit code 130 and leaves no process running. During a session it closes the
# bag and writes the report.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"

# Background processes of a shell ignore SIGINT, unlike the foreground of a terminal: it is restored here.
/usr/bin/python3 - "$repository/catkin_ws/demo" "$folder" <<'PYTHON'
import os, signal, subprocess, sys, time
demo, folder = sys.argv[1:]


def interrupt(name, line_of_the_moment, delay, options):
    """Runs a demo, and interrupts it a delay [s] after a line of its output."""
    print(f"-- {name}", flush=True)
    process = subprocess.Popen(
        [demo, "--scene", "tube", "--headless", "--out", f"{folder}/{name}", *options],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    for line in process.stdout:
        print(line, end="")
        if line_of_the_moment in line:
            time.sleep(delay)
            os.killpg(process.pid, signal.SIGINT)
            break
    print(process.communicate(timeout=90)[0])
    # Before the first process is started, SIGINT itself ends the demo: a shell reports 130 for this, too.
    expected = (130, -signal.SIGINT) if name.startswith("start") else (130,)
    assert process.returncode in expected, process.returncode
    left = subprocess.run(["pgrep", "-af", f"{folder}/{name}"], capture_output=True, text=True).stdout
    left = [line for line in left.splitlines() if not line.startswith(f"{os.getpid()} ") and " - " not in line]
    assert not left, left


long_run = ["--no-rviz", "--seconds", "600"]
for delay in (0.0, 0.05, 0.2, 0.6, 1.5):
    interrupt(f"start_{delay}", "Scene ", delay, long_run)
interrupt("results", "2 of 600 s simulated", 0.0, long_run)
interrupt("drawing", "Drawing rviz", 1.0, ["--seconds", "1"])
PYTHON

export PATH=/usr/bin:/bin
grep -q '"steps_missing_from_recording": 0' "$folder/results/report.json"
set +u
. "$repository/catkin_ws/devel/setup.bash"
rosbag info "$folder/results/session.bag" | grep -q '/drive/applied'
