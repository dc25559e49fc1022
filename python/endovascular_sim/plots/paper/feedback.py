"""Fig. 10: force feedback over the insertion, by `benchmark hand_force`."""

import subprocess

from .. import command, style, tables
from ..commands import benchmark
from .row import Measurement

# Verdicts on the orderings that follow from the balance of forces (docs/validation/tables.md): with the default scheme, by the force at
# the hand.
EXPECTED = ["alike", "yes", "no", "no", "alike", "alike", "no", "no", "no", "alike", "alike", "alike"]
WORDS = {"yes": "as in the paper", "alike": "equal within 5 %", "no": "opposite or mixed", "–": "ended"}


def run_study(study, folder):
    """Runs a study of `benchmark` in its quick form into a folder."""
    program = command.programs_folder() / "benchmark"
    done = subprocess.run([str(program), study, "--quick", "--out", str(folder)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          universal_newlines=True, check=False)
    if done.returncode != 0:
        raise command.Failure("benchmark %s failed:\n%s" % (study, done.stdout[-2000:]))


def charts(folder):
    """The four charts, their orderings, and those by the impulse force with the scheme of the paper."""
    results = folder / "fig10"
    run_study("hand_force", results)
    style.save(benchmark.hand_force(tables.read(results / "hand_force_curves.csv")), folder / "fig10.png")
    orderings = tables.read(results / "hand_force_orderings.csv")
    made = []
    for panel, claim, values, verdict, expected in zip(*(orderings[key] for key in (
            "panel", "the paper", "measured, lowest to highest as the paper has it", "holds")), EXPECTED):
        made.append(Measurement("%s: %s" % (panel, claim), "yes", "%s: %s" % (WORDS[verdict], values), WORDS[expected], verdict == expected,
                                verdict == "yes"))
    impulse = tables.read(results / "hand_force_impulse_orderings.csv")
    for (step,), rows in tables.groups(impulse, "time step [ms]"):
        found = list(rows["holds"])
        text = "; ".join("%s: %d" % (WORDS[word], found.count(word)) for word in WORDS if word in found)
        made.append(Measurement("scheme paper, impulse force, Δt = %g ms: 12 orderings" % step, "12 as in the paper", text, "–", None,
                                found.count("yes") == len(found)))
    return made
