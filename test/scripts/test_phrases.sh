#!/bin/bash
# No file of the repository holds a phrase of test/data/phrases_not_used.txt: sentences that were rewritten in the standard
# terms of the field. Line breaks and comment markers between the words do not hide a phrase.
# Runs beside other tests.
set -eu
cd "$(dirname "$0")/../.."
exec /usr/bin/python3 - <<'PYTHON'
import re
import subprocess
import sys

LIST = "test/data/phrases_not_used.txt"


def words(text):
    return " ".join(re.sub(r"(?m)^\s*(///?|/?\*+|#+)", " ", text).replace('"\n', "\n").split())


phrases = [words(line) for line in open(LIST) if line.strip() and not line.startswith("#")]
files = subprocess.check_output(["git", "ls-files", "--cached", "--others", "--exclude-standard"], text=True).splitlines()
found = False
for path in files:
    if path == LIST:
        continue
    try:
        text = words(open(path, encoding="utf-8").read())
    except (UnicodeDecodeError, OSError):  # a picture, a link to a folder, a deleted file
        continue
    for phrase in phrases:
        if phrase in text:
            print("%s: \"%s\"" % (path, phrase))
            found = True
sys.exit(1 if found else 0)
PYTHON
