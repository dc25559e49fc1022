from ._core import (
    Blood as Blood,
    Branch as Branch,
    Cine as Cine,
    Contrast as Contrast,
    Error as Error,
    InputError as InputError,
    Motion as Motion,
    Observation as Observation,
    Reading as Reading,
    Rollout as Rollout,
    Session as Session,
    UsageError as UsageError,
    World as World,
    advance as advance,
    rollout as rollout,
)
from . import plots as plots
from .bag import Bag as Bag
from .env import Env as Env
from .route import Route as Route
from .vector import VectorEnv as VectorEnv

__version__: str
__commit__: str
physics_number: int
