#!/usr/bin/python3
"""Compares the metrics of two or more sessions: a table on the terminal, and with --out as a page that needs no other
file."""

import argparse
import html
import json
import pathlib
import sys


def read(place):
    """Metrics of a folder of results, or a metrics.json itself."""
    path = pathlib.Path(place)
    path = path / "metrics.json" if path.is_dir() else path
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        sys.exit(f"session_compare: {path}: {error.strerror}; give a folder that holds a metrics.json")
    except ValueError as error:
        sys.exit(f"session_compare: {path}: is no metrics.json: {error}")


def get(metrics, *keys):
    """A value below some keys; None where one is missing."""
    for key in keys:
        if metrics is None:
            return None
        metrics = metrics.get(key)
    return metrics


def total(metrics, key):
    """Sum of a number over the instruments."""
    return sum(one.get(key) or 0 for one in metrics["instruments"])


def worst(metrics, key, pick):
    """Of a number over the instruments that moved."""
    values = [one[key] for one in metrics["instruments"] if one.get("tip_path")]
    return pick(values) if values else None


def lesion(metrics, *keys):
    """A value of the first lesion."""
    return get(metrics["lesions"][0], *keys) if metrics.get("lesions") else None


# What, how it is written, where it comes from, whether less is better (None: neither).
ROWS = [
    ("outcome", "{}", lambda m: m.get("outcome"), None),
    ("procedure time [s]", "{:.1f}", lambda m: m["procedure_time"], True),
    ("fluoroscopy time [s]", "{:.1f}", lambda m: m["fluoroscopy_time"], True),
    ("new tries", "{}", lambda m: sum(s["new_tries"] for s in m["steps"]), True),
    ("tip path of all instruments [mm]", "{:.0f}", lambda m: 1e3 * total(m, "tip_path"), True),
    ("smoothness, worst instrument (SPARC)", "{:.2f}", lambda m: worst(m, "spectral_arc_length", min), False),
    ("wrong branches entered", "{}", lambda m: len(m["wrong_branches"]), True),
    ("time in wrong branches [s]", "{:.1f}", lambda m: total(m, "wrong_branch_time"), True),
    ("largest force of one contact [N]", "{:.2f}", lambda m: get(m, "wall_forces", "peak"), True),
    ("  in", "{}", lambda m: get(m, "wall_forces", "peak_region"), None),
    ("integral of the wall's forces [N s]", "{:.1f}", lambda m: get(m, "wall_forces", "integral"), True),
    ("largest force at a hand [N]", "{:.2f}", lambda m: worst(m, "peak_hand_force", max), True),
    ("instrument exchanges", "{}", lambda m: m["instrument_exchanges"], None),
    ("residual stenosis [%]", "{:.0f}", lambda m: scaled(lesion(m, "after", "stenosis"), 100), True),
    ("lesion covered by the stent [%]", "{:.0f}", lambda m: scaled(lesion(m, "after", "coverage"), 100), False),
    ("stent off the lesion's middle [mm]", "{:.1f}",
     lambda m: scaled(magnitude(lesion(m, "after", "placement_error")), 1e3), True),
    ("errors", "{}", lambda m: len(m["errors"]), True),
]


def scaled(value, factor):
    """None stays None."""
    return None if value is None else factor * value


def magnitude(value):
    """None stays None."""
    return None if value is None else abs(value)


def table(sessions):
    """Rows of (what, texts, index of the best one or None)."""
    rows = []
    for what, form, take, less in ROWS:
        values = [take(metrics) for metrics in sessions]
        if all(value is None for value in values):
            continue
        texts = ["-" if value is None else form.format(value) for value in values]
        numbers = [value for value in values if isinstance(value, (int, float))]
        best = None
        if less is not None and len(set(texts)) > 1 and numbers:
            best = values.index(min(numbers) if less else max(numbers))
        rows.append((what, texts, best))
    return rows


def page(names, rows):
    """The table as HTML."""
    head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
    body = ""
    for what, texts, best in rows:
        cells = "".join(f'<td class="{"best" if k == best else ""}">{html.escape(text)}</td>'
                        for k, text in enumerate(texts))
        body += f"<tr><th>{html.escape(what)}</th>{cells}</tr>\n"
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Sessions</title><style>\n'
            "body{font-family:sans-serif;max-width:900px;margin:2em auto}table{border-collapse:collapse}\n"
            "th,td{text-align:left;padding:4px 16px 4px 0;border-bottom:1px solid #ddd;font-weight:normal}\n"
            ".best{color:#1b7a2f;font-weight:bold}</style></head><body><h1>Sessions compared</h1>\n"
            f"<table><tr><th></th>{head}</tr>\n{body}</table>\n"
            "<p>Bold: the best of each row.</p></body></html>\n")


def main():
    """Reads, compares, writes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sessions", nargs="+", metavar="SESSION", help="folder of results, or its metrics.json")
    parser.add_argument("--out", metavar="FILE.html", help="also writes the table as a page")
    options = parser.parse_args()
    if len(options.sessions) < 2:
        parser.error("give two sessions or more")
    rows = table([read(session) for session in options.sessions])
    names = [pathlib.Path(session).name if pathlib.Path(session).is_dir() else session
             for session in options.sessions]
    width = max(len(what) for what, _, _ in rows) + 2
    columns = [max(len(name), 12) + 2 for name in names]
    print(" " * width + "".join(name.rjust(column) for name, column in zip(names, columns)))
    for what, texts, best in rows:
        marked = [text + ("*" if k == best else " ") for k, text in enumerate(texts)]
        print(what.ljust(width) + "".join(text.rjust(column) for text, column in zip(marked, columns)))
    print("* the best")
    if options.out:
        pathlib.Path(options.out).write_text(page(names, rows), encoding="utf-8")


if __name__ == "__main__":
    main()
