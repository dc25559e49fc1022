"""Recorded procedure in the player at end-diastole and at end-systole: catheter in the left main artery, wire in the anterior
descending artery, which holds contrast medium."""
import os
import subprocess
import time

from PIL import Image

from pictures import REPOSITORY, RvizSession, SETTLED, launch, photograph, rospy
from endovascular_sim.srv import PlayerControl, PlayerControlRequest

BEAT, SYSTOLE = 1.0 / 1.1667, 0.344  # of config/motion/adult.yaml [s]
DIASTOLE = 184 * BEAT                # end of a diastole during the injection after the stent [simulated s]
BOX = (400, 62, 1280, 771)           # 3D view and X-ray image


def take(folder, out, overrides):
    values = ["duration=%g" % (DIASTOLE + 1.0), "fluoroscopy.isocentre=[0.05,-0.045,0.175]", "fluoroscopy.follow_tip=false", *overrides]
    bag = os.environ.get("RECORDING_OF_PCI") or folder + "/recording/session.bag"
    if not os.path.exists(bag):
        subprocess.run(["rosrun", "endovascular_sim", "scripted_recording", str(REPOSITORY / "config/scenes/pci.yaml"), "--out", folder + "/recording",
                        *(word for value in values for word in ("--set", value))], check=False)  # the procedure is cut short
    parts = []
    with RvizSession(folder, launch("replay.launch"), "bag:=" + bag, "paused:=true") as session:
        control = rospy.ServiceProxy("/player/control", PlayerControl)
        for name, moment in (("diastole", DIASTOLE), ("systole", DIASTOLE + SYSTOLE)):
            control(PlayerControlRequest.SEEK_TIME, moment)
            time.sleep(SETTLED)
            parts.append(os.path.join(folder, name + ".png"))
            photograph(session, parts[-1], BOX)
    pictures = [Image.open(part) for part in parts]
    width, height = pictures[0].size
    sheet = Image.new("RGB", (width, 2 * height + 6), "white")
    for k, picture in enumerate(pictures):
        sheet.paste(picture, (0, k * (height + 6)))
    sheet.save(out)
