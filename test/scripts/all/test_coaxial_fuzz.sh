#!/bin/bash
# 100,000 steps of random wires in catheters, with stops and jams: no escape, no NaN, no force above the sum of the grips + 2 %.
set -eu
repository=$(cd "$(dirname "$0")/../../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$programs/leak_fuzz" --coaxial --steps 100000 --out "$out"
