#!/bin/bash
# The session node is killed at ten random times in each pace.
set -eu
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
exec /usr/bin/python3 "$repository/test/scripts/recorder_trials.py" "$repository" --kills 10 --pace real_time --pace free "$@"
