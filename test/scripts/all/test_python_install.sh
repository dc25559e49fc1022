#!/bin/bash
# `pip install ./python` without network and without ROS, in a virtual environment: the package links the core that CMake
# finds, and has the trajectory of simulate.
# Also the package of an installation.
#   --alone   builds the core, too, in place of finding one
set -eu
. "$(dirname "$0")/../folder_of_a_test.sh"
build=${ENDOVASCULAR_BUILD_DIR:-$repository/catkin_ws/build}
devel=${ENDOVASCULAR_DEVEL_DIR:-$repository/catkin_ws/devel}
unset ENDOVASCULAR_CONFIG_DIR LD_LIBRARY_PATH PYTHONPATH
export PATH=/usr/bin:/bin

"$devel/lib/endovascular_sim/simulate" "$repository/config/scenes/tube.yaml" --seconds 0.4 --no-plots --quiet --out "$folder/run"
wanted=$(sed -n 's/.*"trajectory_hash": *"\([0-9a-f]*\)".*/\1/p' "$folder/run/result.json")
[ -n "$wanted" ]
cat > "$folder/step.py" <<'PYTHON'
import sys
import endovascular_sim as evs
with evs.World("tube").session() as session:
    session.step(n=400)
    assert session.trajectory_hash == sys.argv[1], session.trajectory_hash
    print(evs.__file__, session.trajectory_hash)
PYTHON

mkdir "$folder/sources"
(cd "$repository" && cp -r CMakeLists.txt package.xml cmake config src python test "$folder/sources/")  # pip builds in its folder
rm -rf "$folder/sources/python/build"
/usr/bin/python3 -m venv --system-site-packages "$folder/venv"
case "${1:-}" in
  --alone) export CMAKE_ARGS=-DENDOVASCULAR_FIND_CORE=OFF ;;
  *) export CMAKE_PREFIX_PATH=$devel ;;
esac
cd "$folder"
venv/bin/pip install --no-build-isolation --no-index "$folder/sources/python" > pip.log 2>&1 || { tail -n 40 pip.log; exit 1; }
rm -rf "$folder/sources"  # the package does not need them
venv/bin/python step.py "$wanted"
ldd venv/lib/python3*/site-packages/endovascular_sim/_core*.so > libraries
if grep -E 'libros|libxmlrpcpp' libraries; then
  echo "the package links ROS"
  exit 1
fi
if [ "${1:-}" = --alone ]; then
  grep "$folder/venv/.*libendovascular_sim_core.so" libraries
  exit
fi
grep "$devel/lib/libendovascular_sim_core.so" libraries

# The package of an installation lies in its Python path.
cmake --install "$build" --prefix "$folder/first" > install.log
mv first installed
PYTHONPATH=$folder/installed/lib/python3/dist-packages /usr/bin/python3 step.py "$wanted"
PYTHONPATH=$folder/installed/lib/python3/dist-packages /usr/bin/python3 -c "from endovascular_sim.msg import DriveApplied"
