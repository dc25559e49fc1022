"""Wire in vessel, forces, X-ray images of a session."""

import numpy as np

import endovascular_sim

_VIEWS = {"front": (0, 2), "side": (1, 2), "top": (0, 1)}  # indices of the patient frame's axes: x left, y posterior, z head
_NAMES = ("x [mm]", "y [mm]", "z [mm]")


def wire_in_vessel(session, view="front", axes=None, route=None, margin=0.02):
    """Wire and its forces in the outline of the vessel, seen along an axis of the patient frame.

    session  Session
    view     "front", "side" or "top"
    route    Route whose way and target are drawn, too; None: none
    margin   of the vessel around wire and route [m]
    """
    if view not in _VIEWS:
        raise endovascular_sim.InputError("view: '%s' is none of %s" % (view, ", ".join(_VIEWS)))
    axes, pair = _axes(axes), list(_VIEWS[view])
    nodes, forces = session.nodes[:, pair] * 1e3, session.forces
    seen = nodes if route is None else np.concatenate([nodes, route.points[:, pair] * 1e3])
    low, high = seen.min(0) - 1e3 * margin, seen.max(0) + 1e3 * margin
    _draw_wall(axes, session, pair, low, high)
    if route is not None:
        axes.plot(*(route.points[:, pair].T * 1e3), color="tab:green", linewidth=0.8, linestyle="--", label="way")
        axes.plot(*(route.target[pair] * 1e3), color="tab:green", marker="x", linestyle="")
    axes.plot(*nodes.T, color="black", linewidth=1.2, label="wire")
    if len(forces):
        axes.quiver(*(forces["position"][:, pair].T * 1e3), *forces["normal_force"][:, pair].T, color="tab:red",
                    width=3e-3, label="force of the wall")
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel=_NAMES[pair[0]], ylabel=_NAMES[pair[1]],
             aspect="equal", title="%.2f s" % session.time)
    axes.legend(loc="best", fontsize="small")
    return axes


def forces(times, values, axes=None, labels=None):
    """Forces over time.

    times   [step] [s]
    values  [step] or [step, instrument] [N], e.g. Rollout.hands["force"][run] or Bag.forces[..., 0]
    labels  names of the instruments
    """
    values = np.asarray(values, float)
    columns = values.reshape(len(values), -1)
    if len(times) != len(columns):
        raise endovascular_sim.InputError("forces: %d times for %d values" % (len(times), len(columns)))
    axes = _axes(axes)
    for k in range(columns.shape[1]):
        axes.plot(times, columns[:, k], linewidth=1.0, label=labels[k] if labels else None)
    axes.axhline(0.0, color="grey", linewidth=0.5)
    axes.set(xlabel="time [s]", ylabel="force [N]")
    if labels:
        axes.legend(fontsize="small")
    return axes


def x_ray(image, axes=None):
    """X-ray image, [pixels, pixels], as Session.image() returns it."""
    axes = _axes(axes)
    axes.imshow(image, cmap="gray", vmin=0, vmax=np.iinfo(image.dtype).max if image.dtype == np.uint8 else None)
    axes.set_axis_off()
    return axes


def _draw_wall(axes, session, pair, low, high):
    from matplotlib.collections import PolyCollection
    vertices, triangles = session.wall[:, pair] * 1e3, session.world.triangles
    if not len(triangles):
        return
    corners = vertices[triangles]
    visible = ((corners.max(1) >= low) & (corners.min(1) <= high)).all(1)
    axes.add_collection(PolyCollection(corners[visible], facecolor="#f2d5d0", edgecolor="none", antialiased=False))


def _axes(axes):
    if axes is not None:
        return axes
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("endovascular_sim.plots needs matplotlib: install python3-matplotlib") from error
    return pyplot.subplots()[1]
