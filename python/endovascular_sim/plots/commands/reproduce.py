"""Reproduces the figures and tables of the paper that this project began with (docs/REPRODUCE.md): runs every row, checks each
measurement against what is accepted, and ends with the table.

Writes reproduce.csv and a picture per row. The rows of an existing table that are not run stay."""

import csv
import pathlib
import resource
import sys
import traceback

from ..paper import page
from ..paper.row import RESULT, TIME, Measurement
from ..paper.rows import ROWS, row_of

EXIT_CODES = "Exit code: 0 every measurement is accepted; 1 one is not, or a row failed; 2 wrong arguments."


def processor_time():
    """Processor time of this program and its ended children [s]."""
    return sum(usage.ru_utime + usage.ru_stime for usage in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def measurements_of(row, folder):
    """Lines of reproduce.csv of a row; a failure becomes a line that does not hold."""
    begin = processor_time()
    try:
        measured = row.measure(folder)
    except Exception as error:  # noqa: B902: whatever ends a row, the other rows are measured
        measured = [Measurement("row", "–", "failed: %s" % (str(error).splitlines() or [type(error).__name__])[0], "measured", False)]
        traceback.print_exc()
    measured.append(Measurement(page.SECONDS, "–", "%.0f" % (processor_time() - begin), kind=TIME))
    return [one.cells(row.name) for one in measured]


def write(path, lines):
    """Writes reproduce.csv."""
    with open(path, "w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, Measurement("", "", "").cells("").keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)


def merged(old, new, names):
    """Lines in the order of the paper: new ones of the rows that were run, old ones of the others."""
    return [line for row in ROWS for line in (new if row.name in names else old) if line["row"] == row.name]


def differences(lines, expected, names):
    """Texts of the results that differ from those of another reproduce.csv."""
    def results(table):
        return {(line["row"], line["quantity"]): line for line in table if line["row"] in names and line["kind"] == RESULT}
    here, there = results(lines), results(expected)
    return ["%s, %s: %s, expected %s" % (*key, here.get(key, {}).get("here", "missing"), there.get(key, {}).get("here", "none"))
            for key in sorted({*here, *there}) if here.get(key) != there.get(key)]


def print_table(lines):
    """Prints a line per measurement."""
    widths = {"row": 7, "quantity": 72, "the paper": 26, "here": 40, "accepted": 24, "holds": 5}
    for line in [{key: key for key in widths}] + lines:
        print("  ".join(line[key].ljust(width) for key, width in widths.items()).rstrip())


def add_arguments(parser):
    parser.add_argument("--out", required=True, type=pathlib.Path, metavar="DIR", help="folder for table, pictures and runs")
    names = [row.name for row in ROWS if row.measure]
    parser.add_argument("--row", action="append", choices=names, metavar="ROW",
                        help="only this row; may be repeated: %s" % ", ".join(names))
    parser.add_argument("--fast", action="store_true", help="only rows of less than half a minute")
    parser.add_argument("--table", type=pathlib.Path, metavar="FILE.csv", help="table to write, or whose rows are replaced [DIR/reproduce.csv]")
    parser.add_argument("--page", type=pathlib.Path, metavar="FILE.md", help="page whose tables are written anew")
    parser.add_argument("--compare", type=pathlib.Path, metavar="FILE.csv",
                        help="reproduce.csv whose results, without times, must be equal")


def run(options):
    """Runs the rows and prints the table."""
    names = options.row or [row.name for row in ROWS if row.measure and (row.fast or not options.fast)]
    options.out.mkdir(parents=True, exist_ok=True)
    path, new = options.table or options.out / "reproduce.csv", []
    for count, name in enumerate(names, 1):
        row = row_of(name)
        print("%s (%d of %d): %s …" % (row.title, count, len(names), row.paper), file=sys.stderr, flush=True)
        new += measurements_of(row, options.out)
        write(path, merged(page.read(path), new, names[:count]))
    lines = merged(page.read(path), [], [])
    if options.page:
        options.page.write_text(page.with_tables(options.page.read_text(encoding="utf-8"), lines, options.page), encoding="utf-8")
    print_table([line for line in lines if line["row"] in names])
    failed = [line for line in new if line["holds"] == "no"]
    different = differences(new, page.read(options.compare), names) if options.compare else []
    for text in different:
        print("differs: " + text)
    print("%d rows, %d measurements, %d not accepted" % (len(names), len(new) - len(names), len(failed)))
    return 1 if failed or different else 0
