#!/bin/bash
# check_urdf accepts the URDFs of config/robots and of docs/YOUR_ROBOT.md, and scene_check the scene of that page; a wrong
# URDF is refused with file, joint and remedy.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
. "$repository/test/scripts/graph_environment.sh"

for urdf in "$repository"/config/robots/*.urdf; do
  check_urdf "$urdf" | grep -q "Successfully Parsed XML" || { echo "check_urdf refused $urdf"; exit 1; }
done

# The files of the page, from its blocks "cat > FILE <<'END'".
/usr/bin/python3 - "$repository/docs/YOUR_ROBOT.md" "$folder" <<'PYTHON'
import os, re, sys
page, folder = sys.argv[1:]
blocks = re.findall(r"^    cat > (\S+) <<'END'\n(.*?)^    END$", open(page).read(), flags=re.MULTILINE | re.DOTALL)
assert {os.path.basename(name) for name, _ in blocks} == {"my_robot.urdf", "my_scene.yaml", "push.py"}, blocks
for name, text in blocks:
    with open(os.path.join(folder, os.path.basename(name)), "w") as file:
        file.write(re.sub(r"^    ", "", text, flags=re.MULTILINE))
PYTHON
check_urdf "$folder/my_robot.urdf" > /dev/null
/usr/bin/python3 -m py_compile "$folder/push.py"
check() { rosrun endovascular_sim scene_check "$folder/my_scene.yaml" "$@" 2>&1; }
check | grep -q "joint: .*motor" || { check; exit 1; }
check --nodes | grep -qx robot || { echo "the scene starts no robot"; exit 1; }
check --urdf | cmp - "$folder/my_robot.urdf" || { echo "another URDF is printed"; exit 1; }

sed -i 's/lower="0" upper="0.25"/lower="0.25" upper="0"/' "$folder/my_robot.urdf"
check_urdf "$folder/my_robot.urdf" > /dev/null || { echo "check_urdf has learnt to check limits: say so in the page"; exit 1; }
if refusal=$(check); then
  echo "accepted limits in the wrong order"
  exit 1
fi
echo "$refusal"
[[ $refusal == *"my_robot.urdf: joint 'slide' (line 3)"*"exchange lower and upper"* ]]
