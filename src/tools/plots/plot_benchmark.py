#!/usr/bin/python3
"""Draws the plots of `benchmark` from the CSV files of a folder into that folder."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import tool_support as tools  # noqa: E402

plt = tools.pyplot()

COLOURS = {'kkt': 'tab:blue', 'paper': 'tab:orange', 'mixed': 'tab:green', 'SOFA BeamAdapter': 'tab:red',
           'PositionBasedDynamics': 'tab:purple', 'DisMech': 'tab:brown'}
MARKERS = {'kkt': 'o', 'paper': 's', 'mixed': 'D', 'SOFA BeamAdapter': '^', 'PositionBasedDynamics': 'v', 'DisMech': 'P'}


def rows_of(folder, name):
    """Rows of a table; an empty list for a study that was not run."""
    path = folder / f'{name}.csv'
    return list(tools.read_rows(path)) if path.exists() else []


def value(row, key):
    """Cell as a number; None for an empty cell."""
    try:
        return float(row[key])
    except ValueError:
        return None


def grouped(rows, *keys):
    """Rows by the values of the key columns, in order of appearance."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return groups


def curve(axes, rows, x, y, **style):
    """Draws a line through the points with two positive values."""
    points = [(value(row, x), value(row, y)) for row in rows]
    points = [(a, b) for a, b in points if a is not None and b is not None and a > 0 and b > 0]
    if points:
        axes.plot([a for a, _ in points], [b for _, b in points], **style)


def finish(axes, title, x, y):
    """Sets logarithmic axes with labels and title."""
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set_title(title, fontsize=10)
    axes.grid(True, which='both', alpha=0.3)


def save(figure, folder, name):
    """Writes a figure."""
    figure.tight_layout()
    figure.savefig(folder / name, dpi=110)
    plt.close(figure)


