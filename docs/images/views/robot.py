"""The example robot at the femoral introducer."""
import time

from pictures import LOWER, SETTLED, UPPER, RvizSession, launch, photograph


def take(folder, out, overrides):
    with RvizSession(folder, launch("robot.launch"), "fluoroscopy:=false", "overrides:=" + " ".join(overrides)) as session:
        time.sleep(SETTLED)
        photograph(session, out, (364, UPPER, 818, LOWER))  # between the panel and the X-ray image
