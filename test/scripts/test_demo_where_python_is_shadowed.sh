#!/bin/bash
# A complete demo from another folder, with another python3 earlier in PATH, writes all results.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
mkdir "$folder/bin"
printf '#!/bin/sh\necho "the wrong python3" >&2\nexit 99\n' > "$folder/bin/python3"
chmod +x "$folder/bin/python3"
cd "$folder"

PATH="$folder/bin:$PATH" "$repository/catkin_ws/demo" --scene tube --headless --seconds 1 --out results
for file in session.bag report.json report.html scene.yaml trajectory.csv forces.png tip_path.png wall_forces.csv wall_forces.png rviz.png; do
  [ -s "results/$file" ] || { echo "results/$file is missing or empty"; exit 1; }
done

export PATH=/usr/bin:/bin
python3 - <<'PYTHON'
import json
report = json.load(open("results/report.json"))
assert report["steps"] == 1000, report["steps"]
assert report["steps_missing_from_recording"] == 0, report["steps_missing_from_recording"]
assert report["recording"]["error"] is None and report["recording"]["dropped"] == 0, report["recording"]
PYTHON
set +u
. "$repository/catkin_ws/devel/setup.bash"
rosbag info results/session.bag > bag_info
grep -q '/drive/applied  *1000 msgs' bag_info
grep -Eq '/instruments/guidewire/setpoint_js  *100 msgs' bag_info  # derived from the commands
"$repository/catkin_ws/devel/lib/endovascular_sim/replay" results/session.bag | grep -q '1000 of 1000 steps compared, 0 different'

# Every node ended at the first request.
[ -s results/log/launch.log ]
if grep escalating results/log/launch.log; then
  exit 1
fi

# No process is left; every process of the session has the folder in its command line.
sleep 1
if pgrep -f "$folder/results" > /dev/null; then
  pgrep -af "$folder/results"
  exit 1
fi
