#!/bin/bash
# The summary's remark on late steps names their causes, and blames the host or other programs only if they used the
# processors.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
/usr/bin/python3 - "$repository" <<'PYTHON'
import sys
sys.path.insert(0, sys.argv[1] + "/python")
from endovascular_sim.plots.commands import summary

summary.may_run_in_real_time = lambda: True


def remark(on_time, late, withdrawn=0.0, others=0.0):
    """Remark on a run of 60 s on two processors. late: late steps by cause."""
    values = {"late steps, " + cause: count for cause, count in late.items()}
    report = {"on_time_percent": on_time, "diagnostics": {"rod_dynamics": values}}
    return summary.lateness(report, {"elapsed": 60.0, "processors": 2, "session": 50.0, "others": others,
                                     "withdrawn": withdrawn})


def expect(text, present, absent):
    for part in present:
        assert part in text, "missing in '%s': %s" % (text, part)
    for part in absent:
        assert part not in text, "in '%s': %s" % (text, part)


late = {"simulation": 900.0, "transport": 90.0, "recording": 10.0}
assert remark(99.0, late, 5.0, 50.0) is None
assert remark(None, {}) is None
own = remark(89.0, late, 0.1, 2.0)
expect(own, ["11.0 % of the steps were late", "simulation 90 %", "transport 9 %", "no other program"],
       ["host", "end them", "recording"])
host = remark(64.0, {"not running": 100.0}, 5.7, 1.0)
expect(host, ["not running 100 %", "withdrew 5.7 s"], ["other program"])
busy = remark(72.0, late, 0.0, 30.0)
expect(busy, ["other programs used 30.0 s", "(25 %)", "end them"], ["host", "no other program"])
both = remark(50.0, late, 2.0, 30.0)
expect(both, ["withdrew 2.0 s", "other programs used 30.0 s"], ["no other program"])
# A folder without figures of the processors, e.g. of a session that demo has not started.
report = {"on_time_percent": 90.0, "diagnostics": {}}
expect(summary.lateness(report, None), ["10.0 % of the steps were late"], ["program", "host"])
summary.may_run_in_real_time = lambda: False
expect(summary.lateness(report, None), ["allow real-time scheduling"], ["program"])

costs = {"rod_dynamics": {"processor time, simulation [us]": 300.4, "processor time, commands [us]": 0.2},
         "contact": {"processor time, detection [us]": 80.0}}
assert summary.step_costs({"diagnostics": costs}) == "simulation 300, detection 80 us", summary.step_costs({"diagnostics": costs})
assert summary.step_costs({"diagnostics": {}}) is None
print("14 remarks as expected")
PYTHON
