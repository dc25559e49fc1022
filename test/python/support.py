"""Parts that the tests of the Python package share."""

import functools
import os
import pathlib
import subprocess
import sys
import tempfile

import endovascular_sim as evs

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(os.environ.get("ENDOVASCULAR_PROGRAMS", REPOSITORY / "catkin_ws/devel/lib/endovascular_sim"))

# Tube with a scripted operator: the wire is pushed, then turned.
PROCEDURE = """
duration: 2
vessel: {friction: 0.1, tube: {radius: 0.004, pieces: [{length: 0.05}, {length: 0.05, curvature: 20}]}}
entry: {position: [0, 0, 0], direction: [0, 0, 1], up: [1, 0, 0]}
instruments:
  - {instrument: {use: guidewire_035_j, name: wire}, drive: {source: procedure, initial_insertion: 0.03}}
procedure:
  steps:
    - {phase: First, advance: wire, until: {insertion: 0.06}, speed: 0.05}
    - {phase: Second, rotate: wire, until: {turned: 1.0}}
"""


@functools.lru_cache(maxsize=None)
def tube():
    """Bundled scene of a wire in a tube, shared by all tests."""
    return evs.World("tube")


def hash_of_simulate(scene, *arguments):
    """Trajectory hash of a run of `simulate`."""
    with tempfile.TemporaryDirectory() as folder:
        output = subprocess.run([str(PROGRAMS / "simulate"), str(scene), "--no-plots", "--out", folder, *arguments],
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, text=True).stdout
    return output.split('"trajectory_hash": "')[1].split('"')[0]


def run_python(code, *arguments, **options):
    """A program in a Python process of its own; returns the finished process with its outputs as texts."""
    return subprocess.run([sys.executable, "-c", code, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, timeout=120, check=False, **options)
