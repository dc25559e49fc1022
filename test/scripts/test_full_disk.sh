#!/bin/bash
# A full disk closes the bag, which replays up to its last step; the simulation goes on.
set -eu
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
if [ "${1:-}" != --mounted ]; then
  unshare -rm true 2>/dev/null || { echo "skipped: this system permits no private mounts (unshare -rm)"; exit 77; }
  exec unshare -rm "${BASH_SOURCE[0]}" --mounted
fi
disk=$(mktemp -d)
mount -t tmpfs -o size=80m tmpfs "$disk" 2>/dev/null || { echo "skipped: no tmpfs can be mounted"; exit 77; }
. "$repository/test/scripts/graph_environment.sh"
exec /usr/bin/python3 "$repository/test/scripts/recorder_trials.py" "$repository" --disk "$disk"
