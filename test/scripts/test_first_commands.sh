#!/bin/bash
# The first command of each page that takes less than a minute runs as written, and prints no warning. Those of README,
# PROCEDURES and the Debian package take minutes and are in test/scripts/all.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
exec xvfb-run -a -s "-screen 0 1280x800x24" /usr/bin/python3 "$repository/test/scripts/first_commands.py" "$repository" \
  'docs/INSTALL.md#From source' docs/{SCENES,SIMULATE,YOUR_CT,YOUR_ROBOT,VESSELS,LESSONS,FLUOROSCOPY}.md
