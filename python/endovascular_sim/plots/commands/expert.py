"""Recording of the expert's run of a lesson. It is made at first use and cached, by the scene and the program, below
ROS_HOME/endovascular_sim/experts (~/.ros). Prints its folder, which holds metrics.json and metrics.html.

The expert is the scripted operator of the lesson's procedure (docs/PROCEDURES.md), offline."""

import hashlib
import os
import pathlib
import shutil
import tempfile

from .. import command

EXIT_CODES = "Exit code: 0 the recording exists; 1 the run failed; 2 wrong arguments."


def expert_overrides(scene):
    """Overrides of the scene: the scripted operator drives all instruments of the lesson."""
    import yaml
    scene = yaml.safe_load(scene.read_text(encoding="utf-8"))
    count = len(scene.get("instruments", [])) or 1
    prefixes = ["instruments.%d." % k for k in range(count)] if "instruments" in scene else [""]
    return ["procedure.guided=false"] + [prefix + "drive.source=procedure" for prefix in prefixes]


def key_of(scene, overrides, simulate):
    """Hash of the scene with its files, its overrides, and of the program."""
    digest = hashlib.sha256("\n".join(overrides).encode())
    folder = scene.parent.parent
    for path in [scene, *sorted(folder.glob("procedures/*.yaml")), *sorted(folder.glob("anatomies/*.yaml")),
                 *sorted(folder.glob("instruments/*.yaml"))]:
        digest.update(path.read_bytes())
    digest.update(simulate.read_bytes())
    library = simulate.parent.parent / "libendovascular_sim_core.so"
    if library.exists():
        digest.update(library.read_bytes())
    return digest.hexdigest()[:16]


def record(scene, overrides, folder):
    """Runs the expert into a folder, which appears complete or not at all. It holds the state at each step's beginning."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as made:
        command.simulate(scene, made + "/run", expert_overrides(scene) + overrides, "--seconds", "600", "--save-steps",
                         made + "/run/steps")
        try:
            os.rename(made + "/run", folder)
        except OSError:
            if not folder.exists():  # another lesson has made it meanwhile
                raise


def add_arguments(parser):
    parser.add_argument("scene", type=pathlib.Path, help="scene of a lesson, e.g. config/scenes/lesson_bifurcation.yaml")
    parser.add_argument("--cache", type=pathlib.Path, help="folder of the recordings",
                        default=pathlib.Path(os.environ.get("ROS_HOME", os.path.expanduser("~/.ros")), "endovascular_sim", "experts"))
    parser.add_argument("--again", action="store_true", help="replace a recording that exists")
    parser.add_argument("--step", type=int, help="print the saved state at the beginning of this step instead, from 1")
    command.add_overrides(parser)


def state_of(folder, step):
    """Path of the state at the beginning of a step. Raises Failure for a step that the expert does not have."""
    states = sorted(folder.glob("steps/step_*.state"))
    state = folder / "steps" / ("step_%02d.state" % step)
    if state not in states:
        raise command.Failure("--step %d: the expert has the steps 1 to %d" % (step, len(states)))
    return state


def run(options):
    """Finds or makes the recording."""
    scene = options.scene.resolve()
    key = key_of(scene, options.overrides, command.programs_folder() / "simulate")
    folder = options.cache / ("%s-%s" % (scene.stem, key))
    if options.again and folder.exists():
        shutil.rmtree(folder)
    if not (folder / "metrics.json").exists():
        record(scene, options.overrides, folder)
    print(folder if options.step is None else state_of(folder, options.step))
