#!/usr/bin/env python3
"""Pushes a wire round a bend. Whenever the force on the hand exceeds a limit, it turns fast and pushes slowly: the friction
then acts mostly about the axis. The controller reads a force that no image shows."""

import numpy as np

import endovascular_sim as evs

LIMIT = 0.3  # of the force on the hand [N]

world = evs.World("tube", **{"vessel.friction": 0.5})
env = evs.Env(world, ("tube", 0.13), scale=(0.02, 12.0), horizon=200, vary=False)
for name, limit in (("without", np.inf), ("with", LIMIT)):
    observation, info = env.reset(seed=1)
    forces = []
    while not info["reason"]:
        action = [[0.15, 1.0]] if observation["hand_force"][0, 0] > limit else [[1.0, 0.0]]
        observation, reward, terminated, truncated, info = env.step(action)
        forces.append(info["hand_force"])
    print("%-7s limit: %s after %.1f s, force on the hand: largest %.2f N, mean of the last second %.2f N"
          % (name, info["reason"], env.session.time, max(forces), np.mean(forces[-7:])))
