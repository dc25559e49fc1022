#!/bin/bash
# `pip install ./python` where CMake finds no core: it builds the core without ROS.
set -eu
exec bash "$(dirname "$0")/test_python_install.sh" --alone
