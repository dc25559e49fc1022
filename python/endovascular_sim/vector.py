"""Several environments that step at a time, in C++ threads."""

import numpy as np

from . import _gym
from ._core import InputError, UsageError, advance
from .env import Env


class VectorEnv(_gym.VectorBase):
    """Environments of one world, stepped in C++ threads of this process, in the API of gymnasium.vector.

    num_envs        number of environments; they share world and starts
    world, target   as those of Env
    threads         number of threads; 0: one per processor. The results do not depend on it
    autoreset_mode  "NextStep", "SameStep" or "Disabled", or gymnasium.vector.AutoresetMode
    options         those of Env

    Observations are [env, ...], actions [env, instrument, 2]. Threads end with each step, so that the process can fork.
    """

    metadata = dict(Env.metadata)

    def __init__(self, num_envs, world, target, *, threads=0, autoreset_mode="NextStep", **options):
        if num_envs < 1:
            raise InputError("num_envs: %r is below 1" % num_envs)
        try:
            self.autoreset_mode = _gym.AutoresetMode(getattr(autoreset_mode, "value", autoreset_mode))
        except ValueError as error:
            raise InputError("autoreset_mode: %r is none of NextStep, SameStep, Disabled" % autoreset_mode) from error
        first = Env(world, target, **options)
        if first.starts:
            options["start"] = first.starts
        self.envs = [first, *(Env(first.world, target, **options) for _ in range(num_envs - 1))]
        self.num_envs, self.threads, self.render_mode = num_envs, threads, first.render_mode
        self.metadata = {**Env.metadata, "autoreset_mode": self.autoreset_mode}
        self.single_action_space, self.single_observation_space = first.action_space, first.observation_space
        self.action_space = _gym.batch_space(first.action_space, num_envs)
        self.observation_space = _gym.batch_space(first.observation_space, num_envs)
        self._ended = np.zeros(num_envs, bool)

    def reset(self, *, seed=None, options=None):
        """Begins the episodes of all environments, or of those in options["reset_mask"], bool [env].

        seed  a number, from which environment k gets seed + k; or one per environment; None: goes on at random
        """
        seeds = [None if seed is None else seed + k for k in range(self.num_envs)] if not isinstance(seed, (list, tuple)) \
            else list(seed)
        mask = np.asarray((options or {}).get("reset_mask", np.ones(self.num_envs, bool)))
        if len(seeds) != self.num_envs or mask.shape != (self.num_envs,) or mask.dtype != bool or not mask.any():
            raise InputError("reset: expected %d seeds, and a reset_mask, bool [%d], with at least one environment"
                             % (self.num_envs, self.num_envs))
        infos = {}
        observations = []
        for number, env in enumerate(self.envs):
            if mask[number]:
                observation, info = env.reset(seed=seeds[number])
                infos = self._add_info(infos, info, number)
            else:
                observation = env.observe()
            observations.append(observation)
        self._ended[mask] = False
        return self._stack(observations), infos

    def step(self, actions):
        """Performs actions [env, instrument, 2]. Returns observations, rewards, terminations, truncations, infos."""
        actions = np.asarray(actions)
        if actions.shape != self.action_space.shape:
            raise InputError("actions: have shape %s; expected %s" % (list(actions.shape), list(self.action_space.shape)))
        if self.autoreset_mode is _gym.AutoresetMode.DISABLED and self._ended.any():
            raise UsageError("environments %s have ended; reset them with options={'reset_mask': ...}"
                             % np.flatnonzero(self._ended).tolist())
        running = ~self._ended
        peaks = self._advance(actions, running)
        results, infos = [], {}
        for number, env in enumerate(self.envs):
            if running[number]:
                result = env.conclude(peaks[number])
            else:
                observation, info = env.reset()
                result = observation, 0.0, False, False, info
            if self.autoreset_mode is _gym.AutoresetMode.SAME_STEP and (result[2] or result[3]):
                infos = self._add_info(infos, {"final_obs": result[0], "final_info": result[4]}, number)
                observation, info = env.reset()
                result = observation, *result[1:4], info
            infos = self._add_info(infos, result[4], number)
            results.append(result)
        observations, rewards, terminations, truncations, _ = zip(*results)
        terminations, truncations = np.array(terminations), np.array(truncations)
        if self.autoreset_mode is not _gym.AutoresetMode.SAME_STEP:
            self._ended = terminations | truncations
        return self._stack(observations), np.array(rewards), terminations, truncations, infos

    def render(self):
        """X-ray image of each environment, a tuple."""
        return tuple(env.render() for env in self.envs)

    def call(self, name, *arguments, **options):
        """Result of a method, or value of an attribute, of each environment, a tuple."""
        values = [getattr(env, name) for env in self.envs]
        return tuple(value(*arguments, **options) if callable(value) else value for value in values)

    def get_attr(self, name):
        """Value of an attribute of each environment, a tuple."""
        return self.call(name)

    def close_extras(self, **_):
        """Ends the sessions of all environments."""
        for env in self.envs:
            env.close()

    def _advance(self, actions, running):
        """Steps the running environments at a time; returns the largest forces per environment."""
        envs = [env for env, runs in zip(self.envs, running) if runs]
        prepared = [env.prepare(action) for env, action in zip(envs, actions[running])]
        peaks = [None] * self.num_envs
        if not envs:
            return peaks
        sessions = [env.session for env in envs]
        if "commands" in prepared[0]:
            forces = advance(sessions, np.concatenate([one["commands"] for one in prepared]), self.threads)
        else:
            forces = advance(sessions, threads=self.threads, n=envs[0].steps)
        for number, force in zip(np.flatnonzero(running), forces):
            peaks[number] = force
        return peaks

    @staticmethod
    def _stack(observations):
        if isinstance(observations[0], dict):
            return {name: np.stack([one[name] for one in observations]) for name in observations[0]}
        return np.stack(observations)
