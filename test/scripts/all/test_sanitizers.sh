#!/bin/bash
# All tests with sanitizers, and some seconds of every fuzz target: catkin_ws/test --sanitize.
set -eu
exec bash "$(dirname "$0")/../../../catkin_ws/test" --sanitize
