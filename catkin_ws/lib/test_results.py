#!/usr/bin/python3
"""Writes and counts JUnit result files: one place that knows how many tests passed, failed and were skipped."""

import argparse
import os
import sys
import xml.etree.ElementTree as ElementTree

SKIPPED = 77  # exit code by which a script says that it cannot run here


def write(arguments):
    """Writes the outcome of one command as a JUnit file with one test case."""
    with open(arguments.log, errors="replace") as log:
        text = log.read()[-4000:]
    text = "".join(c for c in text if c in "\n\t" or " " <= c < "\ud800")
    suite = ElementTree.Element("testsuite", name="checks", tests="1")
    case = ElementTree.SubElement(
        suite, "testcase", classname="checks", name=arguments.name, time="%.3f" % arguments.seconds)
    if arguments.status == SKIPPED:
        ElementTree.SubElement(case, "skipped").text = text
    elif arguments.status != 0:
        failure = ElementTree.SubElement(case, "failure", message="exit code %d" % arguments.status)
        failure.text = text
    os.makedirs(os.path.dirname(arguments.file), exist_ok=True)
    ElementTree.ElementTree(suite).write(arguments.file, encoding="utf-8", xml_declaration=True)


def outcome(case):
    """'failed', 'skipped' or 'passed', and the reason."""
    for kind in ("failure", "error"):
        element = case.find(kind)
        if element is not None:
            return "failed", (element.get("message") or element.text or "").strip()
    if case.find("skipped") is not None or case.get("status") == "notrun":
        return "skipped", ""
    return "passed", ""


def summary(arguments):
    """Prints every failure and the closing line; the exit code is 0 when something passed and nothing failed."""
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for folder, folders, files in os.walk(arguments.folder):
        folders.sort()
        for name in sorted(files):
            if not name.endswith(".xml"):
                continue
            path = os.path.join(folder, name)
            try:
                root = ElementTree.parse(path).getroot()
            except ElementTree.ParseError as error:
                counts["failed"] += 1
                print("   FAILED  %s: not a complete result file (%s)" % (path, error))
                continue
            cases = list(root.iter("testcase"))
            declared = int(root.get("errors") or 0) + int(root.get("failures") or 0)
            failed_here = 0
            for case in cases:
                result, reason = outcome(case)
                counts[result] += 1
                if result == "failed":
                    failed_here += 1
                    print("   FAILED  %s.%s: %s" % (case.get("classname"), case.get("name"),
                                                   (reason.splitlines() or [""])[0]))
            # A suite that could not run has an error of its own and no case to carry it.
            if declared > 0 and failed_here == 0:
                counts["failed"] += 1
                print("   FAILED  %s: the suite reports %d errors" % (path, declared))
    line = "%d passed, %d failed" % (counts["passed"], counts["failed"])
    if counts["skipped"]:
        line += ", %d skipped" % counts["skipped"]
    if counts["passed"] + counts["failed"] == 0:
        print("   no test ran")
    print(line)
    return 0 if counts["failed"] == 0 and counts["passed"] > 0 else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser("write", help="write the outcome of one command")
    one.add_argument("file")
    one.add_argument("--name", required=True)
    one.add_argument("--status", type=int, required=True)
    one.add_argument("--seconds", type=float, default=0.0)
    one.add_argument("--log", required=True)
    one.set_defaults(run=write)
    every = commands.add_parser("summary", help="count all result files below a folder")
    every.add_argument("folder")
    every.set_defaults(run=summary)
    arguments = parser.parse_args()
    return arguments.run(arguments)


if __name__ == "__main__":
    sys.exit(main())
