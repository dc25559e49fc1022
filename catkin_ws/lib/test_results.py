#!/usr/bin/python3
"""Writes and counts JUnit result files: the one place that counts passed, failed and skipped tests.

    test_results.py summary FOLDER
"""

import argparse
import glob
import os
import sys
import xml.etree.ElementTree as ElementTree

SKIPPED = 77  # exit code of a script that cannot run on this machine
SLOWEST = 10  # tests listed in the summary


class Case:
    """Outcome of one test."""

    def __init__(self, suite, name):
        self.suite = suite
        self.name = name
        self.seconds = 0.0
        self.failed = False
        self.skipped = False
        self.message = ""
        self.text = ""


def printable(text):
    """The characters of a text that XML can hold."""
    return "".join(c for c in text if c in "\n\t" or " " <= c < "\ud800")


def write_cases(path, name, cases):
    """Writes a JUnit file."""
    suite = ElementTree.Element("testsuite", name=name, tests=str(len(cases)))
    for case in cases:
        element = ElementTree.SubElement(
            suite, "testcase", classname=case.suite, name=case.name, time="%.3f" % case.seconds)
        if case.failed:
            ElementTree.SubElement(element, "failure", message=printable(case.message)).text = printable(case.text)
        elif case.skipped:
            ElementTree.SubElement(element, "skipped").text = printable(case.text)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    ElementTree.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


def outcome(case):
    """'failed', 'skipped' or 'passed', and the reason."""
    for kind in ("failure", "error"):
        element = case.find(kind)
        if element is not None:
            return "failed", (element.get("message") or element.text or "").strip()
    if case.find("skipped") is not None or case.get("status") == "notrun":
        return "skipped", ""
    return "passed", ""


def count_failed(folder, name):
    """Failed tests in the result files of that name below a folder; an incomplete file counts as one."""
    failed = 0
    for path in glob.glob(os.path.join(folder, "**", "*" + name), recursive=True):
        try:
            root = ElementTree.parse(path).getroot()
        except ElementTree.ParseError:
            failed += 1
            continue
        cases = sum(outcome(case)[0] == "failed" for case in root.iter("testcase"))
        failed += cases or int(root.get("errors") or 0) + int(root.get("failures") or 0)
    return failed


def summary(folder):
    """Prints the slowest tests, every failure and the closing line. The exit code is 0 when at least one test passed and
    none failed."""
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    slowest, failures = [], []
    for parent, folders, files in os.walk(folder):
        folders.sort()
        for name in sorted(files):
            if not name.endswith(".xml"):
                continue
            path = os.path.join(parent, name)
            try:
                root = ElementTree.parse(path).getroot()
            except ElementTree.ParseError as error:
                counts["failed"] += 1
                failures.append("%s: not a complete result file (%s)" % (path, error))
                continue
            declared = int(root.get("errors") or 0) + int(root.get("failures") or 0)
            failed_here = 0
            for case in root.iter("testcase"):
                result, reason = outcome(case)
                counts[result] += 1
                slowest.append((float(case.get("time") or 0.0), "%s.%s" % (case.get("classname"), case.get("name"))))
                if result == "failed":
                    failed_here += 1
                    failures.append("%s.%s: %s" % (case.get("classname"), case.get("name"),
                                                   (reason.splitlines() or [""])[0]))
            # A suite that could not start has an error of its own and no test case.
            if declared > 0 and failed_here == 0:
                counts["failed"] += 1
                failures.append("%s: the suite reports %d errors" % (path, declared))
    if slowest:
        print("   the slowest tests:")
        for seconds, name in sorted(slowest, reverse=True)[:SLOWEST]:
            print("   %8.1f s  %s" % (seconds, name))
    for failure in failures:
        print("   FAILED  " + failure)
    line = "%d passed, %d failed" % (counts["passed"], counts["failed"])
    if counts["skipped"]:
        line += ", %d skipped" % counts["skipped"]
    if counts["passed"] + counts["failed"] == 0:
        print("   no test ran")
    print(line)
    return 0 if counts["failed"] == 0 and counts["passed"] > 0 else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    every = commands.add_parser("summary", help="count all result files below a folder")
    every.add_argument("folder")
    return summary(parser.parse_args().folder)


if __name__ == "__main__":
    sys.exit(main())
