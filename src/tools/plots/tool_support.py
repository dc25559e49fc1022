"""Parts that the Python tools share: arguments, messages, CSV files, programs and scenes."""

import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys


def name():
    """Name of the running tool."""
    return os.path.basename(sys.argv[0])


def fail(message):
    """Ends the program with a message for the user and exit code 1."""
    sys.exit("%s: %s" % (name(), message))


def warn(message):
    """Prints a message for the user on the error stream."""
    print("%s: %s" % (name(), message), file=sys.stderr)


def programs_folder():
    """Folder of the C++ programs: ENDOVASCULAR_PROGRAMS, else the folder of the running tool."""
    return pathlib.Path(os.environ.get("ENDOVASCULAR_PROGRAMS", pathlib.Path(sys.argv[0]).resolve().parent))


def version():
    """Version, commit and number of the physics as printed by the C++ programs; without them, the version only."""
    try:
        line = subprocess.run([str(programs_folder() / "scene_check"), "--version"], stdout=subprocess.PIPE, check=True,
                              universal_newlines=True).stdout
        return line.split(" ", 1)[1].strip()
    except (OSError, subprocess.CalledProcessError, IndexError):
        pass
    for folder in pathlib.Path(__file__).resolve().parents:
        for package in (folder / "package.xml", folder / "share" / "endovascular_sim" / "package.xml"):
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


def argument_parser(description, exit_codes="Exit code: 0 success; 1 failure (the reason is on the error stream); 2 "
                                            "wrong arguments."):
    """Parser with --help and --version."""
    parser = _Parser(description=description, epilog=exit_codes, add_help=False)
    parser.add_argument("-h", "--help", action="help", help="prints this text")
    parser.add_argument("--version", action=_PrintVersion)
    return parser


def read_rows(path):
    """Rows of a CSV file as dictionaries of texts, one by one."""
    with open(path, newline="", encoding="utf-8") as stream:
        yield from csv.DictReader(stream)


def read_json(path):
    """Content of a JSON file."""
    with open(path, encoding="utf-8") as stream:
        return json.load(stream)


def pyplot():
    """matplotlib.pyplot for drawing into files."""
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot as plt
        return plt
    except ImportError as error:
        return fail("%s; install the Debian package python3-matplotlib and run with /usr/bin/python3" % error)


def find_scene(file):
    """A scene of the package, in the source tree or where the package is installed."""
    for config in (pathlib.Path(__file__).resolve().parents[3] / "config",
                   programs_folder().parents[1] / "share" / "endovascular_sim" / "config"):
        if (config / "scenes" / file).exists():
            return config / "scenes" / file
    return fail("config/scenes/%s not found in the source tree or the installation" % file)


def simulate(scene, folder, overrides, *arguments):
    """Runs `simulate` without plots and messages; returns the finished process with its error stream."""
    program = programs_folder() / "simulate"
    if not os.access(program, os.X_OK):
        fail("no program simulate in %s; set ENDOVASCULAR_PROGRAMS to its folder" % program.parent)
    command = [str(program), str(scene), "--out", str(folder), "--no-plots", "--quiet", *arguments]
    for override in overrides:
        command += ["--set", override]
    return subprocess.run(command, stderr=subprocess.PIPE, universal_newlines=True, check=False)
