"""Runs the first command of pages of the documentation literally, but for the placeholders that a page explains. An
installation of packages is simulated by apt-get.

Arguments: REPOSITORY PAGE[#SECTION]...; exit code 1 when a command fails, or prints a warning.
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

# Words of the commands that stand for files of the user.
PLACEHOLDERS = {
    "FILE.yaml": "config/scenes/demo.yaml",
    "SCENE.yaml": "config/scenes/tube.yaml",
    "--out DIR [OPTIONS]": "--out results",
    "CT_FOLDER": "heart.vol",
    "IN --unit METRES --out OUT.obj [options]": "tube.obj --unit 1 --out prepared.obj",
}
DOUBT = re.compile(r"\bwarn(ing)?\b", re.IGNORECASE)
STARTED = {"roslaunch": 25.0}  # seconds for which a program that a person ends is observed


def first_command(page, section):
    """First indented line of a section, or of the page, that begins with a program of the project or of Debian."""
    text = page.read_text()
    if section:
        text = text[text.index("\n## %s\n" % section):]
    for line in text.splitlines():
        if re.match(r"    (rosrun|roslaunch|catkin_ws/|sudo apt-get) ?", line):
            return re.sub(r"\s+#.*", "", line).strip()
    raise AssertionError("%s %s has no command" % (page, section))


def prepare(folder, repository):
    """A working folder in which the relative paths of the pages hold, and the inputs of the placeholders."""
    for name in ("config", "catkin_ws", "docs", "launch"):
        (folder / name).symlink_to(repository / name)
    run(folder, "rosrun endovascular_sim simulate config/scenes/tube.yaml --seconds 0.01 --record nodes --no-plots --quiet "
                "--out made")
    shutil.copy(folder / "made/vessel.obj", folder / "tube.obj")
    with open(folder / "tube.obj") as metres, open(folder / "vessel.obj", "w") as millimetres:
        for line in metres:
            words = line.split()
            if words and words[0] == "v":
                line = "v %s\n" % " ".join(repr(1e3 * float(word)) for word in words[1:])
            millimetres.write(line)
    run(folder, "rosrun endovascular_sim synthetic_ct --out heart.vol --clicks clicks.yaml --spacing 1.5 "
                "--branch ascending_aorta")


def run(folder, command, limit=1500.0):
    """Output of a command of bash; raises when it fails."""
    done = subprocess.run(["bash", "-c", command], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, universal_newlines=True, timeout=limit, errors="replace")
    assert done.returncode == 0, "%s: exit code %d\n%s" % (command, done.returncode, done.stdout[-3000:])
    return done.stdout


def observe(folder, command, seconds):
    """Output of a program that runs until a person ends it."""
    with open(folder / "observed.log", "w+") as log:
        program = subprocess.Popen(["bash", "-c", "exec " + command], cwd=folder, stdout=log, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, start_new_session=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        time.sleep(seconds)
        ended = program.poll()
        program.send_signal(signal.SIGINT)
        try:
            program.wait(timeout=90)
        finally:
            if program.poll() is None:
                os.killpg(program.pid, signal.SIGKILL)
        log.seek(0)
        output = log.read()
    assert ended is None, "%s ended by itself:\n%s" % (command, output[-3000:])
    return output


def check(folder, page, section):
    """Runs the first command of a page, or of its section."""
    command = first_command(page, section)
    for word, value in PLACEHOLDERS.items():
        command = command.replace(word, value)
    # The packages are there; a test changes no package of the machine.
    command = command.replace("sudo apt-get install", "apt-get install --simulate")
    print("%s: %s" % (page.name, command), flush=True)
    program = command.split()[0]
    output = observe(folder, command, STARTED[program]) if program in STARTED else run(folder, command)
    doubts = [line for line in output.splitlines() if DOUBT.search(line)]
    assert not doubts, "%s prints warnings:\n%s" % (command, "\n".join(doubts[:20]))


def main():
    """Checks the pages."""
    repository = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder, repository)
        for page in sys.argv[2:]:
            page, _, section = page.partition("#")
            check(folder, repository / page, section)


main()
