"""Prints a summary of a session from its results folder and writes report.html there.

A session is complete if it has steps, all of them are in the recording, and no message was lost.
"""

import glob
import html
import os
import pathlib
import resource

from .. import tables
from ..command import Failure, warn

EXIT_CODES = ("Exit code: 0 the session is complete; 1 it is not, or the results cannot be read; 2 wrong arguments.")


def number(value, form, unit="", scale=1.0):
    """Text of a number; None is shown as "not known"."""
    return form % (scale * value) + unit if isinstance(value, (int, float)) else "not known"


def penetration(report):
    """Worst surface penetration published in /diagnostics [m]; None without one."""
    for values in report.get("diagnostics", {}).values():
        for key, value in values.items():
            if "penetration" in key and isinstance(value, (int, float)):
                return value
    return None


def peak_hand_force(report, metrics):
    """Largest force on a hand [N]: that of the metrics, which leave out faults of the simulator; without metrics, that of
    all steps."""
    if metrics:
        return max((one["peak_hand_force"] for one in metrics["instruments"]), default=None)
    return report["hand_force"]["max"]


def summary_rows(report, metrics, device, folder):
    """Pairs of label and text of the summary."""
    recording = report["recording"]
    rows = [
        ("scene", "%s, hash %s" % (report["scene"]["name"], report["scene"]["hash"])),
        ("steps", "%d of %s ms, %s simulated" % (report["steps"], number(report["scene"]["dt"], "%g", "", 1e3),
                                                 number(report["simulated_time"], "%.3f", " s"))),
        ("steps on time", number(report["on_time_percent"], "%.2f", " %")),
        ("processor time of a step", step_costs(report) or "not known"),
        ("real-time factor", number(report["real_time_factor"], "%.3f")),
        ("wire inside", number(report["inserted_length"], "%.1f", " mm", 1e3)),
        ("force at the hand, max", number(peak_hand_force(report, metrics), "%.3f", " N")),
        ("worst penetration", number(penetration(report), "%.3f", " mm", 1e3)),
    ]
    wall = report.get("wall_forces")
    if wall:
        region = " in %s" % wall["peak_region"] if wall.get("peak_region") else ""
        rows.append(("largest force on the wall", number(wall["peak"], "%.3f", " N") + region))
        rows.append(("more than %s at one contact" % number(wall["threshold"], "%g", " N"),
                     number(wall["time_over_threshold"], "%.3f", " s")))
    if device:
        latency = device.get("motion_to_force_ms") or {}
        rows.append(("motion to force at the device", "median %s, p99 %s" % (
            number(latency.get("median"), "%.2f", " ms"), number(latency.get("p99"), "%.2f", " ms"))))
    pictures = len(glob.glob(os.path.join(folder, "fluoroscopy", "*.png")))
    rows += [
        ("fluoroscopy", "%d frames, %d saved as PNG" % (report["fluoroscopy"]["frames"], pictures)),
        ("recording", "%s, %.1f MB, %d messages" % (os.path.basename(recording["file"]), recording["bytes"] / 1e6,
                                                    recording["messages"])),
    ]
    return rows


def loop_values(report, prefix):
    """Values of the diagnostics of rod_dynamics whose key begins with a prefix: name without it and unit, to number."""
    values = report.get("diagnostics", {}).get("rod_dynamics", {})
    return {key[len(prefix):].split(" [")[0]: value for key, value in values.items()
            if key.startswith(prefix) and isinstance(value, (int, float))}


def step_costs(report):
    """Text of the processor time of a step by phase; None without it."""
    costs = loop_values(report, "processor time, ")
    contact = report.get("diagnostics", {}).get("contact", {}).get("processor time, detection [us]")
    if isinstance(contact, (int, float)):
        costs["detection"] = contact
    return ", ".join("%s %.0f" % pair for pair in costs.items() if pair[1] >= 0.5) + " us" if costs else None


def causes_of_delay(report):
    """Text of the causes of late steps, the most frequent first; empty without them."""
    late = sorted(loop_values(report, "late steps, ").items(), key=lambda pair: -pair[1])
    total = sum(count for _, count in late)
    return ", ".join("%s %.0f %%" % (name, 100.0 * count / total) for name, count in late if count > 0.05 * total) \
        if total > 0 else ""


