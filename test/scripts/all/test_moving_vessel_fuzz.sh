#!/bin/bash
# A million steps of random wires in vessels that move by 10 mm at 90 beats per minute: no escape, no NaN, no depth beyond 0.1 mm
# and the sag of the edges.
set -eu
repository=$(cd "$(dirname "$0")/../../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$programs/leak_fuzz" --moving --steps 1000000 --out "$out"
