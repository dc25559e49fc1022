"""Simulator of vascular interventions: worlds, sessions, rollouts, environments.

    import endovascular_sim as evs
    session = evs.World("tube").session()
    session.step(n=1000)
    print(session.tips["position"], session.hands["force"])

The compiled part is loaded at its first use. Messages of ROS, endovascular_sim.msg, need neither it nor numpy.
"""

import importlib

_PLACES = {
    "bag": ("Bag",),
    "env": ("Env",),
    "route": ("Route",),
    "vector": ("VectorEnv",),
    "_core": ("Blood", "Branch", "Cine", "Contrast", "Error", "InputError", "Motion", "Observation", "Reading", "Rollout", "Session", "UsageError",
              "World", "advance", "rollout"),
}
_MODULE_OF = {name: module for module, names in _PLACES.items() for name in names}
_MODULES = ("plots",)
_OF_CORE = {"__version__": "__version__", "__commit__": "commit", "physics_number": "physics_number"}

__all__ = sorted(_MODULE_OF)


def __getattr__(name):
    if name in _MODULE_OF:
        value = getattr(_load(_MODULE_OF[name]), name)
    elif name in _MODULES:
        value = _load(name)
    elif name in _OF_CORE:
        value = getattr(_load("_core"), _OF_CORE[name])
    else:
        raise AttributeError("module '%s' has no attribute '%s'" % (__name__, name))
    globals()[name] = value
    return value


def __dir__():
    return sorted([*globals(), *__all__, *_MODULES, *_OF_CORE])


def _load(module):
    try:
        return importlib.import_module("." + module, __name__)
    except ImportError as error:
        reason = _reason()
        if reason is None:
            raise
        raise ImportError(reason) from error


def _reason():
    """Reason for which this Python cannot load the compiled part; None if another reason must be found."""
    import glob
    import importlib.util
    import os
    import re
    import sys
    import sysconfig
    files = [file for folder in __path__ for file in glob.glob(os.path.join(folder, "_core.*.so"))]
    own = sysconfig.get_config_var("EXT_SUFFIX")
    if any(file.endswith("_core" + own) for file in files):
        if importlib.util.find_spec("numpy") is None:
            return "endovascular_sim needs numpy, which %s has not: install numpy, or use /usr/bin/python3" % sys.executable
        return None
    this = "this is %d.%d (%s)" % (*sys.version_info[:2], sys.executable)
    if not files:
        return ("endovascular_sim is not compiled here, in %s: build it with `catkin_ws/demo --build-only`, or with "
                "`pip install ./python`; %s" % (os.path.dirname(__file__), this))
    found = re.search(r"cpython-(\d)(\d+)", files[0])
    built = "%s.%s" % found.groups() if found else files[0]
    return ("endovascular_sim was built for Python %s, but %s; use that Python, or install the package for this one "
            "with `pip install ./python`" % (built, this))
