"""Sessions in rviz on a virtual screen of 1280 × 800, rendered in software, for the pictures of the documentation."""
import os
import pathlib
import sys
import time

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(REPOSITORY / "test" / "scripts"))

from PIL import Image  # noqa: E402
import rospy  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
import yaml  # noqa: E402

from rviz_session import RvizSession, run  # noqa: E402

SETTLED = 12.0      # time for the camera and the X-ray image to come to rest [s]
UPPER, LOWER = 62, 771  # rows of the window between its tools and its status line


def configuration(folder, name, change):
    """Copy of a configuration of rviz, changed by a function."""
    config = yaml.safe_load((REPOSITORY / "rviz" / name).read_text(encoding="utf-8"))
    change(config)
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as stream:
        yaml.safe_dump(config, stream, sort_keys=False)
    return path


def display(config, name):
    """Display of a configuration by its name."""
    return next(one for one in config["Visualization Manager"]["Displays"] if one["Name"] == name)


def view(config, kind, distance, pitch=0.1, yaw=0.0):
    """Sets the view of a configuration."""
    config["Visualization Manager"]["Views"]["Current"] = {"Class": "endovascular_sim/" + kind, "Name": "Current View", "Yaw": yaw, "Pitch": pitch,
                                                           "Distance": distance, "Near Clip Distance": 0.001}


def pause(session):
    """Stops the simulation and waits until the picture has come to rest."""
    rospy.wait_for_service("simulation/pause", 20)
    rospy.ServiceProxy("simulation/pause", Trigger)()
    time.sleep(SETTLED)


def photograph(session, out, box=None):
    """Saves the screen, or a part of it."""
    run("xdotool", "mousemove", "1279", "799")
    screen = os.path.join(session.folder, "screen.png")
    run("import", "-window", "root", screen)
    picture = Image.open(screen).convert("RGB")
    picture.crop(box or (0, 0) + picture.size).save(out)


def launch(name):
    return str(REPOSITORY / "launch" / name)


def played(folder, out, change, moment, overrides, scene="demo", box=None, launch_file="demo.launch"):
    """Picture of a scene that moves by its own drive, at a simulated time [s]."""
    config = configuration(folder, "replay.rviz", change)  # without a panel on the left
    words = " ".join(["drive.source=script", "haptic_device=false", *overrides])
    path = str(REPOSITORY / "config" / "scenes" / (scene + ".yaml"))
    with RvizSession(folder, launch(launch_file), "scene:=" + path, "haptic_device:=false", "rviz_config:=" + config, "overrides:=" + words) as session:
        session.wait(200, lambda: session.state.time >= moment, "the moment of the picture")
        pause(session)
        photograph(session, out, box)
