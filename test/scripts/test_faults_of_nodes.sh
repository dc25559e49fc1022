#!/bin/bash
# The most important nodes of a session are killed and stopped for 5 s: force, state, recovery, motion and replay.
#   --rounds N: all nodes, N times
set -eu
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
exec /usr/bin/python3 "$repository/test/scripts/fault_trials.py" "$repository" "$@"
