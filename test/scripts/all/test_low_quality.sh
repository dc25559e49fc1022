#!/bin/bash
# quality:=low at 1280 x 800 without a graphics processor: pictures per second of rviz, its processor time, and the speed of the simulation
# while a wire is pushed. The limits hold on two idle cores; on a loaded machine the figures are printed only.
#   LESSON as argument: lesson_bifurcation by default
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
[ -e "${ENDOVASCULAR_DEVEL:-$repository/catkin_ws/devel}/lib/libendovascular_sim_rviz.so" ] || { echo "skipped: the plugin of rviz is not built"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"

mkdir "$folder/rates"
idle=$(/usr/bin/python3 -c 'import os; print(int(os.getloadavg()[0] < 0.5))')
PYTHONPATH="$repository/test/scripts:$PYTHONPATH" GALLIUM_HUD=fps GALLIUM_HUD_VISIBLE=false GALLIUM_HUD_DUMP_DIR="$folder/rates" timeout -s KILL 300 /usr/bin/python3 - "$folder" "$repository" "${1:-lesson_bifurcation}" "$idle" <<'PYTHON'
import glob, os, sys, time
from rviz_session import RvizSession
folder, repository, lesson, idle = sys.argv[1:]
SECONDS = 20.0


def processor_seconds(process):
    fields = open("/proc/%d/stat" % process).read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def rates():
    """Pictures per second of every view, as Mesa's driver writes them into files."""
    return [float(line.split()[-1]) for name in glob.glob(folder + "/rates/*") for line in open(name) if line.strip()]


with RvizSession(folder, "%s/launch/%s.launch" % (repository, lesson), "expert:=false", "quality:=low", layout="lesson") as session:
    rviz = session.pid_of("rviz")
    session.click("focus")
    known, used, wall, simulated = len(rates()), processor_seconds(rviz), time.monotonic(), session.state.time
    while time.monotonic() - wall < SECONDS:
        session.hold_key("Up", 0.5)
        session.hold_key("Right", 0.5)
        session.hold_key("Down", 0.5)
    wall = time.monotonic() - wall
    used, simulated, pictures = processor_seconds(rviz) - used, session.state.time - simulated, rates()[known:]
print("pictures per second: %s; rviz: %.0f %% of a processor; simulation: %.2f of real time"
      % (" ".join("%.0f" % rate for rate in pictures), 100 * used / wall, simulated / wall))
assert pictures, "the driver writes no rate of pictures"
mean = sum(pictures) / len(pictures)
if idle == "1":
    assert mean >= 10.0, "%.1f pictures per second, at least 10 wanted" % mean
    assert simulated / wall > 0.98, "the simulation runs at %.2f of real time" % (simulated / wall)
else:
    print("the machine was not idle: limits are not checked")
PYTHON
