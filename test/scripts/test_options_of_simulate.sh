#!/bin/bash
# docs/SIMULATE.md names every option of `simulate --help`, and no other one. So does its list of tables for --record.
# Runs beside other tests.
set -u
repository=$(cd "$(dirname "$0")/../.." && pwd)
programs=${ENDOVASCULAR_PROGRAMS:-$repository/catkin_ws/devel/lib/endovascular_sim}
page=$repository/docs/SIMULATE.md
help=$("$programs/simulate" --help) || exit 1

# The option is the first word of an indented line; a short form may precede it.
offered=$(sed -n 's/^ *\(-[a-z],\s*\)\?\(--[a-z-]*\).*/\2/p' <<< "$help" | sort -u)
# The rows of the first table begin with options in backquotes.
named=$(sed -n '/^| option/,/^$/p' "$page" | sed -n 's/^| \(`[^|]*\) |.*/\1/p' | grep -oe '--[a-z-]*' | sort -u)
[ "$(wc -l <<< "$offered")" -gt 8 ] || { echo "only these options were found in --help: $offered"; exit 1; }
difference=$(diff <(echo "$offered") <(echo "$named")) || { echo "options of --help (<) and of SIMULATE.md (>):"; echo "$difference"; exit 1; }
tables=$(sed -n 's/.*{\([a-z,]*\)}.*/\1/p' <<< "$("$programs/simulate" x --out y --record none 2>&1)")
[ -n "$tables" ] || { echo "the tables of --record were not found"; exit 1; }
for table in ${tables//,/ }; do
  grep -q -e "--record $table" "$page" || { echo "SIMULATE.md does not name --record $table"; exit 1; }
done
