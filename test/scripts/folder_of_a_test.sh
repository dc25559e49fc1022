# Sourced by tests: sets the repository, its programs, and a temporary folder that is removed at the end.
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
