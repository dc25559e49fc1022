"""Reading of the tables of results."""

import csv
import json

import numpy as np

from .command import Failure, warn


def read(path, needed=()):
    """Columns of a CSV file by name: arrays of numbers, an empty cell as NaN, or of texts.

    needed  columns without which the file is refused
    The last row of an interrupted session may be incomplete; it is left out.
    """
    with open(path, newline="", encoding="utf-8") as stream:
        lines = csv.reader(stream)
        header = next(lines, [])
        rows = list(lines)
    missing = [name for name in needed if name not in header]
    if missing:
        raise Failure("%s: no column %s in the header line" % (path, ", ".join(missing)))
    if rows and not _fits(header, rows):
        warn("%s: line %d skipped: incomplete" % (path, len(rows) + 1))
        rows.pop()
    columns = zip(*rows) if rows else [()] * len(header)
    return {name: _column(cells) for name, cells in zip(header, columns)}


def read_if_any(path, needed=()):
    """As read(), None without the file or without rows in it."""
    if not path.is_file():
        return None
    table = read(path, needed)
    return table if len(next(iter(table.values()), ())) else None


def select(table, mask):
    """Rows of a table."""
    return {name: column[mask] for name, column in table.items()}


def groups(table, *keys):
    """Values of the key columns and the rows that have them, in order of appearance."""
    values = list(zip(*(table[key] for key in keys)))
    for own in dict.fromkeys(values):
        yield own, select(table, np.array([one == own for one in values]))


def read_json(path):
    """Content of a JSON file."""
    with open(path, encoding="utf-8") as stream:
        return json.load(stream)


def read_json_if_any(path):
    """As read_json(), None without a readable file."""
    try:
        return read_json(path)
    except (OSError, ValueError):
        return None


def write(path, rows):
    """Writes rows, dictionaries with equal keys, as a CSV file."""
    with open(path, "w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _numbers(cells):
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return None


def _column(cells):
    numbers = _numbers(cells)
    return np.array(cells, dtype=object) if numbers is None else numbers


def _fits(header, rows):
    """True if the last row has all cells, and numbers where the row before it has numbers."""
    if len(rows[-1]) != len(header):
        return False
    return len(rows) < 2 or all(_numbers([last]) is not None for before, last in zip(rows[-2], rows[-1])
                                if before and _numbers([before]) is not None)
