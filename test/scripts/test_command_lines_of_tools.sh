#!/bin/bash
# Every tool has --help and --version, and ends with exit code 2 and a hint to --help for an unknown option.
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

for source in "$repository"/src/tools/*.cpp "$repository"/src/tools/plots/*.py; do
  tool=$(basename "${source%.cpp}")
  case "$tool" in tool_support.py | scene_picture.py) continue ;; esac # modules
  check 0 'prints this text' "$tool" --help
  check 0 "^$tool [0-9.]*, commit [0-9a-z-]*, physics [0-9]*$" "$tool" --version
  check 2 "'$tool --help' lists the arguments" "$tool" --no-such-option
done
scene=$repository/config/scenes/straight_wire.yaml
check 2 "unknown argument '--ouf'" simulate "$scene" --ouf /tmp
check 2 'not in {nodes,costs}' simulate "$scene" --out /tmp --record forces
check 2 'above zero' simulate "$scene" --out /tmp --seconds -1
check 0 'initial_rotation: -0.5' scene_check --set drive.initial_rotation=-0.5 "$scene" --set entry.position='[-0.1, 0, 0]'
[ "$failures" -eq 0 ]
