"""Runs the wire and the motion of the published benchmark (config/scenes/peer_wire.yaml) from many initial hand angles.

At bifurcations the outcome is chaotic, so a single run is no evidence. This command runs an ensemble in the generated anatomy
and, if available, in the benchmark's own mesh, and checks every run against the limits of the project.
"""

import math
import os
import pathlib
import statistics
import sys

from .. import command, tables

EXIT_CODES = 'Exit code: 0 all runs are within the limits; 1 some are not, or a run failed; 2 wrong arguments.'
# Limits of every run; a wire locked in a closed branch (the hand slips) may penetrate deeper.
MAX_PENETRATION = 0.1e-3        # m
MAX_PENETRATION_LOCKED = 0.35e-3  # m
MAX_STRAIN = 1e-3
# Reported goals, not part of the verdict because they depend on the machine: mean real-time factor on one core and 99th
# percentile of a step [us], by speed of the push [m/s].
GOALS = {0.035: (15.0, 300.0), 0.1: (8.0, 300.0), 0.5: (2.0, None)}
TRAVEL = 0.4                    # m, travel of the scene's drive
END = 0.4042                    # m, final insertion unless the wire locks
SPARE_TIME = 0.07               # s, simulated time after the push


def vessels(mesh):
    """Name and overrides of every vessel."""
    generated = ['vessel.unit=null', 'vessel.anatomy=anatomies/plain.yaml', 'entry.position=null',
                 'entry.direction=null', 'entry.up=null', 'entry.centreline_end=right_common_femoral',
                 'entry.offset=0.005']
    chosen = [('generated', generated)]
    if mesh:
        chosen.insert(0, (pathlib.Path(mesh).stem, [f'vessel.mesh={mesh}']))
    return chosen


def run_once(scene, overrides, speed, angle, folder, seconds):
    """Simulates the scene once; returns the content of result.json."""
    motion = [f'drive.speed={speed}', f'drive.initial_rotation={angle:.17g}']
    command.simulate(scene, folder, motion + overrides, '--seconds', str(seconds or TRAVEL / speed + SPARE_TIME), accepted=(0, 1))
    return tables.read_json(folder / 'result.json')


def row_of(name, speed, angle, result):
    """Row of hand_angles.csv."""
    whole = result['steps'] * result['dt'] >= TRAVEL / speed
    locked = whole and result['inserted_length'] < END - 1e-3
    limit = MAX_PENETRATION_LOCKED if locked else MAX_PENETRATION
    broken = []
    if result['worst_surface_penetration'] > limit:
        broken.append('penetration')
    if result['nodes_outside'] > 0:
        broken.append('outside')
    if result['max_strain'] > MAX_STRAIN:
        broken.append('strain')
    if result['solver']['refused_steps'] > 0:
        broken.append('rejected')
    time = result['step_time_us']
    return {'vessel': name, 'speed_mm_s': round(1e3 * speed), 'angle_deg': round(math.degrees(angle), 1),
            'inserted_mm': round(1e3 * result['inserted_length'], 1), 'jammed': 'yes' if locked else 'no',
            'penetration_mm': round(1e3 * result['worst_surface_penetration'], 4),
            'nodes_outside': result['nodes_outside'], 'max_strain': f"{result['max_strain']:.1e}",
            'steps_strained': result['steps_with_strain_above_1e-4'],
            'hand_force_max_N': round(result['hand_force']['max'], 3),
            'refused_steps': result['solver']['refused_steps'],
            'real_time_factor': round(result['real_time_factor'], 1), 'step_median_us': round(time['median'], 1),
            'step_p99_us': round(time['p99'], 1), 'step_max_us': round(time['max'], 1),
            'steps': result['steps'], 'steps_over_300_us': time['over_300'],
            'trajectory_hash': result['trajectory_hash'],
            'verdict': 'good' if not broken else ' '.join(broken)}


def write(folder, rows):
    """Writes the table as CSV and as Markdown."""
    tables.write(folder / 'hand_angles.csv', rows)
    lines = [list(rows[0]), ['---'] * len(rows[0])] + [list(row.values()) for row in rows]
    (folder / 'hand_angles.md').write_text(''.join('| %s |\n' % ' | '.join(map(str, line)) for line in lines), encoding='utf-8')


def summary(name, speed, rows):
    """Summary of one vessel and speed in a line, with the goals of that speed."""
    factor = statistics.mean(row['real_time_factor'] for row in rows)
    slow = [row['step_p99_us'] for row in rows]
    factor_goal, step_goal = GOALS.get(speed, (None, None))
    goal = f' (goal {factor_goal:.0f} on one quiet core)' if factor_goal else ''
    limit = f' (goal {step_goal:.0f})' if step_goal else ''
    over = sum(row['steps_over_300_us'] for row in rows) / sum(row['steps'] for row in rows)
    return (f'{name}, {1e3 * speed:.0f} mm/s: {len(rows)} runs, mean real-time factor {factor:.1f}{goal}, '
            f'p99 of a step median {statistics.median(slow):.0f}, worst {max(slow):.0f} us{limit}, '
            f'{100 * over:.2f} % of all steps over 300 us, '
            f"deepest {max(row['penetration_mm'] for row in rows):.3f} mm")


def add_arguments(parser):
    parser.add_argument('--out', required=True, type=pathlib.Path, help='folder for the table and the runs')
    parser.add_argument('--mesh', help='aortic_arch_tree.obj of the benchmark [mm]; default: that of '
                                       'ENDOVASCULAR_DATA_DIR')
    parser.add_argument('--speeds', type=float, nargs='+', default=[0.035], metavar='M/S',
                        help='speeds of the push [0.035]; goals exist for 0.035, 0.1 and 0.5')
    parser.add_argument('--angles', type=int, default=16, help='number of initial hand angles [16]')
    parser.add_argument('--seconds', type=float, help='simulated time of each run [s]; default: until the push has ended')
    command.add_overrides(parser)


def run(options):
    """Runs the ensemble and writes the table after every run."""
    scene = command.find_scene('peer_wire.yaml')
    mesh = options.mesh
    if mesh is None and 'ENDOVASCULAR_DATA_DIR' in os.environ:
        candidate = pathlib.Path(os.environ['ENDOVASCULAR_DATA_DIR']) / 'aortic_arch_tree.obj'
        mesh = str(candidate) if candidate.exists() else None
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    cases = [(name, overrides, speed) for name, overrides in vessels(mesh) for speed in options.speeds]
    for name, overrides, speed in cases:
        for k in range(options.angles):
            angle = 2.0 * math.pi * k / options.angles
            print(f'{name}, {1e3 * speed:.0f} mm/s, hand angle {k + 1} of {options.angles} …', file=sys.stderr,
                  flush=True)
            folder = options.out / f'{name}_{1e3 * speed:.0f}_{k:02d}'
            folder.mkdir(exist_ok=True)
            result = run_once(scene, overrides + options.overrides, speed, angle, folder, options.seconds)
            rows.append(row_of(name, speed, angle, result))
            write(options.out, rows)
    bad = [row for row in rows if row['verdict'] != 'good']
    for name, _, speed in cases:
        print(summary(name, speed, [row for row in rows if row['vessel'] == name
                                    and row['speed_mm_s'] == round(1e3 * speed)]))
    print(f'{len(rows) - len(bad)} of {len(rows)} runs within all limits; table: {options.out}/hand_angles.md')
    return 1 if bad else 0
