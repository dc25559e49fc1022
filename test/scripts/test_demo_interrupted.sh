#!/bin/bash
# Ctrl-C during a session closes the bag, writes the report and leaves no process running.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Background processes of a shell ignore SIGINT, unlike the foreground of a terminal: it is restored here.
/usr/bin/python3 - "$repository/catkin_ws/demo" "$folder" <<'PYTHON'
import os, signal, subprocess, sys, time
demo, folder = sys.argv[1:]
process = subprocess.Popen(
    [demo, "--scene", "tube", "--headless", "--no-rviz", "--seconds", "600", "--out", folder + "/results"],
    stdout=subprocess.PIPE, text=True, start_new_session=True,
    preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
for line in process.stdout:
    print(line, end="")
    if "2 of 600 s simulated" in line:
        os.killpg(process.pid, signal.SIGINT)
        break
print(process.communicate(timeout=60)[0])
assert process.returncode == 130, process.returncode
PYTHON

export PATH=/usr/bin:/bin
grep -q '"steps_missing_from_recording": 0' "$folder/results/report.json"
set +u
. "$repository/catkin_ws/devel/setup.bash"
rosbag info "$folder/results/session.bag" | grep -q '/drive/applied'
if pgrep -f "$folder/results" > /dev/null; then
  pgrep -af "$folder/results"
  exit 1
fi
