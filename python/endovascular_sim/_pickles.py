"""Functions that pickles name. Those of the compiled part cannot be pickled themselves."""

from . import _core


def world(*state):
    """World of a pickle."""
    return _core._world_of_pickle(*state)


def session(*state):
    """Session of a pickle."""
    return _core._session_of_pickle(*state)
