#!/bin/bash
# Phase pictures show wall, instruments and stent; forces.png has one curve per instrument; the moments for rviz have instruments
# in the vessel.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
export PYTHONPATH=$repository/python REPOSITORY=$repository FOLDER=$folder PYTHONDONTWRITEBYTECODE=1
/usr/bin/python3 - <<'PYTHON'
import json
import math
import os
folder = os.environ["FOLDER"] + "/"
# A pipe of 3 mm radius along z, from -100 to 100 mm, closed at neither end.
with open(folder + "vessel.obj", "w") as out:
    for j in range(101):
        for i in range(24):
            out.write("v %g %g %g\n" % (0.003 * math.cos(math.pi * i / 12), 0.003 * math.sin(math.pi * i / 12), 0.002 * j - 0.1))
    for j in range(100):
        for i in range(24):
            a, b = 24 * j + i + 1, 24 * j + (i + 1) % 24 + 1
            out.write("f %d %d %d\nf %d %d %d\n" % (a, b, b + 24, a, b + 24, a + 24))
with open(folder + "nodes.csv", "w") as out:
    out.write("time,node,x,y,z\n")
    for time, length in ((1, 0.1), (2, 0.1), (3, 0.1), (4, 0.0)):
        for k in range(51):
            out.write("%g,%d,0,0,%g\n" % (time, k, -0.1 + length * k / 50))
with open(folder + "instruments.csv", "w") as out:
    out.write("time,instrument,insertion,rotation,pressure,hand_force,hand_torque\n")
    for time, wire, balloon, pressure in ((1, 0.1, -0.02, 0), (2, 0.1, 0.09, 0), (3, 0.1, 0.09, 1e6), (4, 0.0, -0.02, 0)):
        out.write("%g,wire,%g,0,0,0.1,0\n%g,stent,%g,0,%g,0.3,0\n" % (time, wire, time, balloon, pressure))
with open(folder + "trajectory.csv", "w") as out:
    out.write("time,insertion,rotation,hand_force,hand_torque,tip_x,tip_y,tip_z\n")
    for time, insertion in ((1, 0.1), (2, 0.1), (3, 0.1), (4, 0.0)):
        out.write("%g,%g,0,0.4,0,0,0,0\n" % (time, insertion))
names = ("Wire in", "Stent to the place", "Inflation", "Everything out")
json.dump({"steps": [{"phase": name, "step": name, "end": k + 1.0} for k, name in enumerate(names)]}, open(folder + "metrics.json", "w"))
json.dump({"treatment": {"events": [{"time": 2.9, "instrument": "stent", "event": "stent_placed"}], "balloons": [
    {"instrument": "stent", "stent": {"state": "placed", "inner_diameter": 0.005, "length": 0.018, "middle": [0, 0, -0.03]}}]}},
    open(folder + "result.json", "w"))
open(folder + "scene.yaml", "w").write("""instruments:
  - instrument: {name: wire, sections: [{radius: 2e-04}]}
  - instrument: {name: stent, sections: [{radius: 0.0005}], balloon: {from_tip: 0.005, length: 0.02, folded_diameter: 0.001,
      compliance: [[0, 0.001], [1000000, 0.005]]}}
""")
PYTHON
/usr/bin/python3 -m endovascular_sim.plots phases "$folder"
[ "$(head -c 4 "$folder/phases.png" | tail -c 3)" = PNG ]
/usr/bin/python3 -m endovascular_sim.plots results "$folder"
[ "$(head -c 4 "$folder/forces.png" | tail -c 3)" = PNG ]
/usr/bin/python3 - <<'PYTHON'
import os
import pathlib
import sys
repository, folder = os.environ["REPOSITORY"], pathlib.Path(os.environ["FOLDER"])
sys.path.insert(0, repository + "/catkin_ws/lib")
import numpy as np
import rviz_pictures
from endovascular_sim.plots import meshes, rendering
from endovascular_sim.plots.commands import phases as pictures, results

vertices, faces = meshes.read_obj(folder / "vessel.obj")
normals = meshes.vertex_normals(vertices, faces)
radial = vertices[:, :2] / 0.003
assert ((normals[:, :2] * radial).sum(axis=1) > 0.99).all()

# The width of the wall in the picture is the vessel's diameter; the middle is paler than the rim.
picture = rendering.ScenePicture([0, 0, 0], 0.01, 100)
picture.add_wall(vertices, faces, normals)
empty = picture.image()
row = empty[50]
covered = np.flatnonzero(row.min(axis=1) < 0.98)
assert abs(len(covered) - 30) <= 2 and np.all(np.diff(covered) == 1), covered
assert np.all(empty[:, 40:60].min(axis=2) < 0.98), "holes in the wall"
# A wire in the lumen is seen through the near wall, with its least width; one behind the vessel is paler.
for depth, bound in ((0.0, 0.5), (0.02, 0.75)):
    picture = rendering.ScenePicture([0, 0, 0], 0.01, 100)
    picture.add_wall(vertices, faces, normals)
    picture.add_tube([(0, depth, -0.05), (0, depth, 0.05)], 1e-4, (0.0, 0.0, 0.3), 2.0)
    changed = np.flatnonzero(np.abs(picture.image()[50] - row).max(axis=1) > 0.05)
    assert 3 <= len(changed) <= 5, changed
    level = picture.image()[50, 50].mean()
    assert level < bound, (depth, level)
    if depth == 0.0:
        inside = level
assert level > inside + 0.1, (inside, level)

moments = pictures.phases(folder)
times = [end for _, end, _ in moments]
nodes, inside = pictures.shapes(folder / "nodes.csv", times), pictures.states(folder / "instruments.csv", times)
instruments, stents = pictures.read_instruments(folder / "scene.yaml"), pictures.placed_stents(folder)
drawn = pictures.images((vertices, faces, normals), instruments, moments, nodes, inside, stents)
orange = [int(((one[..., 0] - one[..., 2] > 0.6) & (one[..., 1] > 0.3)).sum()) for one in drawn]
strut = [int((one.max(axis=2) < 0.42).sum()) for one in drawn]
assert orange[0] == 0 and orange[1] > 50 and orange[3] == 0, orange  # the balloon catheter
assert strut[3] > 50 and strut[0] == 0, strut                        # the stent stays in the empty vessel

curves = results.curves_of(folder)
assert list(curves) == ["wire", "stent"] and list(curves["stent"]["hand_force"]) == [0.3] * 4, curves
axis = results.draw_forces(curves).axes[0]
assert [line.get_label() for line in axis.lines] == ["wire", "stent"] and axis.get_legend() and "[N]" in axis.get_ylabel()

named, telling = rviz_pictures.moments(str(folder))
assert [name for _, name in named] == ["rviz_1_wire_in", "rviz_2_stent_to_the_place", "rviz_3_inflation"], named
assert telling == "rviz_3_inflation", telling
os.remove(folder / "metrics.json")
assert rviz_pictures.moments(str(folder)) == ([(3.0, "rviz")], "rviz")
PYTHON
# Results without the mesh: the message names the file and the remedy.
rm "$folder/vessel.obj"
echo '{"steps": [{"phase": "Wire in", "step": "Wire in", "end": 1.0}]}' > "$folder/metrics.json"
message=$(/usr/bin/python3 -m endovascular_sim.plots phases "$folder" 2>&1) && exit 1
grep -q 'vessel.obj.*--record nodes' <<< "$message"
