"""Session in rviz on a virtual screen, with clicks and keys by xdotool, observed by topics. Every external call has a time limit.

Places of the controls are those of rviz/*.rviz at 1280 x 800."""
import os
import re
import signal
import socket
import subprocess
import time

import rospy
from endovascular_sim.msg import ProcedureStep, RodStateVisual, SessionProgress, SessionVerdict

PLACES = {"work": {"start": (44, 100), "pause": (129, 100), "reset": (213, 100), "record": (297, 100),
                   "push": (107, 181), "pull": (275, 181), "twist_left": (107, 216), "twist_right": (275, 216),
                   "overview": (86, 360), "tip": (201, 360), "in_vessel": (288, 360), "focus": (250, 264)},
          # The last two are those of an instrument with a balloon.
          "lesson": {"start": (44, 38), "pause": (127, 38), "reset": (230, 38), "record": (327, 38), "repeat_step": (327, 66),
                     "push": (85, 127), "pull": (251, 127), "twist_left": (85, 162), "twist_right": (251, 162), "focus": (90, 210),
                     "pressure": (30, 273), "set_pressure": (115, 273), "deflate": (293, 273),
                     "adenosine": (44, 474),      # where blood flows
                     "hold_breath": (46, 366)}}  # without blood


def run(*command, seconds=20, **options):
    """Output of a program; it is killed after the given seconds."""
    result = subprocess.run(["timeout", "-s", "KILL", str(seconds), *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            universal_newlines=True, **options)
    return result.stdout


class RvizSession:
    """@param layout of a launch file that has the argument, "work" or "lesson": its places are clicked"""

    def __init__(self, folder, launch, *arguments, screen="1280x800", layout=None):
        self.places = PLACES[layout or "work"]
        self.folder, self.results = folder, folder + "/results"
        self.state = self.step = self.progress = self.verdict = None
        with socket.socket() as free:
            free.bind(("localhost", 0))
            port = free.getsockname()[1]
        read, write = os.pipe()
        self.screen = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", screen + "x24", "-nolisten", "tcp"],
                                       pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            display = ":" + pipe.readline().strip()
        os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOME=folder + "/ros", DISPLAY=display,
                          LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1", XDG_RUNTIME_DIR=folder,
                          ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        os.chmod(folder, 0o700)
        self.log = folder + "/graph.log"
        self.launch = subprocess.Popen(["roslaunch", "-p", str(port), launch, "results:=" + self.results, *([] if layout is None else ["layout:=" + layout]), *arguments],
                                       stdout=open(self.log, "w"), stderr=subprocess.STDOUT, start_new_session=True,
                                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def __enter__(self):
        try:
            self.wait(60, lambda: "process[rviz-" in self.text(), "rviz to be started")
            # Without simulated time and without a handler of SIGINT: the test ends by itself.
            rospy.init_node("test_of_rviz", anonymous=True, disable_signals=True)
            rospy.Subscriber("rod/state_visual", RodStateVisual, lambda message: setattr(self, "state", message), queue_size=1)
            rospy.Subscriber("procedure/step", ProcedureStep, lambda message: setattr(self, "step", message), queue_size=1)
            rospy.Subscriber("session/verdict", SessionVerdict, lambda message: setattr(self, "verdict", message), queue_size=1)
            rospy.Subscriber("session/progress", SessionProgress, lambda message: setattr(self, "progress", message), queue_size=1)
            self.wait(90, lambda: self.state is not None, "the first state")
            self.wait(90, lambda: run("xdotool", "search", "--onlyvisible", "--class", "rviz", seconds=5).strip(), "the window")
            time.sleep(8)  # the window is black until the first picture
            return self
        except BaseException:
            self.__exit__(BaseException)
            raise

    def __exit__(self, failure=None, *_):
        if failure:
            self.picture("failure")
        rviz = self.pid_of("rviz")
        if rviz:
            try:
                os.kill(rviz, signal.SIGCONT)
            except ProcessLookupError:
                pass
        if self.launch.poll() is None:
            self.launch.send_signal(signal.SIGINT)
        try:
            self.launch.wait(timeout=90)
        except subprocess.TimeoutExpired:
            self.launch.kill()
        self.screen.kill()
        self.screen.wait()

    def text(self):
        return open(self.log, errors="replace").read()

    def pid_of(self, node):
        found = re.findall(r"process\[%s-\d+\]: started with pid \[(\d+)\]" % node, self.text())
        return int(found[-1]) if found else None

    def wait(self, seconds, condition, name):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return
            assert self.launch.poll() is None, self.text()[-3000:]
            time.sleep(0.1)
        raise AssertionError("%s: not within %g s\n%s" % (name, seconds, self.text()[-2000:]))

    def mouse(self, place, *action):
        x, y = self.places[place] if isinstance(place, str) else place
        run("xdotool", "mousemove", str(x), str(y), *action)

    def click(self, place):
        self.mouse(place, "click", "1")

    def hold(self, place, seconds):
        """Presses a button of the mouse at a place for a time."""
        self.mouse(place, "mousedown", "1")
        time.sleep(seconds)
        run("xdotool", "mouseup", "1")

    def hold_key(self, key, seconds):
        run("xdotool", "keydown", key)
        time.sleep(seconds)
        run("xdotool", "keyup", key)

    def hold_until(self, place, seconds, condition, name):
        """Presses a button of the mouse at a place until the condition holds: on a loaded computer an event takes seconds."""
        self.mouse(place, "mousedown", "1")
        try:
            self.wait(seconds, condition, name)
        finally:
            run("xdotool", "mouseup", "1")

    def hold_key_until(self, key, seconds, condition, name):
        run("xdotool", "keydown", key)
        try:
            self.wait(seconds, condition, name)
        finally:
            run("xdotool", "keyup", key)

    def set_pressure(self, atmospheres):
        """Types the pressure of the chosen balloon."""
        self.mouse("pressure", "click", "--repeat", "3", "1")
        run("xdotool", "key", "ctrl+a")
        run("xdotool", "type", "--", "%.1f" % atmospheres)
        run("xdotool", "key", "Tab")
        self.click("set_pressure")
        self.click("focus")

    def picture(self, name):
        run("import", "-window", "root", os.path.join(os.environ.get("ENDOVASCULAR_PICTURES", self.folder), name + ".png"))
