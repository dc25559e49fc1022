"""Table 1: computing time by the number of nodes, by `benchmark speed`."""

from .. import style, tables
from ..command import Failure
from ..commands import benchmark
from .feedback import run_study
from .row import TIME, Measurement, number, series

# Handing collision, inextensible constraints and physics computation of the paper's Table 1 [ms], and its totals with rendering.
NODES = (100, 200, 300, 380)
PAPER = (0.68 + 0.26 + 1.02, 0.92 + 0.52 + 2.13, 1.16 + 0.79 + 3.14, 1.27 + 0.99 + 3.98)
PAPER_TOTAL = (5.65, 8.34, 11.03, 13.07)


def computing_time(folder):
    """Times of a step and of a whole frame with the default scheme."""
    results = folder / "table1"
    run_study("speed", results)
    style.save(benchmark.speed(tables.read(results / "speed_growth.csv")), folder / "table1.png")
    table = tables.read(results / "speed_table.csv")
    rows = tables.select(table, table["scheme"] == "kkt")
    if tuple(rows["nodes"]) != NODES:
        raise Failure("speed_table.csv has other numbers of nodes than the paper: %s" % series(rows["nodes"]))
    steps, frames = rows["step, median"] * 1e-3, rows["whole frame"] * 1e-3  # [ms]
    names = ", ".join("%d" % nodes for nodes in NODES)
    growth = tables.read(results / "speed_growth.csv")
    exponents = growth["growth exponent"][(growth["scheme"] == "kkt") & (growth["nodes"] > 100)]
    faster = all(a < b for a, b in zip(steps, PAPER))
    linear = all(0.8 < exponent < 1.2 for exponent in exponents)
    return [Measurement("collision, constraints and physics [ms]: %s nodes" % names, series(PAPER), series(steps), "less than the paper",
                        faster, faster, TIME),
            Measurement("whole frame [ms]: %s nodes" % names, series(PAPER_TOTAL, 4), series(frames), "less than the paper",
                        all(a < b for a, b in zip(frames, PAPER_TOTAL)), all(a < b for a, b in zip(frames, PAPER_TOTAL)), TIME),
            Measurement("frames per second, 380 nodes", "75", number(1e3 / frames[-1]), "≥ 75", frames[-1] <= 1e3 / 75, True, TIME),
            Measurement("exponent of the growth with the number of nodes [1]", "1: linear", series(exponents, 2), "0.8 to 1.2", linear, linear,
                        TIME)]
