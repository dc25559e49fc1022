"""Fig. 7 and 9: tips in a vessel, and the coronary intervention."""

import argparse

from .. import command, style, tables
from ..commands import phases, tips
from .row import Measurement, number, series

TRAVEL = 0.640                # inserted length at the end of config/scenes/tips.yaml [m]
DEEPEST = 0.1e-3              # largest accepted penetration of the wall [m]
RESIDUAL = 0.3                # largest accepted diameter stenosis after the stent [1]: usual definition of success
RECORDED = ["record.trajectory_rate=5"]


def tip_shapes(folder):
    """Fig. 7: a straight, an angled and a semicircular tip in the same vessel."""
    runs, rows = tips.compare(folder / "fig7")
    style.save(tips.draw(runs, rows), folder / "fig7.png")
    lengths = [row["inserted_length"] for row in rows]
    depths = [row["worst_surface_penetration"] for row in rows]
    outside = sum(row["nodes_outside"] for row in rows)
    branches = [(row["branch"] or "none").replace("_", " ") for row in rows]
    names = ", ".join(row["tip"] for row in rows)
    reached = min(lengths) > TRAVEL - 1e-3
    return [Measurement("inserted length [mm]: %s" % names, "inserted", series([1e3 * one for one in lengths]), "%g" % (1e3 * TRAVEL),
                        reached, reached),
            Measurement("vessel of the tip at the end", "–", ", ".join(branches), "two different ones", len(set(branches)) > 1),
            Measurement("nodes outside of the vessel", "0", str(outside), "0", outside == 0, outside == 0),
            Measurement("largest penetration of the wall [mm]", "–", number(1e3 * max(depths), 2), "≤ %g" % (1e3 * DEEPEST),
                        max(depths) <= DEEPEST)]


def intervention(folder):
    """Fig. 9: wire, catheter, soft wire, stent and balloon from the groin to a coronary stenosis."""
    results = folder / "fig9"
    command.simulate(command.find_scene("pci.yaml"), results, RECORDED, "--record", "nodes", "--pictures")
    parser = argparse.ArgumentParser()
    phases.add_arguments(parser)
    phases.run(parser.parse_args([str(results), "--out", str(folder / "fig9.png")]))
    metrics, result = tables.read_json(results / "metrics.json"), tables.read_json(results / "result.json")
    done = sum(step["outcome"] == "done" for step in metrics["steps"])
    [lesion] = metrics["lesions"]
    before, after = lesion["before"]["stenosis"], lesion["after"]["stenosis"]
    outside, depth = result["nodes_outside"], result["worst_surface_penetration"]
    return [Measurement("completed steps of the procedure", "all", "%d of %d" % (done, len(metrics["steps"])), "all",
                        done == len(metrics["steps"]), done == len(metrics["steps"])),
            Measurement("diameter stenosis before and after the stent [%]", "stent placed", series([100 * before, 100 * after]),
                        "after ≤ %g" % (100 * RESIDUAL), after <= RESIDUAL, after <= RESIDUAL),
            Measurement("nodes outside of the vessel", "–", str(outside), "0", outside == 0),
            Measurement("largest penetration of the wall [mm]", "–", number(1e3 * depth, 2), "≤ %g" % (1e3 * DEEPEST), depth <= DEEPEST),
            Measurement("duration of the procedure [s]", "–", number(metrics["procedure_time"]))]
