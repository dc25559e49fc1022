#!/bin/bash
# Each lesson in rviz on a virtual screen, by a person who does the wrong thing first and then follows the page to its end
# (play_lesson.py). A lesson takes up to twenty minutes.
#   NAME… as arguments: only these lessons
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
[ -e "${ENDOVASCULAR_DEVEL:-$repository/catkin_ws/devel}/lib/libendovascular_sim_rviz.so" ] || { echo "skipped: the plugin of rviz is not built"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"
[ $# -gt 0 ] || set -- lesson_bifurcation lesson_catheter_needs_wire lesson_lad_stent lesson_pressure lesson_injection

for lesson in "$@"; do
  mkdir "$folder/$lesson"
  timeout -s KILL 1500 /usr/bin/python3 "$repository/test/scripts/play_lesson.py" "$folder/$lesson" "$repository" "$lesson"
done
