"""The look of the pictures that are drawn into files."""

AXES = {"x": "x, to the left [mm]", "y": "y, to the back [mm]", "z": "z, to the head [mm]"}
VIEWS = {"from the front": ("x", "z"), "from the side": ("y", "z"), "from below": ("x", "y")}  # axes to the right and upwards

_STYLE = {"figure.constrained_layout.use": True, "savefig.dpi": 110, "axes.titlesize": "medium", "axes.grid": True,
          "grid.alpha": 0.3, "lines.linewidth": 1.1, "legend.fontsize": "small"}


def pyplot():
    """matplotlib.pyplot for drawing into files."""
    try:
        import matplotlib
        from matplotlib import pyplot as plt
    except ImportError as error:
        raise ImportError("%s; install the Debian package python3-matplotlib and use /usr/bin/python3" % error) from error
    matplotlib.use("Agg")
    matplotlib.rcParams.update(_STYLE)
    return plt


def figure(count=1, columns=3, panel=(5.0, 4.0), font=9, **more):
    """Figure with a number of axes in rows, and a list of them.

    panel  width and height of one [inch]
    font   size [point]
    """
    plt = pyplot()
    plt.rcParams["font.size"] = font
    columns = min(count, columns)
    rows = -(-count // columns)
    made, axes = plt.subplots(rows, columns, figsize=(panel[0] * columns, panel[1] * rows), squeeze=False, **more)
    for unused in axes.flat[count:]:
        unused.set_visible(False)
    return made, list(axes.flat[:count])


def save(made, path):
    """Writes a figure as a picture and closes it."""
    made.savefig(path)
    pyplot().close(made)


def draw_along(axes, points, view, *style, **more):
    """Draws points of the patient frame, a table or an array by column [m], as seen along a view of VIEWS [mm]."""
    across, up = view
    axes.plot(1e3 * points[across], 1e3 * points[up], *style, **more)
    axes.set(xlabel=AXES[across], ylabel=AXES[up])
    axes.set_aspect("equal", adjustable="datalim")


def logarithmic(axes, title, x, y):
    """Logarithmic axes with labels and title."""
    axes.set(xscale="log", yscale="log", xlabel=x, ylabel=y, title=title)
    axes.grid(True, which="both")
