#!/bin/bash
# No message ends or hangs a node: 2000 mutated messages to all topics of all nodes. Every subscription is a guarded one.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
if grep -rnE '\.subscribe(<[^>]*>)?\(' "$repository"/src/nodes "$repository"/src/rviz_plugin | grep -v runtime/guarded_subscription.h; then
  echo "these subscriptions are not guarded: use subscribeGuarded()"
  exit 1
fi
. "$repository/test/scripts/graph_environment.sh"
exec /usr/bin/python3 "$repository/test/scripts/message_fuzz.py" "$repository" "$@"
