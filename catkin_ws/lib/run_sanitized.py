#!/usr/bin/python3
"""Runs the tests that were built with sanitizers: all gtest programs with the address sanitizer, those of threaded parts
with the thread sanitizer, the fuzz targets for some seconds each, and the graphs of nodes with the thread sanitizer.
The last line reads `N passed, N failed`."""

import glob
import os
import sys

import run_tests
import test_results
import thread_reports

SECONDS_PER_GTEST = 1800  # ceiling of one test case
SECONDS_PER_ROSTEST = 1800
# gtest programs with the thread sanitizer, and their tests; those of other folders start no thread.
THREADED = {"common": "*", "contact": "WallModel*", "haptics": "*", "nodes": "*",
            "simulation": "SimulationsInThreads.*", "vessel": "CentrelineExtraction.*"}
# Graphs that the thread sanitizer leaves out, with the reason. The graph node_classes runs all nodes but the haptic device.
TOO_SLOW = {"graph_session_metrics": "16,000 steps take more than an hour"}
FUZZ_BYTES = {"mesh": 20000, "scene": 20000, "serial": 4096, "state": 20000, "bag": 40000}  # longest input


def without_real_time():
    """Beginning of a command whose processes get no real-time scheduling: slowed down by the sanitizer, the loops of a
    graph would occupy all processors. Without root privileges there is usually none to take away."""
    return ["setpriv", "--inh-caps=-sys_nice", "--bounding-set=-sys_nice"] if os.geteuid() == 0 else []


class SanitizedRunner(run_tests.Runner):
    seconds_per_rostest = SECONDS_PER_ROSTEST

    def __init__(self, arguments):
        super().__init__(arguments)
        self.sanitized = os.path.join(self.workspace, "sanitized")
        self.options = os.path.join(self.repository, "test", "sanitize")
        self.results_in(self.sanitized)

    def environment(self, sanitizer):
        if sanitizer == "address":
            # Libraries of ROS and Debian are not instrumented: what they keep until the end is no leak of this project.
            return {"ASAN_OPTIONS": "detect_leaks=0:detect_stack_use_after_return=1:strict_string_checks=1",
                    "UBSAN_OPTIONS": "print_stacktrace=1"}
        return {"TSAN_OPTIONS": "halt_on_error=0:exitcode=66:second_deadlock_stack=1:suppressions=" +
                                os.path.join(self.options, "thread_suppressions.txt")}

    def report_prefix(self, run):
        """Beginning of the paths of the reports of a graph, one file for each process with a report."""
        return os.path.join(self.logs, run.name + ".reports")

    def gtests(self):
        wanted = self.arguments.filter
        runs = []
        for sanitizer in ("address", "thread"):
            self.programs = os.path.join(self.sanitized, sanitizer, "devel", "lib", "endovascular_sim")
            for folder in self.folders():
                if self.arguments.only and self.arguments.only.split("/")[0] != folder:
                    continue
                if sanitizer == "thread":
                    if folder not in THREADED:
                        continue
                    self.arguments.filter = wanted or THREADED[folder]
                for run in self.gtests_of(folder):
                    run.name = sanitizer + "_" + run.name
                    run.environment.update(self.environment(sanitizer))
                    runs.append(run)
            self.arguments.filter = wanted
        return runs

    def gtests_of(self, folder):
        only, self.arguments.only = self.arguments.only, self.arguments.only or folder
        try:
            return super().gtests()
        finally:
            self.arguments.only = only

    def rostests(self):
        """Graphs of nodes with the thread sanitizer. Their programs are found through the environment of that build. The
        exit codes of the nodes are tested, therefore reports go to files and leave the exit codes as they are."""
        runs = [run for run in super().rostests() if run.name not in TOO_SLOW]
        for run in runs:
            run.name = "thread_" + run.name
            setup = os.path.join(self.sanitized, "thread", "devel", "setup.bash")
            command = ["--results-filename=" + run.name + ".xml" if part.startswith("--results-filename=") else part
                       for part in run.command]
            run.command = without_real_time() + [
                "bash", "-c", '. "$0" && export ROS_PACKAGE_PATH="$1:/usr/share" && shift && exec "$@"',
                setup, self.repository] + command
            run.environment.update(self.environment("thread"))
            run.environment["GRAPH_TEST_SECONDS"] = str(SECONDS_PER_ROSTEST - 60)  # read by the launch files
            run.environment["TSAN_OPTIONS"] += ":exitcode=0:log_path=" + self.report_prefix(run)
        return runs

    def run_command(self, run, log, environment):
        """Adds a case to a graph: failed where one of its processes has a report that counts."""
        cases = super().run_command(run, log, environment)
        if run.kind == "rostest":
            found = []
            for path in sorted(glob.glob(self.report_prefix(run) + ".*")):
                with open(path, errors="replace") as file:
                    found += thread_reports.own_reports(file.read(), self.repository)
            case = test_results.Case("nodes", run.name + "_without_data_races")
            case.failed, case.text = bool(found), "\n\n".join(found)
            case.message = "%d reports of the thread sanitizer in %s.*" % (len(found), self.report_prefix(run))
            test_results.write_cases(os.path.join(self.results, run.name + ".races.xml"), case.name, [case])
            if found:
                print(case.text, flush=True)
        return cases

    def scripts(self):
        """Fuzz targets. They begin with the committed corpus and with the inputs that earlier runs found."""
        if self.arguments.only and self.arguments.only != "fuzz":
            return []
        runs = []
        for program in sorted(glob.glob(os.path.join(self.sanitized, "address", "devel", "lib", "endovascular_sim",
                                                     "fuzz_*"))):
            name = os.path.basename(program)
            if not self.wanted(name):
                continue
            target = name[len("fuzz_"):]
            found = os.path.join(self.sanitized, "fuzz", target)
            os.makedirs(found, exist_ok=True)
            command = [program, "-seed=1", "-max_total_time=%d" % self.arguments.fuzz_seconds, "-timeout=10",
                       "-rss_limit_mb=2048", "-max_len=%d" % FUZZ_BYTES.get(target, 4096), "-print_final_stats=1",
                       "-artifact_prefix=" + found + "/", os.path.join(found, "corpus"),
                       os.path.join(self.repository, "test", "fuzz", "corpus", target)]
            os.makedirs(os.path.join(found, "corpus"), exist_ok=True)
            environment = dict(self.environment("address"), LC_ALL="C")
            environment["ASAN_OPTIONS"] += ":allocator_may_return_null=1"
            runs.append(run_tests.Run("long script", name, command, environment))
        return runs

    def known(self, folder):
        return True


def main():
    parser = run_tests.parser_of(__doc__)
    parser.add_argument("--fuzz-seconds", type=int, default=10, help="time of each fuzz target")
    parser.set_defaults(ceiling=SECONDS_PER_GTEST)
    return SanitizedRunner(parser.parse_args()).run_all()


if __name__ == "__main__":
    sys.exit(main())
