#!/bin/bash
# Every node of a session is killed and stopped for 5 s, three rounds: force, state, recovery, motion and replay.
set -eu
exec bash "$(dirname "$0")/../test_faults_of_nodes.sh" --rounds 3
