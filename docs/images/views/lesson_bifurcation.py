"""Lesson 1 in its layout: the tip points to the right branch."""
import time

from pictures import RvizSession, SETTLED, launch, photograph


def take(folder, out, overrides):
    with RvizSession(folder, launch("lesson_bifurcation.launch"), "expert:=false", "overrides:=" + " ".join(overrides)) as session:
        session.wait(60, lambda: session.step is not None and session.step.hint, "the hint of the first step")
        session.click((250, 202))  # the line of the keys
        session.hold_key_until("Up", 60, lambda: session.state.insertion[0] > 0.0365, "a push")
        session.hold_key_until("Left", 60, lambda: session.state.rotation[0] < -1.57, "a twist")
        time.sleep(SETTLED)
        photograph(session, out)
