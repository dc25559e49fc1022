#!/bin/bash
# Every tool has --help and --version, and ends with exit code 2 and a hint to --help for an unknown option.
# Runs beside other tests.
set -u
repository=$(cd "$(dirname "$0")/../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
failures=0

check() { # check STATUS PATTERN TOOL ARGUMENT...
  local wanted=$1 pattern=$2 output status=0
  shift 2
  output=$("$programs/$@" 2>&1) || status=$?
  [ "$status" -eq "$wanted" ] && grep -q -e "$pattern" <<< "$output" && return
  echo "wanted exit code $wanted and '$pattern' of: $*; got $status and:"
  echo "$output"
  failures=$((failures + 1))
}

commands=$(PYTHONPATH=$repository/python /usr/bin/python3 -c 'from endovascular_sim.plots.__main__ import COMMANDS; print(*COMMANDS)')
[ -n "$commands" ] || exit 1
lines() { # lines PROGRAM [COMMAND]
  check 0 'prints this text' "$@" --help
  check 0 "^$* [0-9.]*, commit [0-9a-z-]*, physics [0-9]*$" "$@" --version
  check 2 "'$* --help' lists the arguments" "$@" --no-such-option
}
for source in "$repository"/src/tools/*.cpp; do lines "$(basename "${source%.cpp}")"; done
lines plots
lines bag_export
lines expert_recording
for command in $commands; do lines plots "$command"; done
scene=$repository/config/scenes/straight_wire.yaml
check 2 "unknown argument '--ouf'" simulate "$scene" --ouf /tmp
check 2 'not in {nodes,costs}' simulate "$scene" --out /tmp --record forces
check 2 'above zero' simulate "$scene" --out /tmp --seconds -1
check 0 'initial_rotation: -0.5' scene_check --set drive.initial_rotation=-0.5 "$scene" --set entry.position='[-0.1, 0, 0]'
[ "$failures" -eq 0 ]
