#!/usr/bin/python3
"""Control steps of 133 ms per second of processor time: whole episodes of 400 mm at 35 mm/s, resets and observations
included. Prints a table; asserts nothing, because times depend on the machine.

    environment_speed.py MESH [EPISODES]     MESH: aortic_arch_tree.obj of stEVE
"""

import sys
import time
import warnings

import numpy as np

import endovascular_sim as evs

TRAVEL = 0.4  # [m]
FINE, COARSE = {}, {"sampling.nodes": 160, "solver.time_step": 2e-3}


def longest_way(world):
    """Target that lies farthest from the introducer among those that the wire can reach."""
    best = None
    for number, branch in enumerate(world.branches):
        depth = 0.9 * (np.linalg.norm(np.diff(branch["points"], axis=0), axis=1).sum() - branch["ostium"])
        try:
            route = evs.Env(world, (number, depth)).routes[0]
        except evs.InputError:
            continue
        if best is None or route.length > best[0]:
            best = route.length, (number, depth)
    return best[1]


def measure(mesh, episodes, overrides):
    """Control steps per second of processor time, and the tips at the ends of the episodes [m]."""
    world = evs.World("peer_wire", centreline=True, vessel={"mesh": mesh}, **overrides)
    env = evs.Env(world, longest_way(world), scale=(0.035, 2.0), tolerance=0.0, horizon=10**6, vary=False)
    steps, tips = 0, []
    begin = time.process_time()
    for episode in range(episodes):
        env.reset(seed=episode)
        for step in range(round(TRAVEL / (0.035 * env.steps * world.time_step))):
            turn = np.cos(step * env.steps * world.time_step + 0.3 * episode)  # of the peers' benchmark, shifted
            env.step([[1.0, turn]])
            steps += 1
        tips.append(env.session.tips["position"][0])
    return steps / (time.process_time() - begin), np.array(tips)


def main():
    warnings.simplefilter("ignore")
    mesh, episodes = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20
    fine, tips = measure(mesh, episodes, FINE)
    coarse, other = measure(mesh, episodes, COARSE)
    print("240 nodes, 1 ms   %6.1f control steps per second and core" % fine)
    print("160 nodes, 2 ms   %6.1f control steps per second and core" % coarse)
    errors = 1e3 * np.linalg.norm(tips - other, axis=1)
    print("distance of the tips at the ends: median %.2f mm, largest %.2f mm" % (np.median(errors), errors.max()))


if __name__ == "__main__":
    main()
