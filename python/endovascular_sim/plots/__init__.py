"""Plots of sessions and of results.

In Python, each function draws into `axes`, or into a new figure, and returns the axes:

    evs.plots.wire_in_vessel(session)
    evs.plots.forces(times, values)
    evs.plots.x_ray(session.image())

From files, `python3 -m endovascular_sim.plots` draws the results of sessions, studies and tools; --help lists its commands.
matplotlib is needed here only.
"""

from .session import forces, wire_in_vessel, x_ray

__all__ = ["forces", "wire_in_vessel", "x_ray"]
