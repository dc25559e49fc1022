#!/bin/bash
# The fast rows of docs/REPRODUCE.md have the results of docs/validation/reproduce.csv, and the tables of the page are those of that file.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
devel=${ENDOVASCULAR_DEVEL:-$repository/catkin_ws/devel}
export PYTHONPATH=$devel/lib/python3/dist-packages:${PYTHONPATH:-} PYTHONDONTWRITEBYTECODE=1
table=$repository/docs/validation/reproduce.csv
/usr/bin/python3 - "$repository/docs/REPRODUCE.md" "$table" <<'PYTHON'
import pathlib
import sys
from endovascular_sim.plots.paper import page, rows
text, lines = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"), page.read(pathlib.Path(sys.argv[2]))
assert page.with_tables(text, lines, "page") == text, "run `plots reproduce --out reproduced --table docs/validation/reproduce.csv --page docs/REPRODUCE.md`"
for row in rows.ROWS:
    own = [line for line in lines if line["row"] == row.name]
    assert bool(own) == bool(row.measure), row.name
    assert not [line for line in own if line["holds"] == "no"], own
    assert row.title in text.partition(page.END)[2] or row.measure, row.title
PYTHON
"$programs/plots" reproduce --fast --out "$folder" --compare "$table"
[ "$(head -c 4 "$folder/fig8.png" | tail -c 3)" = PNG ]

# A result that differs from the table, and a failing row, end with exit code 1.
sed 's/^\(fig3,largest strain[^,]*,[^,]*\),[^,]*,/\1,0.5,/' "$table" > "$folder/other.csv"
if "$programs/plots" reproduce --row fig3 --out "$folder/again" --compare "$folder/other.csv" > "$folder/log"; then exit 1; fi
grep -q 'differs: fig3, largest strain' "$folder/log"
if ENDOVASCULAR_PROGRAMS=$folder "$programs/plots" reproduce --row fig1 --out "$folder/broken" > "$folder/log" 2>&1; then exit 1; fi
grep -q '1 not accepted' "$folder/log"
