#!/bin/bash
# The session node is killed twice in each pace, stopped and started: the simulation goes on, all bags replay, one report names
# the gaps and the remarks. Bags name neither user nor computer.
set -eu
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
exec /usr/bin/python3 "$repository/test/scripts/recorder_trials.py" "$repository" --kills 2 --pace real_time --pace free \
  --services --private-names "$@"
