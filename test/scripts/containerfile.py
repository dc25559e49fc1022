"""Steps of a Containerfile, for a check without docker.

    containerfile.py FILE     one step a line: instruction, tab, arguments; continued lines are joined
"""
import json
import sys

KNOWN = {"FROM", "COPY", "RUN", "USER", "WORKDIR", "ENV", "ENTRYPOINT", "CMD"}


def steps(text):
    """Pairs of instruction and arguments. Raises ValueError for what this reader does not know."""
    joined = ""
    for line in text.splitlines():
        if line.lstrip().startswith("#") or not line.strip() and not joined:
            continue
        if line.endswith("\\"):
            joined += line[:-1] + " "
            continue
        name, _, arguments = (joined + line).strip().partition(" ")
        joined = ""
        if name not in KNOWN:
            raise ValueError("the instruction %s is not known here" % name)
        if name in ("ENTRYPOINT", "CMD"):
            arguments = " ".join(json.loads(arguments))
        yield name, " ".join(arguments.split())
    if joined:
        raise ValueError("the last line is continued")


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        for step in steps(file.read()):
            print("\t".join(step))
