#!/usr/bin/python3
"""Costs of the binding beside the simulation: processor time of calls, of a further session and of a reset. Prints a
table; asserts nothing, because times depend on the machine."""

import resource
import time

import numpy as np

import endovascular_sim as evs


def microseconds(function, count=5000):
    """Mean processor time of a call [us]."""
    function()
    begin = time.process_time()
    for _ in range(count):
        function()
    return (time.process_time() - begin) / count * 1e6


def resident():
    """Present memory of this process [MB]."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 1e6


def main():
    world = evs.World("demo")
    session = world.session()
    session.step(n=2000)
    hand = session.hands[0]
    command = np.array([[hand["insertion"], hand["rotation"], 0.0]])
    for name, call in (("step of no steps, with commands", lambda: session.step(command, 0)),
                       ("hands", lambda: session.hands), ("tips", lambda: session.tips), ("nodes", lambda: session.nodes),
                       ("forces", lambda: session.forces), ("track of 3 points", lambda: session.track(3, 2e-3)),
                       ("observe", session.observe)):
        print("%-34s %8.2f us" % (name, microseconds(call)))
    one_by_one = microseconds(lambda: session.step(command), 2000)
    in_one_call = microseconds(lambda: session.step(command, 2000), 1) / 2000
    print("%-34s %8.2f us" % ("a step in a call of its own", one_by_one))
    print("%-34s %8.2f us" % ("a step of one call", in_one_call))
    state = session.save()
    print("%-34s %8.2f us" % ("save", microseconds(session.save, 50)))
    print("%-34s %8.2f us" % ("reset from a state", microseconds(lambda: session.load(state), 50)))
    before, kept = resident(), []
    print("%-34s %8.2f us" % ("a further session", microseconds(lambda: kept.append(world.session()), 200)))
    for one in kept:
        one.load(state)
        one.step(command, 20)
    print("%-34s %8.2f MB" % ("memory of a further session", (resident() - before) / len(kept)))


if __name__ == "__main__":
    main()
