"""Parts that the commands share: arguments, failures, programs and scenes."""

import argparse
import os
import pathlib
import re
import subprocess
import sys

EXIT_CODES = "Exit code: 0 success; 1 failure (the reason is on the error stream); 2 wrong arguments."
_HERE = pathlib.Path(__file__)


class Failure(Exception):
    """Ends a command with a message for the user and exit code 1."""


def warn(message):
    """Prints a message for the user on the error stream."""
    print("plots: %s" % message, file=sys.stderr)


def programs_folder():
    """Folder of the C++ programs: ENDOVASCULAR_PROGRAMS, else that of the package's workspace or installation."""
    if "ENDOVASCULAR_PROGRAMS" in os.environ:
        return pathlib.Path(os.environ["ENDOVASCULAR_PROGRAMS"])
    beside = _HERE.parents[4] / "endovascular_sim"  # PREFIX/lib/python3/dist-packages/endovascular_sim/plots/command.py
    return beside if (beside / "simulate").exists() else _repository() / "catkin_ws" / "devel" / "lib" / "endovascular_sim"


def _repository():
    return _HERE.resolve().parents[3]


def version():
    """Version, commit and number of the physics as printed by the C++ programs; without them, the version only."""
    try:
        line = subprocess.run([str(programs_folder() / "scene_check"), "--version"], stdout=subprocess.PIPE, check=True,
                              universal_newlines=True).stdout
        return line.split(" ", 1)[1].strip()
    except (OSError, subprocess.CalledProcessError, IndexError):
        pass
    for package in (_repository() / "package.xml", programs_folder().parents[1] / "share/endovascular_sim/package.xml"):
        if package.exists():
            found = re.search(r"<version>(.*)</version>", package.read_text(encoding="utf-8"))
            return (found.group(1) if found else "unknown") + ", commit unknown"
    return "unknown"


class _PrintVersion(argparse.Action):
    """Option --version, evaluated only on request: it runs a program."""

    def __init__(self, option_strings, dest):
        super().__init__(option_strings, dest, nargs=0, default=argparse.SUPPRESS,
                         help="prints version, commit and number of the physics")

    def __call__(self, parser, namespace, values, option_string=None):
        print("%s %s" % (parser.prog, version()))
        parser.exit()


class _Parser(argparse.ArgumentParser):
    """Parser with the messages of the C++ tools: wrong arguments end with exit code 2 and a hint to --help."""

    def error(self, message):
        self.exit(2, "%s: %s\n'%s --help' lists the arguments.\n" % (self.prog, message, self.prog))


def argument_parser(name, description, exit_codes=EXIT_CODES):
    """Parser with --help and --version."""
    parser = _Parser(prog=name, description=description, epilog=exit_codes, add_help=False)
    parser.add_argument("-h", "--help", action="help", help="prints this text")
    parser.add_argument("--version", action=_PrintVersion)
    return parser


def add_overrides(parser):
    """Option --set of commands that run scenes."""
    parser.add_argument("--set", action="append", default=[], dest="overrides", metavar="KEY=VALUE",
                        help="replaces a value of the scene in every run; may be repeated")


def find_scene(file):
    """A scene of the package, in the source tree or where the package is installed."""
    for config in (_repository() / "config", programs_folder().parents[1] / "share" / "endovascular_sim" / "config"):
        if (config / "scenes" / file).exists():
            return config / "scenes" / file
    raise Failure("config/scenes/%s not found in the source tree or the installation" % file)


def simulate(scene, folder, overrides, *arguments, accepted=(0,)):
    """Runs `simulate` into a folder, without plots and messages. Exit codes that are not accepted end the command."""
    program = programs_folder() / "simulate"
    if not os.access(program, os.X_OK):
        raise Failure("no program simulate in %s; build the workspace, or set ENDOVASCULAR_PROGRAMS to its folder"
                      % program.parent)
    words = [str(program), str(scene), "--out", str(folder), "--no-plots", "--quiet", *arguments]
    for override in overrides:
        words += ["--set", override]
    done = subprocess.run(words, stderr=subprocess.PIPE, universal_newlines=True, check=False)
    if done.returncode not in accepted:
        raise Failure("simulate failed on %s:\n%s" % (scene, done.stderr[-2000:]))
