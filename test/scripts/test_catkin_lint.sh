#!/bin/bash
# catkin_lint finds no error and no warning. Packages are not looked up: this machine has no rosdep database.
# Runs beside other tests.
set -eu
cd "$(dirname "$0")/../../catkin_ws"
catkin_lint -W1 --strict --ignore uninstalled_script --ignore unknown_package src/endovascular_sim src/crtk_msgs
