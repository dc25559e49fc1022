#!/bin/bash
# The Python package of the devel space: test/python.
# Runs beside other tests.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
devel=${ENDOVASCULAR_DEVEL_DIR:-$repository/catkin_ws/devel}
export PYTHONPATH=$devel/lib/python3/dist-packages:${PYTHONPATH:-}
cd "$repository/test/python"
exec /usr/bin/python3 -X faulthandler -W error::DeprecationWarning -m unittest discover --verbose