def lateness(report, processor):
    """Remark on late steps: how many, their causes, and who used the processors. Other programs are named only if they
    used more than 2 % of the processors' time, the host only if it withdrew more than 0.1 s and 0.2 %. None if at least
    99 % of the steps were on time."""
    on_time = report["on_time_percent"]
    if not isinstance(on_time, (int, float)) or on_time >= 99.0:
        return None
    causes = causes_of_delay(report)
    text = "%.1f %% of the steps were late" % (100.0 - on_time) + (" (%s)" % causes if causes else "")
    if not may_run_in_real_time():
        text += "; allow real-time scheduling (docs/INSTALL.md)"
    if not processor:
        return text
    available = processor["elapsed"] * processor["processors"]
    reasons = []
    if processor["withdrawn"] > max(0.1, 0.002 * available):
        reasons.append("the host of this virtual machine withdrew %.1f s of processor time" % processor["withdrawn"])
    if processor["others"] > 0.02 * available:
        reasons.append("other programs used %.1f s of processor time (%.0f %%): end them" %
                       (processor["others"], 100.0 * processor["others"] / available))
    if not reasons:
        reasons.append("no other program used the processors: the scene needs a faster one, or a coarser sampling")
    return text + "; " + "; ".join(reasons)


def problems(report, processor=None):
    """Reasons for an incomplete session, and remarks: (fatal, remarks)."""
    fatal, remarks = [], []
    if report["steps"] == 0:
        fatal.append("no step was simulated")
    if report.get("error"):
        fatal.append(report["error"])
    if report["steps_missing_from_recording"] > 0:
        fatal.append("%d steps are missing from the recording" % report["steps_missing_from_recording"])
    if report["recording"]["error"]:
        fatal.append("the recording ended early: %s (%d messages are missing)" % (report["recording"]["error"],
                                                                                 report["recording"]["dropped"]))
    elif report["recording"]["dropped"] > 0:
        fatal.append("%d messages were lost: the disk was too slow" % report["recording"]["dropped"])
    late = lateness(report, processor)
    if late:
        remarks.append(late)
    return fatal, remarks


def may_run_in_real_time():
    """True if this account may use real-time scheduling."""
    return os.geteuid() == 0 or resource.getrlimit(resource.RLIMIT_RTPRIO)[1] != 0


def write_html(report, rows, fatal, remarks, folder):
    """Writes a page with the summary and all existing pictures."""
    title = "Session of scene %s" % report["scene"]["name"]
    lines = ["<!DOCTYPE html>", '<html lang="en"><head><meta charset="utf-8"><title>%s</title>' % html.escape(title),
             "<style>body{font-family:sans-serif;max-width:70em;margin:2em auto}td{padding:.2em 1em .2em 0}"
             "img{max-width:100%}</style></head><body>", "<h1>%s</h1>" % html.escape(title), "<table>"]
    lines += ["<tr><td>%s</td><td>%s</td></tr>" % (html.escape(label), html.escape(text)) for label, text in rows]
    lines.append("</table>")
    lines += ["<p><strong>%s</strong></p>" % html.escape(text) for text in fatal]
    lines += ["<p>%s</p>" % html.escape(text) for text in remarks]
    pictures = [name for name in ("rviz.png", "wall_forces.png", "forces.png", "tip_path.png")
                if os.path.isfile(os.path.join(folder, name))]
    frames = sorted(glob.glob(os.path.join(folder, "fluoroscopy", "*.png")))
    if frames:
        pictures.append("fluoroscopy/" + os.path.basename(frames[-1]))
    lines += ['<p><img src="%s" alt="%s"></p>' % (name, name) for name in pictures]
    lines.append("</body></html>")
    with open(os.path.join(folder, "report.html"), "w") as stream:
        stream.write("\n".join(lines) + "\n")


def add_arguments(parser):
    parser.add_argument("folder", help="results folder of the session")


def run(options):
    """Reads the reports, prints the summary and writes the page."""
    report = tables.read_json_if_any(pathlib.Path(options.folder, "report.json"))
    if report is None:
        raise Failure("%s: no readable report.json" % options.folder)
    device = tables.read_json_if_any(pathlib.Path(options.folder, "device_latency.json"))
    metrics = tables.read_json_if_any(pathlib.Path(options.folder, "metrics.json"))
    rows = summary_rows(report, metrics, device, options.folder)
    fatal, remarks = problems(report, tables.read_json_if_any(pathlib.Path(options.folder, "processor.json")))
    try:
        write_html(report, rows, fatal, remarks, options.folder)
    except OSError as error:
        warn(error)
    print("== Summary")
    for label, text in rows:
        print("   %-30s %s" % (label, text))
    print("   %-30s %s" % ("results", os.path.abspath(options.folder)))
    for text in remarks:
        print("warning: " + text)
    for text in fatal:
        print("error: " + text)
    return 1 if fatal else 0
