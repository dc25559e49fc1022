"""Layout `work`: vessel with the names of its branches, wire, legends, panel, X-ray image."""
import time

from pictures import RvizSession, SETTLED, launch, photograph


def take(folder, out, overrides):
    with RvizSession(folder, launch("lesson_lad_stent.launch"), "layout:=work", "expert:=false", "overrides:=" + " ".join(overrides)) as session:
        session.wait(60, lambda: session.step is not None and session.step.hint, "the hint of the first step")
        session.click("focus")
        driven = max(range(len(session.state.insertion)), key=lambda k: session.state.insertion[k])
        session.hold_key_until("Up", 60, lambda: session.state.insertion[driven] > 0.105, "a push")
        time.sleep(SETTLED)
        photograph(session, out)
