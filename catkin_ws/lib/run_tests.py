#!/usr/bin/python3
"""Runs the built tests of the package and reports them: gtest programs in parallel shards and the scripts that share
the processors, then the programs that measure time, the rostests and the other scripts one after another. Every test has a ceiling of time; the last line reads
`N passed, N failed`."""

import argparse
import concurrent.futures
import fnmatch
import glob
import os
import re
import selectors
import shutil
import signal
import subprocess
import sys
import time

import test_results

# Programs whose tests have deadlines of milliseconds: nothing runs beside them.
ALONE = ("common", "haptics", "nodes")
SECONDS_PER_GTEST = 300  # default ceiling of one test case
SECONDS_PER_ROSTEST = 300
SECONDS_PER_SCRIPT = 900
SECONDS_PER_LONG_SCRIPT = 4 * 3600  # scripts of test/scripts/all
SHARES = "# Runs beside other tests."  # line of a script that starts no graph and measures no time
TESTS_PER_SHARD = 10  # a program with fewer is not divided


class Run:
    """One process: a shard of a gtest program, a rostest or a script."""

    def __init__(self, kind, name, command, environment=None, alone=False):
        self.kind = kind
        self.name = name
        self.command = command
        self.environment = environment or {}
        self.alone = alone  # nothing runs beside it