def panels(count):
    """Figure with a number of axes in rows of three."""
    columns = min(count, 3)
    lines = -(-count // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(5 * columns, 4 * lines), squeeze=False)
    flat = [axis for line in axes for axis in line]
    for axis in flat[count:]:
        axis.set_visible(False)
    return figure, flat


def draw_accuracy(folder):
    """Draws the tip error over nodes, a panel per problem."""
    problems = grouped(rows_of(folder, 'accuracy'), 'problem')
    if not problems:
        return
    figure, axes = panels(len(problems))
    for axis, ((problem,), rows) in zip(axes, problems.items()):
        for (scheme,), points in grouped(rows, 'scheme').items():
            curve(axis, points, 'nodes', 'tip error / L', color=COLOURS[scheme], marker=MARKERS[scheme], label=scheme)
        finish(axis, problem, 'nodes', 'tip error / L')
        axis.legend(fontsize=8)
    save(figure, folder, 'accuracy.png')


def draw_static(folder):
    """Draws the static error over the time per step."""
    problems = grouped(rows_of(folder, 'work_precision_static'), 'problem')
    if not problems:
        return
    figure, axes = panels(len(problems))
    for axis, ((problem,), rows) in zip(axes, problems.items()):
        for (scheme,), points in grouped(rows, 'scheme').items():
            curve(axis, points, 'µs per step', 'tip error / L', color=COLOURS[scheme], marker=MARKERS[scheme], label=scheme,
                  linestyle='--' if points[0]['note'] == 'measured' else '-')
        finish(axis, problem, 'µs per step of 1 ms', 'tip error at rest / L')
        axis.legend(fontsize=8)
    save(figure, folder, 'work_precision_static.png')


def draw_dynamic(folder):
    """Draws the error of the falling wire over run time, a line per scheme and number of nodes with varying Δt."""
    groups = grouped(rows_of(folder, 'work_precision_dynamic'), 'scheme', 'nodes')
    if not groups:
        return
    figure, axis = plt.subplots(figsize=(7, 5))
    for k, ((scheme, nodes), rows) in enumerate(groups.items()):
        curve(axis, rows, 'ms for 0.2 s', 'tip error / L', color=COLOURS[scheme], marker=MARKERS[scheme], label=f'{scheme}, {nodes}',
              alpha=(0.45, 0.7, 1.0)[k % 3])
    finish(axis, 'falling wire after 0.2 s; lines: Δt from 4 to 0.25 ms', 'computing time [ms]', 'tip error / L')
    axis.legend(fontsize=8)
    save(figure, folder, 'work_precision_dynamic.png')


def draw_vessel(folder):
    """Draws the distance to the reference over the computing time per second of motion."""
    groups = grouped(rows_of(folder, 'work_precision_vessel'), 'scheme', 'sampling')
    if not groups:
        return
    figure, axis = plt.subplots(figsize=(7, 5))
    for (scheme, sampling), rows in groups.items():
        points = [dict(row, load=str(1.0 / value(row, 'real-time factor')) if value(row, 'real-time factor') else '')
                  for row in rows]
        adaptive = 'adaptive' in sampling
        curve(axis, points, 'load', 'RMS distance [mm]', color=COLOURS[scheme], marker='*' if adaptive else MARKERS[scheme],
              markersize=12 if adaptive else 6, linestyle='--' if adaptive else '-',
              label=f"{scheme}, {sampling.strip('{}').replace('kind: ', '')}")
    finish(axis, 'wire in aortic_arch_tree.obj; lines: varying Δt', 'computing time per simulated time', 'RMS distance to the reference [mm]')
    axis.legend(fontsize=7)
    save(figure, folder, 'work_precision_vessel.png')


def draw_speed(folder):
    """Draws the time per step over nodes."""
    groups = grouped(rows_of(folder, 'speed_growth'), 'scheme')
    if not groups:
        return
    figure, axis = plt.subplots(figsize=(6, 4.5))
    for (scheme,), rows in groups.items():
        curve(axis, rows, 'nodes', 'µs per step', color=COLOURS[scheme], marker=MARKERS[scheme], label=scheme)
    finish(axis, 'step without contact', 'nodes', 'µs per step')
    axis.legend()
    save(figure, folder, 'speed.png')


def draw_volumes(folder):
    """Draws the time of both queries per bounding volume, a panel per mesh."""
    meshes = grouped(rows_of(folder, 'contact_volumes'), 'mesh', 'triangles')
    if not meshes:
        return
    figure, axes = panels(len(meshes))
    for axis, ((mesh, triangles), rows) in zip(axes, meshes.items()):
        positions = range(len(rows))
        for shift, key in ((-0.2, 'collect [µs]'), (0.2, 'nearest [µs]')):
            axis.bar([k + shift for k in positions], [value(row, key) for row in rows], width=0.4, label=key)
        axis.set_xticks(list(positions))
        axis.set_xticklabels([row['volume'] for row in rows], rotation=20, fontsize=8)
        axis.set_ylabel('µs per query')
        axis.set_title(f'{mesh}, {triangles} triangles', fontsize=10)
        axis.legend(fontsize=8)
    save(figure, folder, 'contact_volumes.png')


def draw_growth(folder):
    """Draws the detection time over the number of triangles of one surface."""
    rows = rows_of(folder, 'contact_growth')
    if not rows:
        return
    figure, axis = plt.subplots(figsize=(6, 4.5))
    same = [row for row in rows if row['mesh'] == rows[0]['mesh']]
    others = [row for row in rows if row['mesh'] != rows[0]['mesh']]
    for key, colour in (('steady [µs]', 'tab:blue'), ('cold [µs]', 'tab:red'), ('nearest triangle [µs]', 'tab:green')):
        curve(axis, same, 'triangles', key, color=colour, marker='o', label=key)
        curve(axis, others, 'triangles', key, color=colour, marker='*', markersize=12, linestyle='')
    finish(axis, '380 nodes on the wall; stars: aorta_coronary_female.obj', 'triangles', 'µs')
    axis.legend(fontsize=8)
    save(figure, folder, 'contact_growth.png')


def draw_sampling(folder):
    """Draws the distance to the reference over the time per step, a panel per case."""
    cases = grouped(rows_of(folder, 'sampling_runs'), 'case')
    if not cases:
        return
    figure, axes = panels(len(cases))
    for axis, ((case,), rows) in zip(axes, cases.items()):
        for row in rows[1:]:  # the first row is the reference
            curve(axis, [row], 'µs per step', 'RMS distance [mm]', marker='*' if 'adaptive' in row['sampling'] else 'o',
                  linestyle='', markersize=13 if 'adaptive' in row['sampling'] else 7, label=row['sampling'])
        finish(axis, case, 'µs per step', 'RMS distance to uniform 0.125 mm [mm]')
        axis.set_xscale('linear')  # logarithmic ticks of less than a decade overlap
        axis.legend(fontsize=7)
    save(figure, folder, 'sampling.png')


def draw_hand_force(folder):
    """Draws the force at the hand (C: torque; D: force on the tip) over insertion."""
    charts = grouped(rows_of(folder, 'hand_force_curves'), 'panel')
    if not charts:
        return
    panels = {'A': ('pushing speed', 'force [mN]', 'force at the hand [mN]'),
              'B': ('bending modulus', 'force [mN]', 'force at the hand [mN]'),
              'C': ('shear modulus, angle of twist', 'torque [µN·m]', 'torque at the hand [µN·m]'),
              'D': ('shape of the tip', 'tip [mN]', 'force on the tip [mN]')}
    figure, axes = plt.subplots(2, 2, figsize=(11, 8))
    for axis, ((panel,), rows) in zip(axes.flat, charts.items()):
        title, key, label = panels[panel]
        for (name,), points in grouped(rows, 'curve').items():
            axis.plot([value(p, 'insertion [mm]') for p in points], [value(p, key) for p in points], linewidth=1.2,
                      label=name)
        axis.set_xlabel('insertion [mm]')
        axis.set_ylabel(label)
        axis.set_title(f'{panel}: {title}', fontsize=10)
        axis.grid(True, alpha=0.3)
        axis.legend(fontsize=8)
    save(figure, folder, 'hand_force.png')


def draw_reversal(folder):
    """Draws the torque at the hand over the angle of the hand, a panel per case and a line per motion."""
    cases = grouped(rows_of(folder, 'reversal_curves'), 'case')
    if not cases:
        return
    figure, axes = plt.subplots(1, len(cases), figsize=(6 * len(cases), 4.5), squeeze=False)
    for axis, ((case,), rows) in zip(axes.flat, cases.items()):
        for k, ((rate, step), points) in enumerate(grouped(rows, 'rate [rad/s]', 'step [ms]').items()):
            reference = k == 0
            axis.plot([value(p, 'angle [rad]') for p in points], [value(p, 'torque [µN·m]') for p in points],
                      linewidth=3 if reference else 1, color='black' if reference else None,
                      alpha=0.4 if reference else 1, label=f'{rate} rad/s, {step} ms')
        axis.set_xlabel('angle of the hand [rad]')
        axis.set_ylabel('torque at the hand [µN·m]')
        axis.set_title(case, fontsize=10)
        axis.grid(True, alpha=0.3)
        axis.legend(fontsize=7)
    save(figure, folder, 'reversal.png')


def draw_mouth(folder):
    """Draws the force at the hand over the inserted length while an instrument passes the introducer's mouth."""
    cases = {key: rows for key, rows in grouped(rows_of(folder, 'mouth'), 'instrument', 'nodes', 'speed [mm/s]', 'tube').items()
             if key[1] == 'adaptive' and value(rows[0], 'speed [mm/s]') == 25}
    if not cases:
        return
    figure, axes = panels(len(cases))
    for axis, ((instrument, _, _, tube), rows) in zip(axes, cases.items()):
        at = [value(row, 'inserted length [mm]') for row in rows]
        axis.plot(at, [value(row, 'reference [N]') for row in rows], color='black', linewidth=3, alpha=0.4, label='reference')
        for way, style in (('in [N]', '-'), ('out [N]', '--')):
            axis.plot(at, [value(row, way) for row in rows], style, linewidth=1, label=way.split()[0])
        axis.set_xlabel('inserted length [mm]')
        axis.set_ylabel('force at the hand [N]')
        axis.set_title(f'{instrument}, {tube} tube', fontsize=10)
        axis.grid(True, alpha=0.3)
        axis.legend(fontsize=8)
    save(figure, folder, 'mouth.png')


def main():
    """Draws the plots of all tables in the folder."""
    parser = tools.argument_parser(__doc__)
    parser.add_argument('folder', type=pathlib.Path, help='folder with the CSV files of `benchmark`')
    folder = parser.parse_args().folder
    for draw in (draw_accuracy, draw_static, draw_dynamic, draw_vessel, draw_speed, draw_volumes, draw_growth,
                 draw_sampling, draw_hand_force, draw_reversal, draw_mouth):
        draw(folder)


if __name__ == '__main__':
    main()
