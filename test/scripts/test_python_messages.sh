#!/bin/bash
# Python imports every message and service of this package, with the packages of catkin_ws/packages.txt alone: each imported
# module of a Debian package belongs to one of them or to their dependencies, without recommended packages.
set -eu
repository=$(cd "$(dirname "$0")/../.." && pwd)
. "$repository/test/scripts/graph_environment.sh"
exec /usr/bin/python3 - "$repository" <<'PYTHON'
import glob, importlib, os, re, subprocess, sys
repository = sys.argv[1]


def names(folder, extension):
    """Names of the definitions in a folder."""
    return sorted(os.path.splitext(os.path.basename(path))[0] for path in glob.glob("%s/%s/*.%s" % (repository, folder, extension)))


def closure(packages):
    """Names of packages with all that they depend on, virtual packages included."""
    text = subprocess.run(["apt-cache", "depends", "--recurse", "--no-recommends", "--no-suggests", "--no-conflicts",
                           "--no-breaks", "--no-replaces", "--no-enhances", *packages],
                          check=True, capture_output=True, text=True).stdout
    return {re.sub(r"[<>]|:\w+$", "", line.split()[-1]) for line in text.splitlines()}


def package_of(path):
    """Debian package that owns a file; an empty string for none."""
    owner = subprocess.run(["dpkg", "-S", path], capture_output=True, text=True)
    return owner.stdout.split(":")[0] if owner.returncode == 0 else ""


messages, services = names("msg", "msg"), names("srv", "srv")
before = set(sys.modules)
for module, wanted in (("msg", messages), ("srv", services)):
    package = importlib.import_module("endovascular_sim." + module)
    for name in wanted:
        getattr(package, name)()
print("%d messages and %d services imported" % (len(messages), len(services)))

listed = [re.sub(r"#.*|\s", "", line) for line in open(repository + "/catkin_ws/packages.txt")]
available = closure([name for name in listed if name])
missing = {}
for name in set(sys.modules) - before:
    path = getattr(sys.modules[name], "__file__", None)
    if path and path.startswith("/usr/lib/python3/"):
        owner = package_of(path)
        if owner and owner not in available:
            missing.setdefault(owner, []).append(name)
for owner, modules in sorted(missing.items()):
    print("packages.txt lacks %s, which holds %s" % (owner, ", ".join(sorted(modules))))
sys.exit(bool(missing))
PYTHON