class Runner:
    seconds_per_rostest = SECONDS_PER_ROSTEST

    def __init__(self, arguments):
        self.arguments = arguments
        self.repository = os.path.realpath(arguments.repository)
        self.workspace = os.path.join(self.repository, "catkin_ws")
        self.programs = os.path.join(self.workspace, "devel", "lib", "endovascular_sim")
        self.results_in(os.path.join(self.workspace, "build"))

    def results_in(self, build):
        """Empty folders of results and logs below a build folder."""
        self.build = build
        self.results = os.path.join(build, "test_results")
        self.logs = os.path.join(build, "test_logs")
        for folder in (self.results, self.logs):
            shutil.rmtree(folder, ignore_errors=True)
            os.makedirs(folder)

    # ------------------------------------------------------------------------------------------------- what to run

    def folders(self):
        """Folders of test/ with a gtest program."""
        return [name for name in sorted(os.listdir(os.path.join(self.repository, "test")))
                if os.path.exists(os.path.join(self.programs, "test_" + name))]

    def filter_of(self, folder, wanted):
        """gtest filter of the tests in a sub-folder of test/, e.g. rod/contact, whose names match the glob."""
        patterns = []
        for path in glob.glob(os.path.join(self.repository, "test", folder, "**", "test_*.cpp"), recursive=True):
            with open(path) as source:
                text = source.read()
            for suite, name in re.findall(r"^(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", text, re.MULTILINE):
                if any(fnmatch.fnmatchcase("%s.%s" % (suite, name), glob_) for glob_ in wanted.split(":")):
                    patterns += ["%s.%s" % (suite, name), "*/%s.%s/*" % (suite, name), "%s/*.%s" % (suite, name)]
        return ":".join(patterns)

    def tests_in(self, program, gtest_filter):
        listed = subprocess.run([program, "--gtest_list_tests", "--gtest_filter=" + gtest_filter],
                                cwd=self.repository, stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
        return sum(line.startswith("  ") for line in listed.splitlines())

    def gtests(self):
        only = self.arguments.only
        if only and only.split("/")[0] == "scripts":
            return []
        runs = []
        for folder in self.folders():
            if only and only.split("/")[0] != folder:
                continue
            program = os.path.join(self.programs, "test_" + folder)
            gtest_filter = self.arguments.filter or "*"
            if only and "/" in only:
                gtest_filter = self.filter_of(only, gtest_filter)
                if not gtest_filter:
                    raise SystemExit("error: there is no test '%s' in test/%s" % (self.arguments.filter or "*", only))
            count = self.tests_in(program, gtest_filter)
            if count == 0:
                continue
            shards = 1 if folder in ALONE else max(1, min(2 * processors(), count // TESTS_PER_SHARD))
            for shard in range(shards):
                name = "test_" + folder + ("" if shards == 1 else "_%d_of_%d" % (shard + 1, shards))
                runs.append(Run("gtest", name, [program, "--gtest_color=no", "--gtest_filter=" + gtest_filter],
                                {"GTEST_TOTAL_SHARDS": str(shards), "GTEST_SHARD_INDEX": str(shard)}, folder in ALONE))
        return runs

    def rostests(self):
        if self.arguments.no_rostest or (self.arguments.only and self.arguments.only != "nodes"):
            return []
        runs = []
        for launch in sorted(glob.glob(os.path.join(self.repository, "test", "nodes", "*.test"))):
            name = "graph_" + os.path.splitext(os.path.basename(launch))[0]
            if self.wanted(name):
                # rostest starts a master on a free port.
                runs.append(Run("rostest", name, [
                    "/usr/bin/rostest", "--pkgdir=" + self.repository, "--package=endovascular_sim",
                    "--results-filename=" + name + ".xml", "--results-base-dir=" + self.results, launch]))
        return runs

    def scripts(self):
        if self.arguments.only and self.arguments.only != "scripts":
            return []
        folder = os.path.join(self.repository, "test", "scripts")
        paths = sorted(glob.glob(os.path.join(folder, "test_*.sh")))
        if self.arguments.all:
            paths += sorted(glob.glob(os.path.join(folder, "all", "test_*.sh")))
        runs = []
        for path in paths:
            name = os.path.splitext(os.path.basename(path))[0]
            if self.wanted(name):
                long = os.path.basename(os.path.dirname(path)) == "all"
                runs.append(Run("long script" if long else "script", name, ["bash", path], alone=not shares(path)))
        return runs

    def wanted(self, name):
        return not self.arguments.filter or fnmatch.fnmatchcase(name, self.arguments.filter)

    # ------------------------------------------------------------------------------------------------------ running

    def run(self, run):
        """Runs one process to its end and writes its results."""
        log = os.path.join(self.logs, run.name + ".log")
        scratch = os.path.join(self.build, "test_scratch", run.name)
        shutil.rmtree(scratch, ignore_errors=True)
        os.makedirs(scratch)
        environment = dict(os.environ, ROS_HOME=os.path.join(scratch, "ros"), **run.environment)
        if run.kind == "gtest":  # tests that write files of fixed names run beside each other
            environment["TMPDIR"] = scratch
        begin = time.monotonic()
        if run.kind == "gtest":
            cases = self.run_gtest(run, log, environment)
        else:
            cases = self.run_command(run, log, environment)
        shutil.rmtree(scratch, ignore_errors=True)
        if cases is not None:
            test_results.write_cases(os.path.join(self.results, run.name + ".xml"), run.name, cases)
            failed = sum(case.failed for case in cases)
        else:
            failed = test_results.count_failed(self.results, run.name + ".xml")
        outcome = "ok" if not failed else "FAILED, see " + log
        if cases and all(case.skipped for case in cases):
            outcome = "skipped"
        print("   %-52s %7.1f s  %s" % (run.name, time.monotonic() - begin, outcome), flush=True)

    def run_command(self, run, log, environment):
        """A script or a rostest. Returns its cases, or None where it has written a result file itself."""
        seconds = {"script": SECONDS_PER_SCRIPT, "long script": SECONDS_PER_LONG_SCRIPT,
                   "rostest": self.seconds_per_rostest}[run.kind]
        case = test_results.Case("scripts" if run.kind != "rostest" else "nodes", run.name)
        begin = time.monotonic()
        with open(log, "w") as output:
            process = subprocess.Popen(run.command, cwd=self.repository, env=environment, stdin=subprocess.DEVNULL,
                                       stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
            try:
                status = process.wait(timeout=seconds)
            except subprocess.TimeoutExpired:
                end_group(process)
                status = None
        case.seconds = time.monotonic() - begin
        with open(log, errors="replace") as output:
            case.text = output.read()[-4000:]
        if status is None:
            case.failed, case.message = True, "not finished within %d s" % seconds
        elif run.kind == "rostest":
            written = glob.glob(os.path.join(self.results, "**", run.name + ".xml"), recursive=True)
            written += glob.glob(os.path.join(self.results, "**", "*" + run.name + ".xml"), recursive=True)
            if written and (status == 0 or test_results.count_failed(self.results, run.name + ".xml")):
                return None
            case.failed, case.message = True, "exit code %d and no result of a test" % status
        elif status == test_results.SKIPPED:
            case.skipped = True
        elif status != 0:
            case.failed, case.message = True, "exit code %d: %s" % (status, reason_in(case.text))
        return [case]

    def run_gtest(self, run, log, environment):
        """A shard of a gtest program, read as it prints: a crash or a test that hangs loses no other result."""
        process = subprocess.Popen(run.command, cwd=self.repository, env=environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        cases, current, text = [], None, []
        begin = time.monotonic()
        hung = False
        with open(log, "w") as output, selectors.DefaultSelector() as selector:
            selector.register(process.stdout, selectors.EVENT_READ)
            pending = b""
            while True:
                if not selector.select(timeout=max(0.0, begin + self.arguments.ceiling - time.monotonic())):
                    end_group(process)
                    hung = True
                    break
                block = os.read(process.stdout.fileno(), 65536)
                if not block:
                    break
                *lines, pending = (pending + block).split(b"\n")
                for line in lines:
                    line = line.decode(errors="replace")
                    output.write(line + "\n")
                    started = re.match(r"\[ RUN      \] (\S+)$", line)
                    # A test may print without a newline before gtest's own line.
                    ended = re.search(r"\[(       OK |  FAILED  |  SKIPPED )\] (\S+?),?(?: where .*)? \((\d+) ms\)$", line)
                    if started:
                        current, text, begin = started.group(1), [], time.monotonic()
                    elif ended and ended.group(2) == current:
                        case = test_results.Case(*current.rsplit(".", 1))
                        case.seconds = int(ended.group(3)) / 1000
                        case.failed = "FAILED" in ended.group(1)
                        case.skipped = "SKIPPED" in ended.group(1)
                        case.message, case.text = first_line(text), "\n".join(text)[-4000:]
                        cases.append(case)
                        current, begin = None, time.monotonic()
                    elif current:
                        text.append(line)
        status = process.wait()
        if current or hung or (status != 0 and not any(case.failed for case in cases)):
            case = test_results.Case(*(current or run.name + ".end").rsplit(".", 1))
            case.seconds = time.monotonic() - begin
            case.failed = True
            reason = "not finished within %d s" % self.arguments.ceiling if hung else "the program ended with code %d" % status
            case.message, case.text = reason + "; the tests after it did not run", "\n".join(text)[-4000:]
            cases.append(case)
        return cases

    def run_all(self):
        if self.arguments.only and not self.known(self.arguments.only):
            raise SystemExit("error: there is no folder test/%s with tests" % self.arguments.only)
        gtests, rostests, scripts = self.gtests(), self.rostests(), self.scripts()
        alone = [run for run in gtests if run.alone]
        parallel = [run for run in gtests + scripts if not run.alone]
        if parallel:
            print("== gtest and scripts, %d at once; logs: %s" % (processors(), self.logs), flush=True)
            with concurrent.futures.ThreadPoolExecutor(processors()) as pool:
                for _ in pool.map(self.run, parallel):
                    pass
        for title, runs in (("gtest, tests with deadlines, one at a time", alone),
                            ("rostest, one at a time", rostests),
                            ("scripts, one at a time", [run for run in scripts if run.alone])):
            if runs:
                print("== " + title, flush=True)
            for run in runs:
                self.run(run)
        print("== Summary", flush=True)
        return test_results.summary(self.results)

    def known(self, folder):
        return folder == "scripts" or (folder.split("/")[0] in self.folders() and
                                       os.path.isdir(os.path.join(self.repository, "test", folder)))


def shares(path):
    """Whether a script may run beside other tests."""
    with open(path) as script:
        return SHARES in script.read().splitlines()


def processors():
    return len(os.sched_getaffinity(0))


def reason_in(text):
    """The last line of an output that names a failure, else its last line."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    named = [line for line in lines if re.search(r"FAILED|[Ee]rror|missed|differs", line)]
    return (named or lines or ["no output"])[-1][:300]


def first_line(lines):
    return next((line.strip() for line in lines if line.strip()), "")


def end_group(process):
    """Ends a process and its children: SIGINT first, so that a launch can end its nodes."""
    for number, patience in ((signal.SIGINT, 20), (signal.SIGTERM, 5), (signal.SIGKILL, 5)):
        try:
            os.killpg(process.pid, number)
            process.wait(timeout=patience)
            return
        except ProcessLookupError:
            return
        except subprocess.TimeoutExpired:
            continue


def parser_of(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("repository")
    parser.add_argument("--only", default="")
    parser.add_argument("--filter", default="")
    parser.add_argument("--no-rostest", action="store_true")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--ceiling", type=int, default=SECONDS_PER_GTEST, help="seconds of one gtest case at most")
    return parser


def main():
    return Runner(parser_of(__doc__).parse_args()).run_all()


if __name__ == "__main__":
    sys.exit(main())
