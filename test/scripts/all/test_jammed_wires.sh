#!/bin/bash
# Wires that jam in catheters, 24 cases (`benchmark jam`): hands within their grips + 2 %, layers within both grips + 2 %,
# the force within 5 % + 5 mN of that in a rigid tube.
set -eu
repository=$(cd "$(dirname "$0")/../../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$programs/benchmark" jam --out "$out"
python3 - "$out/jam.csv" <<'PYTHON'
import csv
import sys
rows = list(csv.DictReader(open(sys.argv[1], encoding='utf-8')))
assert len(rows) == 24, len(rows)
for row in rows:
    assert float(row['largest hand over its grip']) <= 1.02, row
    assert float(row['largest layer over both grips']) <= 1.02, row
    assert float(row['unexplained work [%]']) <= 1.0, row
    assert float(row['deviation over 5 % + 5 mN']) <= 1.0, row
PYTHON
