"""Recording of the expert's run of a lesson. It is made at first use and cached, by the scene and the program, below
ROS_HOME/endovascular_sim/experts (~/.ros). Prints its folder, which holds session.bag, metrics.json and metrics.html.

The expert is the scripted operator of the lesson's procedure (docs/PROCEDURES.md), offline; with --from any recorded session."""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from .. import command

PROGRAM = "scripted_recording"
EXIT_CODES = "Exit code: 0 the recording exists; 1 the run failed; 2 wrong arguments."


def expert_overrides(scene):
    """Overrides of the scene: the scripted operator drives all instruments of the lesson."""
    import yaml
    scene = yaml.safe_load(scene.read_text(encoding="utf-8"))
    count = len(scene.get("instruments", [])) or 1
    prefixes = ["instruments.%d." % k for k in range(count)] if "instruments" in scene else [""]
    return ["procedure.guided=false"] + [prefix + "drive.source=procedure" for prefix in prefixes]


def key_of(scene, overrides, program):
    """Hash of the scene with its files, its overrides, and of the program."""
    digest = hashlib.sha256("\n".join(overrides).encode())
    folder = scene.parent.parent
    for path in [scene, *sorted(folder.glob("procedures/*.yaml")), *sorted(folder.glob("anatomies/*.yaml")),
                 *sorted(folder.glob("instruments/*.yaml"))]:
        digest.update(path.read_bytes())
    digest.update(program.read_bytes())
    library = program.parent.parent / "libendovascular_sim_core.so"
    if library.exists():
        digest.update(library.read_bytes())
    return digest.hexdigest()[:16]


def place(make, folder):
    """Calls make(path) and moves what it has made to a folder, which appears complete or not at all."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as made:
        make(pathlib.Path(made) / "run")
        try:
            os.rename(made + "/run", folder)
        except OSError:
            if not folder.exists():  # another lesson has made it meanwhile
                raise


def record(scene, overrides, folder):
    """Runs the scripted operator into a folder, which holds the state at each step's beginning."""
    def make(path):
        words = [str(command.programs_folder() / PROGRAM), str(scene), "--out", str(path), "--seconds", "600", "--quiet"]
        for override in expert_overrides(scene) + overrides:
            words += ["--set", override]
        done = subprocess.run(words, stderr=subprocess.PIPE, universal_newlines=True, check=False)
        if done.returncode != 0:
            raise command.Failure("%s failed on %s:\n%s" % (PROGRAM, scene, done.stderr[-2000:]))

    place(make, folder)


def name_of(scene):
    """Name of the scene of a file; that of the file without one."""
    import yaml
    return (yaml.safe_load(scene.read_text(encoding="utf-8")) or {}).get("name", scene.stem)


def take_over(results, scene, folder):
    """Makes the results of a recorded session the expert of a scene. Raises Failure for those of another scene, and without a bag."""
    for name in ("session.bag", "metrics.json", "scene.yaml"):
        if not (results / name).exists():
            raise command.Failure("--from: %s has no %s; give a folder of results of the session node, or of replay --out with its bag beside"
                                  % (results, name))
    if name_of(results / "scene.yaml") != name_of(scene):
        raise command.Failure("--from: %s is a session of %s, not of %s" % (results, name_of(results / "scene.yaml"), name_of(scene)))
    lesson = json.loads((results / "metrics.json").read_text(encoding="utf-8")).get("lesson")
    if lesson and lesson["marks"][0]["value"] > 0:
        raise command.Failure("--from: %s is not finished: %d steps are not done" % (results, lesson["marks"][0]["value"]))
    if folder.exists():
        shutil.rmtree(folder)
    place(lambda path: shutil.copytree(results, path, ignore=shutil.ignore_patterns("fluoroscopy", "run_*", "log", "ros", "device")), folder)


def announce(folder):
    """Tells the running nodes where the expert is. Raises Failure without a ROS master."""
    try:
        import rosgraph
        master = rosgraph.Master("/expert_recording")
        master.setParam("/expert_results", str(folder))
    except Exception as error:  # noqa: B902: of several modules
        raise command.Failure("--announce: no ROS master answers (%s)" % error) from error


def add_arguments(parser):
    parser.add_argument("scene", type=pathlib.Path, help="scene of a lesson, e.g. config/scenes/lesson_bifurcation.yaml")
    parser.add_argument("--cache", type=pathlib.Path, help="folder of the recordings",
                        default=pathlib.Path(os.environ.get("ROS_HOME", os.path.expanduser("~/.ros")), "endovascular_sim", "experts"))
    parser.add_argument("--again", action="store_true", help="replace a recording that exists")
    parser.add_argument("--from", type=pathlib.Path, dest="results", metavar="RESULTS",
                        help="results of a recorded session of this scene, which becomes its expert; --again returns to the scripted one")
    parser.add_argument("--announce", action="store_true", help="also sets the parameter /expert_results of the running nodes")
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
    if not scene.exists():
        raise command.Failure("%s does not exist; give the scene of a lesson" % options.scene)
    program = command.programs_folder() / PROGRAM
    if not program.exists():
        raise command.Failure("no program %s in %s; build the workspace with ROS" % (PROGRAM, program.parent))
    folder = options.cache / ("%s-%s" % (scene.stem, key_of(scene, options.overrides, program)))
    if options.results is not None:
        take_over(options.results.resolve(), scene, folder)
    if options.again and folder.exists():
        shutil.rmtree(folder)
    if not (folder / "metrics.json").exists():
        record(scene, options.overrides, folder)
    if options.announce:
        announce(folder)
    print(folder if options.step is None else state_of(folder, options.step))
