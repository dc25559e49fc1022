#!/usr/bin/python3
"""Plays a lesson in rviz on a virtual screen as a person who does the wrong thing first: other instrument, blocked push, wrong branch, pause,
reset, a step again. Then it follows the page to the end. Every action is checked on topics.

usage: play_lesson.py FOLDER REPOSITORY LESSON [SCREEN]"""
import json
import os
import sys
import time

from rviz_session import RvizSession, run
from trainee import Trainee

# Instruments in the order of the scene, and the one of the first step.
LESSONS = {"lesson_bifurcation": (["wire"], 0), "lesson_catheter_needs_wire": (["wire", "catheter"], 1),
           "lesson_lad_stent": (["soft_wire", "stent", "wire", "catheter"], 2),
           "lesson_pressure": (["pressure_wire", "stent", "wire", "catheter"], 2),
           "lesson_injection": (["wire", "catheter"], 0)}


def passed(text):
    print(text, flush=True)


def use_all_controls(session, driven):
    """Push, twist, pause and start by mouse and keys, and a reset."""
    def insertion():
        return session.state.insertion[driven]

    def rotation():
        return session.state.rotation[driven]

    session.click("focus")
    beginning = insertion()
    session.hold_until("push", 20, lambda: insertion() > beginning + 2e-3, "a push by the mouse")
    time.sleep(1.5)
    rest = insertion()
    time.sleep(1.0)
    assert abs(insertion() - rest) < 1e-4, "the instrument moves on after the release of the button"
    session.hold_key_until("Up", 20, lambda: insertion() > rest + 2e-3, "a push by the key")
    turn = rotation()
    session.hold_until("twist_left", 20, lambda: rotation() < turn - 0.3, "a twist by the mouse")
    turn = rotation()
    session.hold_key_until("Right", 20, lambda: rotation() > turn + 0.3, "a twist by the key")
    passed("push and twist by mouse and keys")
    for pause, start in (("pause", "start"), (None, None)):
        session.click(pause) if pause else session.hold_key("space", 0.1)
        time.sleep(2.0)
        stands = session.state.time
        time.sleep(1.5)
        assert session.state.time == stands, "the simulation runs on in a pause"
        session.click(start) if start else session.hold_key("space", 0.1)
        session.wait(10, lambda: session.state.time > stands + 0.5, "the end of the pause")
    passed("pause and start by mouse and key")
    session.click("reset")
    session.wait(40, lambda: session.progress.run == 2 and insertion() < beginning + 1e-3, "a reset, and a second recording")
    passed("reset")


def push_another_instrument(session, trainee, names, driven):
    """Chooses another instrument than the hint names, and pushes it: it moves, or waits outside."""
    other = driven - 1
    before = list(session.state.insertion)
    session.hold_key("Page_Up", 0.1)  # the list is ordered from the inside out
    time.sleep(1.0)
    session.hold_key("Up", 2.0)
    time.sleep(1.0)
    moved = [abs(now - then) > 1e-3 for now, then in zip(session.state.insertion, before)]
    assert not moved[driven], "the instrument of the step has moved, though another one was chosen"
    session.picture("other_instrument")
    passed("another instrument, %s, %s" % (names[other], "moves" if moved[other] else "waits"))
    if moved[other]:
        trainee.key_until("Down", lambda: session.state.insertion[other] < before[other] + 1e-3, "its return")
    session.hold_key("Page_Down", 0.1)
    time.sleep(1.0)


def enter_the_wrong_branch(session, trainee):
    """Lesson 1: enters the other branch of the fork, and pushes on."""
    trainee.do_steps(1)
    number = trainee.number()
    trainee.steer(0, "left")
    begin = time.monotonic()
    while trainee.push_until_something(0, number) == "done":
        raise AssertionError("the tip entered the right branch, though it was steered to the left one")
    assert session.step.wrong_branches == 1, "the wrong branch is not counted"
    passed("wrong branch after %.0f s" % (time.monotonic() - begin))
    session.hold_key("Up", 3.0)
    session.picture("wrong_branch")


def repeat_the_step(session, trainee, driven):
    """Returns to the beginning of the present step by the button."""
    number, run_before = trainee.number(), session.progress.run
    before = session.state.insertion[driven]
    session.hold_key("Up", 1.0)
    session.click("repeat_step")
    session.wait(60, lambda: session.progress.run == run_before + 1, "the recording of the repeated step")
    session.wait(20, lambda: trainee.number() == number and abs(session.state.insertion[driven] - before) < 0.2, "the step again")
    session.click("focus")
    passed("step %d again, in run %d" % (number, session.progress.run))


def end_by_the_key(session):
    """Ends the launch by the key that the page names."""
    run("xdotool", "key", "ctrl+q")
    session.launch.wait(timeout=90)
    passed("Ctrl+Q ends the lesson")


def main():
    folder, repository, lesson = sys.argv[1:4]
    screen = sys.argv[4] if len(sys.argv) > 4 else "1280x800"
    names, driven = LESSONS[lesson]
    with RvizSession(folder, "%s/launch/%s.launch" % (repository, lesson), "expert:=false", "step:=1", screen=screen, layout="lesson") as session:
        session.wait(30, lambda: session.step is not None and session.step.hint, "the hint of the first step")
        trainee = Trainee(session, "%s/config/procedures/%s.yaml" % (repository, lesson), names)
        use_all_controls(session, driven)
        session.click("focus")
        if driven > 0:
            push_another_instrument(session, trainee, names, driven)
        if lesson == "lesson_bifurcation":
            enter_the_wrong_branch(session, trainee)
        repeat_the_step(session, trainee, driven)
        if lesson == "lesson_bifurcation":
            session.click("reset")  # the verdict is on the whole lesson
            session.wait(40, lambda: session.progress.run == 4, "the recording after the second reset")
            session.click("focus")
        trainee.do_steps()
        session.picture(lesson)
        run_now = session.progress.run
        page = folder + "/results/run_%d/metrics.json" % run_now
        session.wait(60, lambda: session.verdict is not None and session.verdict.run == run_now, "the verdict, without a click")
        time.sleep(3.0)  # the dialog opens
        session.picture(lesson + "_result")
        with open(page, encoding="utf-8") as file:
            result = json.load(file)["lesson"]
        for mark in result["marks"]:
            passed("%s: %.3g of %.3g %s, %s" % (mark["mark"], mark["value"], mark["limit"], mark["unit"],
                                                "passed" if mark["passed"] else "not passed"))
        assert result["marks"][0]["passed"], "steps are missing"
        assert list(session.verdict.value) == [mark["value"] for mark in result["marks"]], "the verdict is not that of the page"
        for name in (lesson, lesson + "_result"):
            path = os.path.join(os.environ.get("ENDOVASCULAR_PICTURES", folder), name + ".png")
            colours = int(run("identify", "-format", "%k", path))
            assert colours > 500, "%s has %d colours: no picture" % (path, colours)
        end_by_the_key(session)


if __name__ == "__main__":
    main()
