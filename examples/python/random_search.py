#!/usr/bin/env python3
"""Random search for steering into the brachiocephalic artery: an open sequence of velocities, improved by trial.

    random_search.py [--minutes T] [--threads N] [--seed S]

T is processor time, at most. Pushing alone does not reach this target. A candidate is a sequence of knots, insertion and
rotation, each held for the same time; the best one so far is varied. Prints the best distance of each generation, and in
the end how often the found sequence and plain pushing reach the target from held-out starts.
"""

import argparse
import time

import numpy as np

import endovascular_sim as evs

TARGET = ("brachiocephalic", 0.02)
SCENE = {"instrument.sections.0.length": 0.7, "sampling.nodes": 200, "solver.time_step": 2e-3, "drive.force_limit": 2.0}
START, KNOTS, HORIZON, POPULATION, HELD_OUT = 0.50, 8, 48, 8, 8


def episodes(envs, sequences, seeds):
    """Runs one sequence [knot, 2] per environment. Returns the least distances from the target [m], [env]."""
    _, infos = envs.reset(seed=list(seeds))
    least = infos["distance"].copy()
    running = np.ones(envs.num_envs, bool)
    for step in range(HORIZON):
        actions = sequences[:, np.newaxis, step * KNOTS // HORIZON]
        _, _, terminations, truncations, infos = envs.step(actions)
        ended = infos.get("final_info", {}).get("distance", infos["distance"])  # of episodes that this step has ended
        least = np.where(running, np.minimum(least, np.where(terminations | truncations, ended, infos["distance"])), least)
        running &= ~(terminations | truncations)
        if not running.any():
            break
    return least


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60.0, help="processor time")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    world = evs.World("demo", **SCENE)
    envs = evs.VectorEnv(POPULATION, world, TARGET, start=START, start_turn=np.pi, horizon=HORIZON,
                         threads=options.threads, autoreset_mode="SameStep")
    tolerance = envs.envs[0].tolerance
    random = np.random.default_rng(options.seed)
    best, shape = None, (POPULATION, KNOTS, 2)
    generation = 0
    while best is None or time.process_time() < 60.0 * options.minutes:
        if best is None or generation % 4 == 0:  # fresh candidates now and then
            candidates = random.uniform(-1.0, 1.0, shape)
            candidates[..., 0] = np.abs(candidates[..., 0])
        else:
            candidates = np.clip(best[1] + random.normal(0.0, 0.4, shape), -1.0, 1.0)
        distances = episodes(envs, candidates, [options.seed] * POPULATION)
        if best is None or distances.min() < best[0]:
            best = distances.min(), candidates[distances.argmin()]
        generation += 1
        print("generation %3d, %5.1f min: best %5.1f mm, this one %5.1f mm"
              % (generation, time.process_time() / 60.0, 1e3 * best[0], 1e3 * distances.min()), flush=True)
        if best[0] <= tolerance:
            break
    held_out = [1000 + options.seed + k for k in range(HELD_OUT)]
    push = np.tile([1.0, 0.0], (KNOTS, 1))
    for name, sequence in (("found", best[1]), ("push", push)):
        reached = episodes(envs, np.repeat(sequence[np.newaxis], POPULATION, 0), held_out) <= tolerance
        print("%-5s reaches the target from %d of %d held-out starts" % (name, reached.sum(), HELD_OUT))
    print("sequence: %s" % best[1].round(3).tolist())


if __name__ == "__main__":
    main()
