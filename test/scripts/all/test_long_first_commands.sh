#!/bin/bash
# The first commands of README and PROCEDURES, whole interventions, run as written and print no warning.
set -eu
repository=$(cd "$(dirname "$0")/../../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
exec /usr/bin/python3 "$repository/test/scripts/first_commands.py" "$repository" README.md docs/PROCEDURES.md
