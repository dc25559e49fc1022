#!/bin/bash
# `catkin_ws/container --print` prints the command of docker or podman with the account, real-time limits, display, device and
# folder of results. Nothing is run.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
container=$repository/catkin_ws/container

# expect ARGUMENT…: the words are in the command, in this order.
expect() {
  local wanted=" $* "
  [[ " $(cat "$folder/command") " == *"$wanted"* ]] || { echo "the command lacks '$*':"; cat "$folder/command"; exit 1; }
}
lacks() { ! grep -qF -- "$1" "$folder/command" || { echo "the command holds '$1':"; cat "$folder/command"; exit 1; }; }

touch "$folder/cookies"
DISPLAY=:7 XAUTHORITY=$folder/cookies "$container" --engine docker --results "$folder/results" --device /dev/null --print demo --scene tube \
  < /dev/null > "$folder/command"
expect docker run --rm
expect --user "$(id -u):$(id -g)"
expect --ulimit rtprio=80 --cap-add=sys_nice
expect --env DISPLAY=:7 --volume /tmp/.X11-unix:/tmp/.X11-unix
expect --volume "$folder/cookies:/tmp/.Xauthority:ro"
expect --device /dev/null --group-add "$(stat -c %g /dev/null)"
expect --volume "$folder/results:/home/user/endovascular_sim" endovascular_sim demo --scene tube
lacks userns
lacks network
[ ! -d /dev/dri ] || expect --device /dev/dri
[ ! -e "$folder/results" ] || { echo "--print has made the folder of results"; exit 1; }

DISPLAY=:7 "$container" --engine podman --no-display --host-network --image other --print < /dev/null > "$folder/command"
expect podman run
expect --userns=keep-id
expect --network=host
lacks DISPLAY
lacks /dev/dri
[[ $(cat "$folder/command") == *" other" ]] || { echo "no command: the image's own one"; cat "$folder/command"; exit 1; }

# The image is built from the three packages that a session needs.
mkdir "$folder/packages"
refused=0
"$container" --engine docker --packages "$folder/packages" --build --print > "$folder/command" 2> "$folder/errors" || refused=$?
[ $refused -eq 1 ] && grep -q 'run catkin_ws/package first' "$folder/errors"
touch "$folder"/packages/{ros-crtk-msgs,endovascular-sim,endovascular-sim-rviz,endovascular-sim-dev}_1_all.deb
"$container" --engine docker --packages "$folder/packages" --build --print > "$folder/command"
expect docker build --tag endovascular_sim --file "$repository/packaging/container/Containerfile"

for wrong in "--engine lxc" "--device /dev/no_such_line" "--nothing" "--build demo" "--results"; do
  refused=0
  # shellcheck disable=SC2086  # words
  "$container" --print $wrong > "$folder/command" 2> "$folder/errors" || refused=$?
  [ $refused -eq 2 ] || { echo "'$wrong' is not refused: $refused"; exit 1; }
done
