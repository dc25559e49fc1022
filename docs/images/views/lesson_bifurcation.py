"""Lesson 1 in its layout: the tip points to the right branch."""
import time

from pictures import RvizSession, SETTLED, launch, photograph


def take(folder, out, overrides):
    with RvizSession(folder, launch("lesson_bifurcation.launch"), "expert:=false", "overrides:=" + " ".join(overrides)) as session:
        session.wait(60, lambda: session.step is not None and session.step.hint, "the hint of the first step")
        session.click((250, 202))  # the line of the keys
        # Taps: on a loaded computer a key that is held is released too late.
        session.wait(120, lambda: session.state.insertion[0] > 0.0355 or session.hold_key("Up", 0.05), "a push")
        session.wait(120, lambda: session.state.rotation[0] < -1.5 or session.hold_key("Left", 0.05), "a twist")
        time.sleep(SETTLED)
        photograph(session, out)
