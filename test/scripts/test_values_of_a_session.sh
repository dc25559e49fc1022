#!/bin/bash
# One session, recorded by the graph and computed offline: every quantity that stands in more than one of its files and pages
# has one value.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"
scene=$repository/test/data/scenes/good_procedure_errors.yaml
marks=(procedure.pass.wall_force=0.1 procedure.pass.hand_force=0.01 procedure.pass.wrong_branches=0)

port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://localhost:$port ROS_HOME=$folder/ros
timeout -s INT 400 roslaunch -p "$port" "$repository/launch/sim.launch" scene:="$scene" overrides:="${marks[*]}" pace:=free \
  stop_at_duration:=true results:="$folder/graph" haptic_device:=false visualization:=false > "$folder/log" 2>&1 ||
  { tail -n 30 "$folder/log"; exit 1; }
status=0
"$programs/simulate" "$scene" "${marks[@]/#/--set=}" --no-plots --quiet --out "$folder/offline" 2> "$folder/errors" || status=$?
[ $status -eq 1 ] && grep -q "the procedure failed: step" "$folder/errors" ||
  { echo "--quiet hides the reason of the failed procedure:"; cat "$folder/errors"; exit 1; }
"$programs/plots" summary "$folder/graph" > "$folder/summary" || { cat "$folder/summary"; exit 1; }
"$programs/plots" compare "$folder/graph" "$folder/offline" --out "$folder/compared.html" > "$folder/compared"

/usr/bin/python3 - "$folder" <<'PYTHON'
import csv, html, json, pathlib, re, sys
folder = pathlib.Path(sys.argv[1])
graph, offline = folder / "graph", folder / "offline"
metrics = json.load(open(graph / "metrics.json"))
report = json.load(open(graph / "report.json"))
result = json.load(open(offline / "result.json"))
marks = {mark["mark"]: mark["value"] for mark in metrics["lesson"]["marks"]}
pages = {name: html.unescape(re.sub(r"<[^>]*>", " ", (folder / name).read_text()))
         for name in ("graph/report.html", "graph/metrics.html", "offline/metrics.html", "compared.html")}
table = (folder / "compared").read_text()


def rows(path):
    with open(path, newline="") as stream:
        return list(csv.DictReader(stream))


def equal(quantity, *values, tolerance=1e-8):
    """Numbers of one quantity; those of CSV files are rounded to nine digits, those of force maps to single precision."""
    assert all(abs(value - values[0]) <= tolerance * max(1.0, abs(values[0])) for value in values), (quantity, values)
    print("%s: %s" % (quantity, ", ".join("%.6g" % value for value in values)))


def shown(text, label, page):
    """A text stands behind a label."""
    assert re.search(re.escape(label) + r"\D{0,60}" + re.escape(text) + r"(?!\d)", page), (label, text, page[:4000])


assert metrics == json.load(open(offline / "metrics.json")), "metrics.json of graph and simulate differ"
assert not metrics["simulator_faults"], metrics["simulator_faults"]

peaks = {one["name"]: one["peak_hand_force"] for one in metrics["instruments"]}
largest = max(peaks.values())
for name, peak in peaks.items():
    equal("force at the hand of " + name, peak,
          max(abs(float(row["peak_hand_force"])) for row in rows(graph / "instruments.csv") if row["instrument"] == name),
          next(hand for hand in result["hands"] if hand["name"] == name)["force"]["max"])
equal("largest force at a hand", largest, report["hand_force"]["max"], result["hand_force"]["max"],
      marks["largest force on a handle"])
assert max(abs(float(row["hand_force"])) for row in rows(graph / "instruments.csv")) <= largest
shown("%.3f N" % largest, "force at the hand, max", pages["graph/report.html"])
shown("%.3f N" % largest, "force at the hand, max", (folder / "summary").read_text())
shown("%.2f" % largest, "largest force at a hand [N]", table)
shown("%.2f" % largest, "largest force at a hand [N]", pages["compared.html"])
shown("%.3g" % largest, "largest force on a handle", pages["graph/metrics.html"])

wrong = len(metrics["wrong_branches"])
assert wrong > 0
equal("wrong branches", wrong, marks["wrong branches"], sum(step["wrong_branches"] for step in metrics["steps"]),
      sum(one["wrong_branch_entries"] for one in metrics["instruments"]))
shown("%d" % wrong, "wrong branches entered", table)
shown("%d" % wrong, "wrong branches", pages["graph/metrics.html"])

walls = [data["wall_forces"] for data in (metrics, report, result)]
equal("largest force of one contact", *(wall["peak"] for wall in walls), marks["largest force on the wall"], tolerance=1e-6)
on_a_triangle = [max(float(row["peak"]) for row in rows(path / "wall_forces.csv")) for path in (graph, offline)]
equal("largest force of one contact on a triangle", *on_a_triangle, tolerance=1e-6)
assert 0.3 * walls[0]["peak"] < on_a_triangle[0] < 1.001 * walls[0]["peak"], (on_a_triangle, walls[0]["peak"])
equal("integral of the wall forces", *(wall["integral"] for wall in walls))
shown("%.3f N" % walls[0]["peak"], "largest force on the wall", pages["graph/report.html"])
shown("%.2f" % walls[0]["peak"], "largest force of one contact", pages["graph/metrics.html"])
shown("%.2f" % walls[0]["peak"], "largest force of one contact [N]", table)

equal("time of the procedure", metrics["procedure_time"], result["steps"] * result["dt"], tolerance=0.006)
equal("inserted length", report["inserted_length"], result["inserted_length"],
      float(rows(graph / "trajectory.csv")[-1]["insertion"]), tolerance=2e-3)
last = [rows(path / "trajectory.csv")[-1] for path in (graph, offline)]
together = {row["time"]: row for row in rows(offline / "trajectory.csv")}
for row in rows(graph / "trajectory.csv"):
    if row["time"] in together:
        other = together[row["time"]]
        assert all(row[key] == other[key] for key in ("insertion", "rotation", "hand_force", "hand_torque", "tip_x", "tip_rotation")), (row, other)
assert rows(graph / "instruments.csv") == rows(offline / "instruments.csv"), "instruments.csv of graph and simulate differ"
assert any(float(row["tip_rotation"]) != 0.0 for row in rows(graph / "instruments.csv"))
equal("errors", len(metrics["errors"]), len(json.load(open(offline / "metrics.json"))["errors"]))
shown("%d" % len(metrics["errors"]), "errors", table)
assert "*" not in re.sub(r"\*: best.*", "", table), "an unfinished session is marked as the best"
PYTHON
