"""Pictures, tables and pages of results: plots COMMAND ARGUMENTS. `plots COMMAND --help` lists the arguments of a command."""

import importlib
import sys

from . import command

COMMANDS = {
    "results": "forces, path of the tip, forces on the wall and energy of a results folder",
    "summary": "summary of a session, and its report.html",
    "compare": "metrics of sessions side by side",
    "phases": "phases of a procedure side by side",
    "instruments": "shape and stiffness of instruments",
    "vessel": "input and result of vessel_prepare",
    "benchmark": "tables of benchmark",
    "tips": "one wire with three tips in the same vessel",
    "angles": "the published benchmark from many angles of the hand",
    "sampling": "error of the hand force by the distance of the nodes",
    "reproduce": "figures and tables of the paper",
    "expert": "recording of the expert's run of a lesson",
}


def run_command(name, program, words):
    """Runs a command under the name of a program; returns the exit code."""
    module = importlib.import_module(".commands." + name, __package__)
    parser = command.argument_parser(program, module.__doc__, getattr(module, "EXIT_CODES", command.EXIT_CODES))
    module.add_arguments(parser)
    options = parser.parse_args(words)
    try:
        return module.run(options) or 0
    except (command.Failure, ImportError, OSError, ValueError) as error:
        print("%s: %s" % (program, error), file=sys.stderr)
        return 1


def main(words=None):
    """Runs a command; returns the exit code."""
    words = sys.argv[1:] if words is None else words
    if words and words[0] in COMMANDS:
        return run_command(words[0], "plots " + words[0], words[1:])
    parser = command.argument_parser("plots", __doc__)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        commands.add_parser(name, help=summary)
    parser.parse_args(words)
    return 0


if __name__ == "__main__":
    sys.exit(main())
