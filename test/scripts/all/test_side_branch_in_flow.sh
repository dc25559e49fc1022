#!/bin/bash
# A soft wire reaches the first diagonal branch, and from the aorta the left main artery, from at least 15 of 20 starts: without flow, at
# rest, in hyperaemia and in a stronger stream. Every run ends by success, time or retries, with all nodes inside the wall. Prints the rates.
#   SCENE… as arguments: only these, side_branch or ostium
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
[ $# -gt 0 ] || set -- side_branch ostium

study() { # SCENE NAME OVERRIDE…
  "$programs/procedure_study" "$repository/test/data/scenes/$1.yaml" --out "$folder/$1/$2" --runs 20 --rotation 3.14 --at-least 0 "${@:3}" \
    > "$folder/log" || { cat "$folder/log"; exit 1; }
}
for scene in "$@"; do
  mkdir "$folder/$scene"
  study "$scene" none
  study "$scene" rest --set flow=adult
  study "$scene" hyperaemia --set 'flow={circulation: adult, hyperaemia: true}'
  study "$scene" strong --set 'flow={circulation: adult, hyperaemia: true, heart_rate: 2.5, mean_pressure: 2e4}'
done
/usr/bin/python3 - "$folder" "$@" <<'PYTHON'
import csv
import json
import statistics
import sys

folder, *scenes = sys.argv[1:]
for scene in scenes:
    for name in ('none', 'rest', 'hyperaemia', 'strong'):
        study = '%s/%s/%s' % (folder, scene, name)
        rows = list(csv.DictReader(open(study + '/study.csv', encoding='utf-8')))
        assert len(rows) == 20, (study, len(rows))
        retries = 0
        for row in rows:
            steps = json.load(open('%s/%s/metrics.json' % (study, row['seed']), encoding='utf-8'))['steps']
            retries += sum(step['retries'] for step in steps)
            assert row['nodes_outside'] == '0' and float(row['penetration']) < 0.1e-3, row
            assert row['success'] == '1' or 'not done within' in row['why'] or 'retries' in row['why'], row
        times = [float(row['time']) for row in rows if row['success'] == '1']
        print('%-12s %-10s %d of 20, mean %.2f s, %d retries' % (scene, name, len(times), statistics.mean(times or [float('nan')]), retries))
        assert len(times) >= 15, (study, len(times))
PYTHON
