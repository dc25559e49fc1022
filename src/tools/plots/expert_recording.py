#!/usr/bin/python3
"""Recording of the expert's run of a lesson. It is made at first use and cached, by the scene and the program, below
ROS_HOME/endovascular_sim/experts (~/.ros). Prints its folder, which holds metrics.json and metrics.html.

The expert is the scripted operator of the lesson's procedure (docs/PROCEDURES.md), offline."""

import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import tool_support as tools  # noqa: E402


def expert_overrides(scene):
    """Overrides of the scene: the scripted operator drives all instruments of the lesson."""
    count = len(scene.get("instruments", [])) or 1
    prefixes = ["instruments.%d." % k for k in range(count)] if "instruments" in scene else [""]
    return ["procedure.guided=false"] + [prefix + "drive.source=procedure" for prefix in prefixes]


def key_of(scene, simulate):
    """Hash of the scene with its files, and of the program."""
    digest = hashlib.sha256()
    folder = scene.parent.parent
    for path in [scene, *sorted(folder.glob("procedures/*.yaml")), *sorted(folder.glob("anatomies/*.yaml")),
                 *sorted(folder.glob("instruments/*.yaml"))]:
        digest.update(path.read_bytes())
    digest.update(simulate.read_bytes())
    library = simulate.parent.parent / "libendovascular_sim_core.so"
    if library.exists():
        digest.update(library.read_bytes())
    return digest.hexdigest()[:16]


def record(scene, simulate, folder):
    """Runs the expert into a folder, which appears complete or not at all."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as made:
        command = [str(simulate), str(scene), "--no-plots", "--quiet", "--seconds", "600", "--out", made + "/run"]
        for override in expert_overrides(yaml.safe_load(scene.read_text())):
            command += ["--set", override]
        run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        if run.returncode != 0:
            tools.fail("the expert's run of %s failed:\n%s" % (scene, run.stdout[-2000:]))
        try:
            os.rename(made + "/run", folder)
        except OSError:
            if not folder.exists():  # another lesson has made it meanwhile
                raise


def main():
    """Finds or makes the recording."""
    parser = tools.argument_parser(__doc__, "Exit code: 0 the recording exists; 1 the run failed; 2 wrong arguments.")
    parser.add_argument("scene", help="scene of a lesson, e.g. config/scenes/lesson_bifurcation.yaml")
    parser.add_argument("--cache", help="folder of the recordings")
    parser.add_argument("--again", action="store_true", help="replace a recording that exists")
    arguments = parser.parse_args([one for one in sys.argv[1:] if not one.startswith("__")])  # of roslaunch
    scene = pathlib.Path(arguments.scene).resolve()
    if not scene.is_file():
        tools.fail("%s: no such file" % scene)
    simulate = tools.programs_folder() / "simulate"
    if not simulate.is_file():
        tools.fail("%s is missing; build the workspace, and run this program by rosrun" % simulate)
    cache = pathlib.Path(arguments.cache or
                         os.path.join(os.environ.get("ROS_HOME", os.path.expanduser("~/.ros")), "endovascular_sim", "experts"))
    folder = cache / ("%s-%s" % (scene.stem, key_of(scene, simulate)))
    if arguments.again and folder.exists():
        shutil.rmtree(folder)
    if not (folder / "metrics.json").exists():
        record(scene, simulate, folder)
    print(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
