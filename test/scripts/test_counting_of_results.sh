#!/bin/bash
# The last line of the summary counts passed, failed and skipped tests; the exit code agrees with it.
# Runs beside other tests.
set -eu
. "$(dirname "$0")/folder_of_a_test.sh"
count="$repository/catkin_ws/lib/test_results.py"
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

/usr/bin/python3 - "$(dirname "$count")" "$folder/results/checks/x.xml" <<'PYTHON'
import sys
sys.path.insert(0, sys.argv[1])
import test_results
case = test_results.Case("checks", "x")
case.failed, case.message = True, "exit code 3"
test_results.write_cases(sys.argv[2], "checks", [case])
PYTHON
expect 1 '1 passed, 1 failed, 1 skipped'
rm "$folder/results/checks/x.xml"

echo '<testsuite tests="1"><testcase' > "$folder/results/torn.xml"  # a test that crashed while writing
expect 1 '1 passed, 1 failed, 1 skipped'
echo '<testsuite tests="1" errors="1"></testsuite>' > "$folder/results/torn.xml"  # a suite that did not start
expect 1 '1 passed, 1 failed, 1 skipped'
