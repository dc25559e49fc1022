"""Compares the metrics of two or more sessions in a table on the terminal and, with --out, in a self-contained page."""

import html
import pathlib

from .. import tables
from ..command import Failure


def read(session):
    """Metrics of a results folder or of a metrics.json."""
    path = pathlib.Path(session)
    path = path / "metrics.json" if path.is_dir() else path
    try:
        return tables.read_json(path)
    except OSError as error:
        raise Failure(f"{path}: {error.strerror}; give a folder with a metrics.json") from error
    except ValueError as error:
        raise Failure(f"{path}: not a metrics.json: {error}") from error


def get(metrics, *keys):
    """Value under nested keys; None if one is missing."""
    for key in keys:
        if metrics is None:
            return None
        metrics = metrics.get(key)
    return metrics


def total(metrics, key):
    """Sum of a quantity over the instruments."""
    return sum(one.get(key) or 0 for one in metrics["instruments"])


def worst(metrics, key, pick):
    """Extreme of a quantity over the instruments that moved."""
    values = [one[key] for one in metrics["instruments"] if one.get("tip_path")]
    return pick(values) if values else None


def lesion(metrics, *keys):
    """Value of the first lesion."""
    return get(metrics["lesions"][0], *keys) if metrics.get("lesions") else None


def retries(step):
    """Number of retries of a step, also in metrics of version 0.1, which name them `new_tries`."""
    return step.get("retries", step.get("new_tries"))


# Label, format, function of the metrics, less is better (None: not comparable).
ROWS = [
    ("outcome", "{}", lambda m: m.get("outcome"), None),
    ("procedure time [s]", "{:.1f}", lambda m: m["procedure_time"], True),
    ("fluoroscopy time [s]", "{:.1f}", lambda m: m["fluoroscopy_time"], True),
    ("retries", "{}", lambda m: sum(retries(step) for step in m["steps"]), True),
    ("tip path of all instruments [mm]", "{:.0f}", lambda m: 1e3 * total(m, "tip_path"), True),
    ("smoothness, worst instrument (SPARC)", "{:.2f}", lambda m: worst(m, "spectral_arc_length", min), False),
    ("wrong branches entered", "{}", lambda m: len(m["wrong_branches"]), True),
    ("time in wrong branches [s]", "{:.1f}", lambda m: total(m, "wrong_branch_time"), True),
    ("largest force of one contact [N]", "{:.2f}", lambda m: get(m, "wall_forces", "peak"), True),
    ("  in", "{}", lambda m: get(m, "wall_forces", "peak_region"), None),
    ("integral of the wall forces [N s]", "{:.1f}", lambda m: get(m, "wall_forces", "integral"), True),
    ("largest force at a hand [N]", "{:.2f}", lambda m: worst(m, "peak_hand_force", max), True),
    ("instrument exchanges", "{}", lambda m: m["instrument_exchanges"], None),
    ("residual stenosis [%]", "{:.0f}", lambda m: scaled(lesion(m, "after", "stenosis"), 100), True),
    ("lesion covered by the stent [%]", "{:.0f}", lambda m: scaled(lesion(m, "after", "coverage"), 100), False),
    ("offset of the stent from the lesion's centre [mm]", "{:.1f}",
     lambda m: scaled(magnitude(lesion(m, "after", "placement_error")), 1e3), True),
    ("errors", "{}", lambda m: len(m["errors"]), True),
]


def scaled(value, factor):
    """Product of a value and a factor; None remains None."""
    return None if value is None else factor * value


def magnitude(value):
    """Absolute value; None remains None."""
    return None if value is None else abs(value)


def is_finished(metrics):
    """True for a session whose procedure is done; also for one without a procedure."""
    return metrics.get("outcome", "done") == "done" and metrics.get("failure") is None


def table(sessions):
    """Rows of (label, texts, index of the best one or None). Only finished sessions can be the best."""
    rows = []
    for label, form, take, less in ROWS:
        values = [take(metrics) for metrics in sessions]
        if all(value is None for value in values):
            continue
        texts = ["-" if value is None else form.format(value) for value in values]
        numbers = {k: value for k, value in enumerate(values)
                   if isinstance(value, (int, float)) and is_finished(sessions[k])}
        best = None
        if less is not None and len(numbers) > 1 and len({texts[k] for k in numbers}) > 1:
            best = (min if less else max)(numbers, key=numbers.get)
        rows.append((label, texts, best))
    return rows


def page(names, rows):
    """Table as HTML."""
    head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
    body = ""
    for label, texts, best in rows:
        cells = "".join(f'<td class="{"best" if k == best else ""}">{html.escape(text)}</td>'
                        for k, text in enumerate(texts))
        body += f"<tr><th>{html.escape(label)}</th>{cells}</tr>\n"
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Sessions</title><style>\n'
            "body{font-family:sans-serif;max-width:900px;margin:2em auto}table{border-collapse:collapse}\n"
            "th,td{text-align:left;padding:4px 16px 4px 0;border-bottom:1px solid #ddd;font-weight:normal}\n"
            ".best{color:#1b7a2f;font-weight:bold}</style></head><body><h1>Sessions compared</h1>\n"
            f"<table><tr><th></th>{head}</tr>\n{body}</table>\n"
            "<p>Bold: best of the finished sessions in the row.</p></body></html>\n")


def add_arguments(parser):
    parser.add_argument("first", metavar="SESSION", help="results folder, or its metrics.json")
    parser.add_argument("others", metavar="SESSION", nargs="+", help="further ones")
    parser.add_argument("--out", metavar="FILE.html", help="also writes the table as an HTML page")


def run(options):
    """Reads the metrics, prints the table and writes the page."""
    sessions = [options.first, *options.others]
    rows = table([read(session) for session in sessions])
    names = [pathlib.Path(session).name if pathlib.Path(session).is_dir() else session for session in sessions]
    width = max(len(label) for label, _, _ in rows) + 2
    columns = [max(len(name), 12) + 2 for name in names]
    print(" " * width + "".join(name.rjust(column) for name, column in zip(names, columns)))
    for label, texts, best in rows:
        marked = [text + ("*" if k == best else " ") for k, text in enumerate(texts)]
        print(label.ljust(width) + "".join(text.rjust(column) for text, column in zip(marked, columns)))
    print("*: best of the finished sessions in the row")
    if options.out:
        pathlib.Path(options.out).write_text(page(names, rows), encoding="utf-8")
