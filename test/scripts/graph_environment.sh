# Sourced by tests that start graphs of nodes, after `repository` is set: Debian's programs, and the environment of the build.
export PATH=/usr/bin:/bin ROS_HOSTNAME=localhost
set +u
. "${ENDOVASCULAR_DEVEL:-$repository/catkin_ws/devel}/setup.bash"
set -u
