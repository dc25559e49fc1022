#!/bin/bash
# Every relative link of the documentation names an existing file and heading. Every page can be reached from docs/index.md.
# Every path of the repository in backticks exists; NAME, TARGET and the like stand for any name.
# The pages that show C++ programs quote those of test/install/plain_cmake, which are compiled and run.
# Runs beside other tests.
set -eu
cd "$(dirname "$0")/../.."
exec /usr/bin/python3 - <<'PYTHON'
import glob
import os
import re
import subprocess
import sys
import unicodedata


def without_code(text):
    text = re.sub(r"^(```|~~~).*?^\1[^\n]*$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^(    |\t).*$", "", text, flags=re.MULTILINE)
    return re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", "", text)


def anchors(path):
    """Anchors of a page's headings, as GitHub makes them."""
    found = set()
    text = re.sub(r"^(```|~~~).*?^\1[^\n]*$", "", open(path).read(), flags=re.MULTILINE | re.DOTALL)
    for heading in re.findall(r"^#{1,6}\s+(.*?)\s*#*$", text, re.MULTILINE):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        kept = (c for c in heading if c in " -_" or unicodedata.category(c)[0] in "LN")
        slug = base = "".join(kept).replace(" ", "-")
        number = 0
        while slug in found:
            number += 1
            slug = "%s-%d" % (base, number)
        found.add(slug)
    found.update(re.findall(r'<a (?:id|name)="([^"]+)"', text))
    return found


listed = subprocess.check_output(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], text=True)
pages = [path for path in listed.splitlines() if path.startswith("docs/") or "/" not in path]
errors = []
links = {}
for page in pages:
    links[page] = set()
    text = without_code(open(page).read())
    targets = re.findall(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)", text)
    targets += re.findall(r"^\s*\[[^\]]+\]:\s*(\S+)", text, re.MULTILINE)
    targets += re.findall(r'<(?:img|a)[^>]*\b(?:src|href)="([^"]+)"', text)
    for target in targets:
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        path = os.path.normpath(os.path.join(os.path.dirname(page), file)) if file else page
        if not os.path.exists(path):
            errors.append("%s: no such file: %s" % (page, target))
        elif anchor and path.endswith(".md") and anchor not in anchors(path):
            errors.append("%s: no such heading: %s" % (page, target))
        links[page].add(path)

TOP = "src|test|config|msg|srv|launch|docs|rviz|catkin_ws|python|examples"
for page in pages:
    for path in re.findall(r"`((?:%s)/[\w./*-]+)`" % TOP, open(page).read()):
        if path.startswith(("catkin_ws/build", "catkin_ws/devel", "catkin_ws/sanitized")):
            continue
        pattern = re.sub(r"[A-Z]{3,}(_[A-Z]+)*", "*", path) if not os.path.exists(path) else path
        if not glob.glob(pattern):
            errors.append("%s: no such file of the repository: %s" % (page, path))
    for path in re.findall(r"`((?:%s)/[\w./]+\.(?:h|cpp))`" % "|".join(os.listdir("src")), open(page).read()):
        if not os.path.exists("src/" + path):
            errors.append("%s: no such file: src/%s" % (page, path))

start = "docs/index.md"
reached, waiting = {start}, [start]
while waiting:
    for path in links.get(waiting.pop(), ()):
        if path in links and path not in reached:
            reached.add(path)
            waiting.append(path)
programs = {name: open("test/install/plain_cmake/%s.cpp" % name).read() for name in ("step_a_scene", "run_a_procedure")}
for page in pages:
    for block in re.findall(r"```cpp\n(.*?)```", open(page).read(), re.DOTALL):
        if "int main" in block and block not in programs.values():
            errors.append("%s: a program differs from those of test/install/plain_cmake" % page)
errors += ["%s cannot be reached from %s" % (page, start) for page in pages if page not in reached]
print("\n".join(errors))
sys.exit(1 if errors else 0)
PYTHON
