"""Gymnasium where it can be imported, else stand-ins for the few of its classes that the environments use. Seeds give the
same random numbers in both cases."""

import enum

import numpy as np

try:
    import gymnasium
    from gymnasium.spaces import Box, Dict
    from gymnasium.vector import AutoresetMode
    from gymnasium.vector import VectorEnv as VectorBase
    from gymnasium.vector.utils import batch_space
    EnvBase = gymnasium.Env
    HAS_GYMNASIUM = True
except ImportError:
    HAS_GYMNASIUM = False

    class AutoresetMode(enum.Enum):
        """Moment at which VectorEnv resets an environment whose episode has ended."""

        NEXT_STEP = "NextStep"
        SAME_STEP = "SameStep"
        DISABLED = "Disabled"

    class Box:
        """Arrays with bounds for each element."""

        def __init__(self, low, high, shape=None, dtype=np.float32, seed=None):
            self.shape = tuple(np.broadcast_shapes(np.shape(low), np.shape(high)) if shape is None else shape)
            self.dtype = np.dtype(dtype)
            self.low = np.broadcast_to(np.asarray(low, dtype), self.shape).copy()
            self.high = np.broadcast_to(np.asarray(high, dtype), self.shape).copy()
            self.seed(seed)

        def seed(self, seed=None):
            self._random = np.random.default_rng(seed)

        def sample(self):
            low = np.where(np.isfinite(self.low), self.low, -1.0)
            high = np.where(np.isfinite(self.high), self.high, 1.0)
            if self.dtype.kind in "ui":
                return self._random.integers(self.low, self.high, self.shape, self.dtype, endpoint=True)
            return self._random.uniform(low, high).astype(self.dtype)

        def contains(self, value):
            value = np.asarray(value)
            return bool(value.shape == self.shape and np.can_cast(value.dtype, self.dtype)
                        and np.all(value >= self.low) and np.all(value <= self.high))

        __contains__ = contains

    class Dict:
        """Named spaces."""

        def __init__(self, spaces):
            self.spaces = dict(spaces)

        def seed(self, seed=None):
            for number, space in enumerate(self.spaces.values()):
                space.seed(None if seed is None else seed + number)

        def sample(self):
            return {name: space.sample() for name, space in self.spaces.items()}

        def contains(self, value):
            return (isinstance(value, dict) and value.keys() == self.spaces.keys()
                    and all(space.contains(value[name]) for name, space in self.spaces.items()))

        __contains__ = contains

        def __getitem__(self, name):
            return self.spaces[name]

        def items(self):
            return self.spaces.items()

    def batch_space(space, n):
        """Space of n values at a time."""
        if isinstance(space, Dict):
            return Dict({name: batch_space(part, n) for name, part in space.items()})
        return Box(np.repeat(space.low[np.newaxis], n, 0), np.repeat(space.high[np.newaxis], n, 0), dtype=space.dtype)

    class EnvBase:
        """Environment: reset(), step(), render(), close()."""

        metadata = {"render_modes": []}
        render_mode = None
        spec = None
        _np_random = None

        @property
        def np_random(self):
            if self._np_random is None:
                self._np_random = np.random.Generator(np.random.PCG64())
            return self._np_random

        @property
        def unwrapped(self):
            return self

        def reset(self, *, seed=None, options=None):
            if seed is not None:
                self._np_random = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))

        def close(self):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.close()

    class VectorBase:
        """Several environments that step at a time."""

        metadata = {}
        spec = None
        render_mode = None

        def close(self, **options):
            self.close_extras(**options)

        def _add_info(self, infos, info, number):
            for key, value in info.items():
                if key == "final_obs" or not isinstance(value, (int, float, dict, np.ndarray, np.generic)):
                    values = infos.get(key, np.full(self.num_envs, None, object))
                    values[number] = value
                elif isinstance(value, dict):
                    values = self._add_info(infos.get(key, {}), value, number)
                else:
                    array = np.asarray(value)
                    values = infos.get(key, np.zeros((self.num_envs, *array.shape), array.dtype))
                    values[number] = value
                mask = infos.get("_" + key, np.zeros(self.num_envs, bool))
                mask[number] = True
                infos[key], infos["_" + key] = values, mask
            return infos
