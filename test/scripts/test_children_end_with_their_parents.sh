#!/bin/bash
# A tool that is killed leaves no process behind: neither the reader of volume_import, nor volume_import below vessel_segment.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
"$programs/volume_import" --help > /dev/null 2>&1 || { echo "without ITK: there is no child"; exit 0; }
cd "$folder"
/usr/bin/python3 - "$repository/test/image" <<'PYTHON'
import sys
sys.path.insert(0, sys.argv[1])
import image_files
image_files.write_nifti("large.nii", dimensions=(700, 700, 400), stored=[])
with open("large.nii", "r+b") as file:
    file.truncate(352 + 2 * 700 * 700 * 400)  # no blocks on the disk
PYTHON
printf 'branches: [{name: a, clicks: [[0, 0, 0], [1, 1, 1]]}]\n' > clicks.yaml

ended() { # ended PROCESS: waits up to 20 s
  local n
  for ((n = 0; n < 200; ++n)); do
    if ! kill -0 "$1" 2> /dev/null || grep -q '^State:.*[ZX]' "/proc/$1/status" 2> /dev/null; then return; fi
    sleep 0.1
  done
  return 1
}
# left NAME DEPTH COMMAND...: starts a command, waits for its child (DEPTH 1) or grandchild (2), stops that, kills the command,
# and fails if one of them is left. A command may end before its child is stopped; then it is started again.
left() {
  local name=$1 depth=$2 try command child below
  for try in 1 2 3 4 5; do
    "${@:3}" > "$name.log" 2>&1 &
    command=$!
    while kill -0 "$command" 2> /dev/null; do
      child=$(pgrep -P "$command" || true)
      below=$child
      [ "$depth" = 1 ] || [ -z "$child" ] || below=$(pgrep -P "$child" || true)
      [ -n "$below" ] && kill -STOP "$below" 2> /dev/null && break
    done
    kill -KILL "$command" 2> /dev/null || continue
    wait "$command" 2> /dev/null || true
    for process in $child $below; do
      ended "$process" || { echo "$name: process $process is left"; kill -KILL "$process"; exit 1; }
    done
    echo "$name: nothing is left"
    return
  done
  cat "$name.log"
  echo "$name: ended before its child was stopped"
  exit 1
}
left volume_import 1 "$programs/volume_import" large.nii --out a.vol --modality ct
left vessel_segment 2 "$programs/vessel_segment" large.nii --clicks clicks.yaml --out a.obj --modality ct
