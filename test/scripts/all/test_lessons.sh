#!/bin/bash
# Each lesson in rviz on a virtual screen: push, twist, pause, reset and record by clicks and keys, each observed on topics.
#   NAME… as arguments: only these lessons
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
[ -e "${ENDOVASCULAR_DEVEL:-$repository/catkin_ws/devel}/lib/libendovascular_sim_rviz.so" ] || { echo "skipped: the plugin of rviz is not built"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"
[ $# -gt 0 ] || set -- lesson_bifurcation lesson_catheter_needs_wire lesson_lad_stent

for lesson in "$@"; do
  mkdir "$folder/$lesson"
  PYTHONPATH="$repository/test/scripts:$PYTHONPATH" timeout -s KILL 400 /usr/bin/python3 - "$folder/$lesson" "$repository" "$lesson" <<'PYTHON'
import glob, os, sys, time
from rviz_session import RvizSession, run
folder, repository, lesson = sys.argv[1:]
# Index of the instrument of the first step, which the panel chooses.
driven = {"lesson_bifurcation": 0, "lesson_catheter_needs_wire": 1, "lesson_lad_stent": 2}[lesson]


def passed(text):
    print("%s: %s" % (lesson, text), flush=True)


with RvizSession(folder, "%s/launch/%s.launch" % (repository, lesson), "expert:=false", "layout:=work",
                 "overrides:=fluoroscopy.pixels=128") as session:
    def insertion():
        return session.state.insertion[driven]

    def rotation():
        return session.state.rotation[driven]

    session.wait(30, lambda: session.step is not None and session.step.hint, "the hint of the first step")
    session.click("focus")
    beginning = insertion()
    session.hold_until("push", 20, lambda: insertion() > beginning + 2e-3, "a push by the mouse")
    time.sleep(1.5)
    rest = insertion()
    time.sleep(1.0)
    assert abs(insertion() - rest) < 1e-4, "the wire moves on after the release of the button"
    passed("push by the mouse, %.1f mm" % (1e3 * (rest - beginning)))
    session.hold_key_until("Up", 20, lambda: insertion() > rest + 2e-3, "a push by the key")
    passed("push by the key")
    turn = rotation()
    session.hold_until("twist_left", 20, lambda: rotation() < turn - 0.3, "a twist by the mouse")
    turn = rotation()
    session.hold_key_until("Right", 20, lambda: rotation() > turn + 0.3, "a twist by the key")
    passed("twists by mouse and key")

    session.click("pause")
    time.sleep(2.0)
    stands = session.state.time
    time.sleep(1.5)
    assert session.state.time == stands, "the simulation runs on after a click on Pause"
    session.click("start")
    session.wait(10, lambda: session.state.time > stands + 0.5, "a start by the mouse")
    session.hold_key("space", 0.1)
    time.sleep(2.0)
    stands = session.state.time
    time.sleep(1.5)
    assert session.state.time == stands, "the simulation runs on after the space key"
    session.hold_key("space", 0.1)
    session.wait(10, lambda: session.state.time > stands + 0.5, "a start by the key")
    passed("pause and start by mouse and key")
    session.picture(lesson)

    session.click("reset")
    session.wait(40, lambda: session.progress.run == 2 and insertion() < beginning + 1e-3, "a reset, and a second recording")
    passed("reset")
    session.wait(20, lambda: session.progress.steps > 500, "steps of the second run")
    session.click("record")
    session.wait(40, lambda: glob.glob(folder + "/results/run_2/metrics.html"), "the end of the recording")
    time.sleep(1.0)
    session.picture(lesson + "_result")
    session.click("record")
    session.wait(40, lambda: session.progress.run == 3 and session.progress.steps > 100, "a third recording")
    passed("record")
    for name in (lesson, lesson + "_result"):
        path = os.path.join(os.environ.get("ENDOVASCULAR_PICTURES", folder), name + ".png")
        colours = int(run("identify", "-format", "%k", path))
        assert colours > 500, "%s has %d colours: no picture" % (path, colours)
PYTHON
done
