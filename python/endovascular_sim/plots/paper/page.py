"""Tables of docs/REPRODUCE.md, between two marks of the page, from the rows and reproduce.csv."""

import csv

from ..command import Failure
from .rows import ROWS

BEGIN, END = "<!-- tables: plots reproduce -->", "<!-- end of the tables -->"
SECONDS = "processor time of the row [s]"


def read(path):
    """Rows of reproduce.csv as dictionaries; none without the file."""
    if not path.is_file():
        return []
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def verdict(rows):
    """Outcome of the measurements of a row: "holds", "fails" or "not judged"."""
    found = {row["holds"] for row in rows}
    return "fails" if "no" in found else "holds" if "yes" in found else "not judged"


def _line(cells):
    return "| %s |\n" % " | ".join(cells)


def _duration(rows):
    """Processor time of a row in words."""
    seconds = [float(row["here"]) for row in rows if row["quantity"] == SECONDS]
    if not seconds:
        return "–"
    return "%.0f s" % max(1.0, seconds[0]) if seconds[0] < 90 else "%.0f min" % (seconds[0] / 60.0)


def tables(results):
    """Both tables as Markdown: a line per figure, and a line per measurement."""
    text = _line(["figure", "the paper shows", "ours", "command", "time", "outcome", "agreement"]) + _line(["---"] * 7)
    for row in ROWS:
        own = [one for one in results if one["row"] == row.name]
        picture = "[picture](%s)" % row.picture if row.picture else "–"
        text += _line([row.title, row.paper, picture, "`--row %s`" % row.name if row.measure else "–", _duration(own), verdict(own), row.agreement])
    text += "\n" + _line(["figure", "quantity", "the paper", "here", "agrees", "accepted", "holds"]) + _line(["---"] * 7)
    for row in ROWS:
        for one in results:
            if one["row"] == row.name and one["quantity"] != SECONDS:
                text += _line([row.title] + [one[key] for key in ("quantity", "the paper", "here", "agrees", "accepted", "holds")])
    return text


def with_tables(text, results, name):
    """Page with the tables of the results."""
    before, found, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not found or not end:
        raise Failure("%s: the marks %s and %s are missing" % (name, BEGIN, END))
    return before + BEGIN + "\n\n" + tables(results) + "\n" + END + after
