#!/usr/bin/python3
"""Selects the reports of the thread sanitizer in which the code of this project makes both accesses.

Debian's ROS is not instrumented: the sanitizer sees its locks and allocations, but neither its memory accesses nor its
atomic reference counts, and reports races and lock cycles within roscpp that do not exist. The first frame of a stack that
belongs neither to the sanitizer nor to the standard library nor to Eigen names the owner of an access. A report counts when
the sources of this project own all of its accesses.

    thread_reports.py REPOSITORY FILE...    prints the reports that count; exit code 1 when there is one
"""

import re
import sys

BLOCK = re.compile(r"^  .*(?:of size \d+ at |acquired here|by (?:main )?thread)")
FRAME = re.compile(r"^    #\d+ (.*)$")
TRANSPARENT = re.compile(r"/include/c\+\+/|/eigen3/|/bits/|<null> \((?!lib)[\w.]+\+0x")


def reports(text):
    """Reports of one process, as lists of lines."""
    current = None
    for line in text.splitlines():
        if line.startswith("WARNING: ThreadSanitizer:"):
            current = []
        if current is not None:
            current.append(line)
            if line.startswith("SUMMARY: ThreadSanitizer:"):
                yield current
                current = None
    if current:
        yield current


def stacks(report):
    """Stacks of the accesses, or of the locks in the order in which they were acquired; not those of the creation of
    threads, mutexes and memory."""
    stack = None
    for line in report[1:]:
        frame = FRAME.match(line)
        if frame:
            if stack is not None:
                stack.append(frame.group(1))
            continue
        if stack:
            yield stack
        stack = [] if BLOCK.match(line) and " created " not in line and " allocated " not in line else None
    if stack:
        yield stack


def owner(stack):
    """First frame that is not transparent; empty for a stack without one."""
    return next((frame for frame in stack if not TRANSPARENT.search(frame)), "")


def own_reports(text, repository):
    """Reports, as texts, all of whose accesses are made by the sources of a repository."""
    own = re.compile("(?:%s/|(?:\\.\\./)+)(?:src|test)/" % re.escape(repository.rstrip("/")))
    found = []
    for report in reports(text):
        accesses = list(stacks(report))
        if accesses and all(own.search(owner(stack)) for stack in accesses):
            found.append("\n".join(report))
    return found


def main():
    found = []
    for path in sys.argv[2:]:
        with open(path, errors="replace") as file:
            found += own_reports(file.read(), sys.argv[1])
    print("\n\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
