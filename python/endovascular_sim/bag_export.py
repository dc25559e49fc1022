"""Tables of a bag: a CSV file per topic with a row per message, and one per list whose length is not always the same.

A file carries the name of its topic, with dots for slashes: drive.applied.csv. Its columns are `row`, `bag_time` (time of the recording
[s]) and the fields of the message, nested ones joined by dots: header.stamp, position.x. Lists of one length for the whole bag have a
column per element: insertion.0. Other lists are in TOPIC.FIELD.csv, whose columns are `row` of the message, `index`, and the value or the
fields of the element. Numbers have all digits. Bytes, such as those of images and saved states, are counted only."""

import csv
import json
import os
import pathlib
import sys

import numpy as np

from .bag import Bag, InputError
from .plots import command

EXIT_CODES = ("Exit code: 0 every message is exported; 1 failure (the reason is on the error stream); 2 wrong arguments; 3 the bag is damaged: "
              "the tables hold what can be read.")
LONGEST_ROW = 32  # elements of a list that become columns


class Topic:
    """Tables of one topic, filled message by message in two passes: lengths of the lists, then rows."""

    def __init__(self, name):
        self.name = name.strip("/").replace("/", ".")
        self.lengths = {}  # of each list: one length, or None

    def measure(self, message):
        """First pass: notes the lengths of the lists."""
        for field, value in _leaves("", message):
            if _is_list(value):
                self.lengths[field] = len(value) if self.lengths.get(field, len(value)) == len(value) else None

    def is_column(self, field, value):
        """True for a list that becomes columns: numbers or texts, always of one length."""
        length = self.lengths.get(field)
        return length is not None and length <= LONGEST_ROW and not (length and isinstance(value[0], dict))

    def cells(self, message):
        """Columns of a message, and its further lists."""
        row, lists = {}, {}
        for field, value in _leaves("", message):
            if isinstance(value, np.ndarray) and value.dtype in (np.uint8, np.int8):
                row[field + ".bytes"] = len(value)
            elif not _is_list(value):
                row[field] = value
            elif self.is_column(field, value):
                for k, element in enumerate(value):
                    row.update(_columns("%s.%d" % (field, k), element))
            else:
                lists[field] = value
        return row, lists


def _is_list(value):
    return isinstance(value, (list, np.ndarray))


def _leaves(prefix, message):
    """Fields of a message and of those that it holds, with their full names."""
    for name, value in message.items():
        if isinstance(value, dict):
            yield from _leaves(prefix + name + ".", value)
        else:
            yield prefix + name, value


def _columns(name, element):
    """Columns of an element of a list: one, one per coordinate, or those of a message. Lists within it become a text."""
    if isinstance(element, dict):
        prefix = name + "." if name else ""
        return {field: _joined(value) if _is_list(value) else value for field, value in _leaves(prefix, element)}
    if isinstance(element, np.ndarray):  # a point, a quaternion
        names = "xyzw" if len(element) <= 4 else range(len(element))
        return {"%s%s" % (name + "." if name else "", axis): value for axis, value in zip(names, element)}
    return {name or "value": element}


def _joined(values):
    """Text of a list: its numbers, or its messages as JSON."""
    if len(values) and isinstance(values[0], dict):
        return json.dumps(values, ensure_ascii=False, default=lambda value: value.tolist())
    return " ".join(map(_text, np.ravel(values)))


def _text(value):
    """Number with the digits that give it back, or text."""
    if isinstance(value, (bool, np.bool_)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value)) if not isinstance(value, np.float32) else str(value)
    return str(value)


class Table:
    """CSV file whose columns are those of its first row."""

    def __init__(self, path, columns):
        self.columns = list(columns)
        self.stream = open(path, "w", newline="", encoding="utf-8")  # noqa: SIM115: closed by close()
        self.writer = csv.writer(self.stream, lineterminator="\n")
        self.writer.writerow(self.columns)

    def add(self, row):
        self.writer.writerow([_text(row.get(column, "")) for column in self.columns])

    def close(self):
        self.stream.close()


def readable(bag, name):
    """Messages of a topic up to the first one that cannot be read; that one becomes the damage of the bag."""
    try:
        yield from bag.read(name)
    except InputError as error:
        bag.damage = bag.damage or "%s: %s" % (name, error)


def export_topic(bag, name, folder):
    """Writes the tables of a topic. Returns their paths."""
    topic = Topic(name)
    for _, message in readable(bag, name):
        topic.measure(message)
    tables = {}

    def add(label, row):
        if label not in tables:
            tables[label] = Table(folder / (label + ".csv"), row)
        tables[label].add(row)

    try:
        for number, (time, message) in enumerate(readable(bag, name)):
            row, lists = topic.cells(message)
            add(topic.name, {"row": number, "bag_time": time, **row})
            for field, elements in lists.items():
                for index, element in enumerate(elements):
                    add("%s.%s" % (topic.name, field), {"row": number, "index": index, **_columns("", element)})
    finally:
        for table in tables.values():
            table.close()
    return [folder / (label + ".csv") for label in tables]


def export(bag, folder, topics=(), show=False):
    """Writes the tables of a bag into a folder, created if missing.

    topics  names; empty: all
    show    true: progress on the error stream

    Returns the paths of the tables. Raises InputError for a topic that the bag does not hold, OSError where a file cannot be written.
    """
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name in topics:
        next(bag.read(name), None)  # raises for a topic that is missing
    names = sorted(topics or bag.topics)
    paths = []
    for k, name in enumerate(names):
        if show:
            print("\r\033[K%d of %d: %s" % (k + 1, len(names), name), end="", file=sys.stderr, flush=True)
        paths += export_topic(bag, name, folder)
    if show:
        print("\r\033[K", end="", file=sys.stderr, flush=True)
    return paths


def main(words=None):
    """Program bag_export; returns the exit code."""
    parser = command.argument_parser("bag_export", "Writes what a bag holds as CSV, a file per topic (docs/BAGS.md).", EXIT_CODES)
    parser.add_argument("bag", metavar="BAG", help="bag of a session, or any bag of ROS 1; its index is not needed")
    parser.add_argument("--out", required=True, metavar="DIR", help="folder for the tables, created if missing")
    parser.add_argument("--topic", action="append", default=[], metavar="TOPIC", help="only this topic, by its end; may be repeated")
    options = parser.parse_args(words)
    if os.path.isdir(options.bag):
        options.bag = os.path.join(options.bag, "session.bag")
    try:
        bag = Bag(options.bag)
        paths = export(bag, options.out, options.topic, sys.stderr.isatty())
    except (InputError, OSError) as error:
        print("bag_export: %s" % error, file=sys.stderr)
        return 1
    print("%d tables in %s" % (len(paths), options.out))
    if bag.damage:
        print("bag_export: %s: the bag is damaged: %s" % (options.bag, bag.damage), file=sys.stderr)
        return 3
    return 0
