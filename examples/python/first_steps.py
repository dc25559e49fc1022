#!/usr/bin/env python3
"""First steps: a wire in a tube, pushed and turned, seen, saved and continued."""

import numpy as np

import endovascular_sim as evs

world = evs.World("tube", fluoroscopy={"pixels": 256})  # a bundled scene with one value changed
session = world.session()
session.step(n=2000)  # 2 s by the scene's own drive
print("%.1f s: tip at %s m" % (session.time, session.tips["position"][0].round(4)))

state = session.save()  # bytes; `simulate --from-state` reads them, too
hand = session.hands[0]
for step in range(1, 501):  # 30 mm/s forwards, 1 rad/s, for 0.5 s: one command [instrument, 3] per step
    t = step * world.time_step
    session.step([[hand["insertion"] + 0.03 * t, hand["rotation"] + 1.0 * t, 0.0]])
print("force on the hand %.3f N, %d contacts" % (session.hands["force"][0], len(session.forces)))

image = session.image("LAO 40")  # uint8 [pixels, pixels]
print("image: mean %.1f of 255" % np.mean(image))

session.load(state)  # back, bit for bit
print("again at %.1f s, trajectory %s" % (session.time, session.trajectory_hash))
