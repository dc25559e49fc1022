#!/bin/bash
# A path that catkin cannot handle is refused with the reason, before any installation or build.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
for name in 'my work' 'a;b' 'a$b' 'a"b' 'a:b' 'a%b' 'a(b' 'a#b'; do
  mkdir -p "$folder/$name/catkin_ws"
  cp -r "$repository/catkin_ws/demo" "$repository/catkin_ws/test" "$repository/catkin_ws/lib" \
    "$repository"/catkin_ws/packages*.txt "$folder/$name/catkin_ws/"
  for command in demo test; do
    status=0
    message=$("$folder/$name/catkin_ws/$command" 2>&1) || status=$?
    [ "$status" -eq 2 ]
    grep -q 'catkin cannot build or test there' <<< "$message"
    grep -qF "$folder/$name" <<< "$message"
    [ ! -e "$folder/$name/catkin_ws/build" ]
  done
done
