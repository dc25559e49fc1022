#!/bin/bash
# The closing line counts what passed, failed and was skipped, and the exit code follows it.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
count="$repository/catkin_ws/lib/test_results.py"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
expect() {
  local wanted_status=$1 wanted_line=$2 status=0 output
  output=$(/usr/bin/python3 "$count" summary "$folder/results") || status=$?
  [ "$status" -eq "$wanted_status" ] && [ "$(tail -n 1 <<< "$output")" = "$wanted_line" ] && return
  echo "wanted exit code $wanted_status and '$wanted_line', got $status and:"
  echo "$output"
  exit 1
}

mkdir "$folder/results"
expect 1 '0 passed, 0 failed'  # no test ran: not a success

echo '<testsuite tests="2"><testcase classname="a" name="b"/><testcase classname="a" name="c"><skipped/></testcase></testsuite>' \
  > "$folder/results/good.xml"
expect 0 '1 passed, 0 failed, 1 skipped'

echo 'some log' > "$folder/log"
/usr/bin/python3 "$count" write "$folder/results/checks/x.xml" --name x --status 3 --log "$folder/log"
expect 1 '1 passed, 1 failed, 1 skipped'
rm "$folder/results/checks/x.xml"

echo '<testsuite tests="1"><testcase' > "$folder/results/torn.xml"  # a test that crashed while it wrote
expect 1 '1 passed, 1 failed, 1 skipped'
echo '<testsuite tests="1" errors="1"></testsuite>' > "$folder/results/torn.xml"  # a suite that did not start
expect 1 '1 passed, 1 failed, 1 skipped'
