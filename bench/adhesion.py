#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The cost of adhesion on many surfaces: convolutions of a state, with stability and certificate.

    bench/adhesion.py TOOLS [SIDES [TOL]]      TOOLS holds rc-solve and rc-synth; SIDES 256,512,1024; TOL 1e-4
    bench/adhesion.py TOOLS pull-off SEED [MAPS [SIDES]]      MAPS 60; SIDES 32,64, the least and the largest

The first two cases are those of bench/peers/adhesion.py. The other sixteen differ in law, roughness, control, boundary, coat,
hardness and sides. A dash: not converged. The spacing and E* are 1.

`pull-off` draws the heights, sides, boundary and law of each map. The pull-off load is compared with the lowest load of a
retraction in 160 equal steps, of which the three beside this load are repeated in 96. A miss above 0: the search found a
higher load. With one number as SIDES there is no comparison.
"""
import json
import os
import random
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'python'))
import rcg

# law, sigma0/E*, cohesive length, Hurst exponent, slope, shortest wave, seed, control and its value, sides over n, more options.
# An approach is a fraction of the height of the highest node above the mean; a pressure is a fraction of E*.
BALL = 'ball', 1  # added to a square map
COAT = ['--layer', '8,4,0.3', '--E1', '0.91', '--nu1', '0.3', '--E2', 'rigid']
CASES = [
    ('exponential', .05, 8, .8, .1, 8, 1, 'approach', [.6], (1, 1), ['--periodic']),
    ('exponential', .1, 4, .8, .1, 8, 1, 'approach', [.85], (1, 1), ['--periodic']),
    ('exponential', .05, 8, .8, .1, 8, 2, 'approach', [.5], (1, 1), ['--periodic']),
    ('exponential', .1, 4, .8, .1, 4, 3, 'approach', [.7], (1, 1), ['--periodic']),
    ('exponential', .1, 2, .8, .1, 2, 4, 'approach', [.6], (1, 1), ['--periodic']),
    ('exponential', .03, 12, .5, .1, 16, 5, 'approach', [.8], (1, 1), ['--periodic']),
    ('exponential', .1, 4, .8, .2, 8, 6, 'mean-pressure', [.02], (1, 1), ['--periodic']),
    ('exponential', .05, 8, .8, .1, 8, 7, 'mean-pressure', [0], (1, 1), ['--periodic']),
    ('exponential', .05, 4, .8, .1, 8, 8, 'mean-pressure', [.005, -1e-5], (1, 1), ['--periodic']),
    ('exponential', .05, 8, .8, .1, 8, 9, 'approach', [.5], (1, 1), []),
    ('exponential', .1, 4, .8, .1, 8, 10, 'mean-pressure', [.01], (1, 1), []),
    ('exponential', .05, 4, .8, .05, 8, 11, 'mean-pressure', [0], BALL, []),
    ('compact', .05, 8, .8, .1, 8, 12, 'approach', [.6], (1, 1), ['--periodic']),
    ('dugdale', .05, 8, .8, .1, 8, 13, 'approach', [.6], (1, 1), ['--periodic']),
    ('jkr', .05, 8, .8, .1, 8, 14, 'approach', [.5], (1, 1), ['--periodic']),
    ('exponential', .05, 8, .8, .1, 8, 15, 'approach', [.5], (1, 1), ['--periodic', *COAT]),
    ('exponential', .05, 8, .8, .1, 8, 16, 'mean-pressure', [.02], (1, 1), ['--periodic', '--hardness', '0.3']),
    ('exponential', .05, 8, .8, .1, 8, 17, 'approach', [.5], (1, .75), ['--periodic']),
]


def posed(tools, n, case):
    """The surface of a case, as a stream, and the options of rc-solve."""
    law, strength, ell, hurst, slope, wave, seed, control, values, sides, more = case
    nx, ny = (n if sides[1] == 1 else int(n * s) - 1 for s in sides)
    surface = ['--nx', nx, '--ny', ny, '--dx', 1, '--hurst', hurst, '--rms-slope', slope, '--short-cut', wave, '--rolloff', n / 4,
               '--seed', seed]
    stream = subprocess.run([tools / 'rc-synth', 'selfaffine', *map(str, surface)], stdout=subprocess.PIPE, check=True).stdout
    heights = rcg.loads(stream)[0].values
    if control == 'approach':
        values = [v * (heights.max() - heights.mean()) for v in values]
    work = ell * strength ** 2 * {'compact': 2 / 3}.get(law, 1)
    reach = {'jkr': '', 'compact': f',{3 * work / strength!r}'}.get(law, f',{work / strength!r}')
    options = [*more, *(['--radius', 8 * n] if sides[0] == 'ball' else []), *([] if '--E1' in more else ['--estar', 1])]
    options += ['--adhesion', f'{work!r},{law}{reach}', f'--{control}=' + ','.join(repr(float(v)) for v in values)]
    return stream, list(map(str, options))


def solve(tools, n, tol, case, folder):
    stream, options = posed(tools, n, case)
    subprocess.run([tools / 'rc-solve', '--quiet', *options, '--tol', tol, '--output', 'pressure', '--report', folder / 'r.json',
                    '-o', folder / 'p.rcg'], input=stream, check=False)
    return json.loads((folder / 'r.json').read_text().splitlines()[-1])


def main(tools, sides='256,512,1024', tol='1e-4'):
    columns = 'convolutions', 'iterations', 'stability', 'contact_fraction', 'pressure_error_estimate'
    for n in map(int, sides.split(',')):
        counts = []
        print(f'| {n} | {" | ".join(columns)} | seconds |\n|' + ' --- |' * (len(columns) + 2))
        for case in CASES:
            with tempfile.TemporaryDirectory() as folder:
                r = solve(Path(tools), n, tol, case, Path(folder))
            counts.append(r['convolutions'] if r['converged'] else float('inf'))
            title = ' '.join(map(str, [*case[:7], case[7][:4], *case[8], *case[9], *case[10][:2]]))
            figures = ' | '.join('-' if r[c] is None or not r['converged'] else f'{r[c]:.3g}' for c in columns)
            print(f'| {title} | {figures} | {r["seconds"]["total"]:.3g} |', flush=True)
        print(f'| median, largest | {statistics.median(counts):.3g}, {max(counts):.3g} |' + ' |' * len(columns) + '\n', flush=True)


def drawn(tools, r, sides):
    """A random surface, as a stream, with the options of rc-solve, and the first approach."""
    n, wave, ell, strength = r.randint(sides[0], sides[-1]), r.choice([2, 4, 8]), r.uniform(1, 8), 10 ** r.uniform(-2.5, -1)
    law, boundary = r.choice(['exponential', 'exponential', 'compact', 'dugdale']), r.choice(['free', 'periodic'])
    surface = ['--nx', n, '--ny', n, '--dx', 1, '--hurst', .8, '--rms-slope', 10 ** r.uniform(-2, -.7), '--short-cut', wave,
               '--rolloff', n / 4, '--seed', r.randrange(10 ** 6)]
    stream = subprocess.run([tools / 'rc-synth', 'selfaffine', *map(str, surface)], stdout=subprocess.PIPE, check=True).stdout
    heights = rcg.loads(stream)[0].values
    work, reach = ell * strength ** 2, ell * strength * (1.5 if law == 'compact' else 1)
    options = ['--estar', '1', '--adhesion', f'{work!r},{law},{reach!r}', *['--periodic'] * (boundary == 'periodic')]
    first = r.uniform(.2, 1.1) * float(heights.max() - heights.mean())
    return f'{n} {boundary} {law} {strength:.3f} {ell:.1f}', stream, options, first


def retract(tools, stream, options, approaches, more=()):
    """The rows of the report, and the messages."""
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / 'r.json'
        path = '--approach=' + ','.join(repr(float(v)) for v in approaches)
        run = subprocess.run([tools / 'rc-solve', '--verbose', *options, '--tol', '1e-4', path, *more, '--output', 'pressure', '--report', rows,
                              '-o', Path(folder) / 'p.rcg'], input=stream, check=False, stderr=subprocess.PIPE)
        return [json.loads(row) for row in rows.read_text().splitlines()] if rows.exists() else [], run.stderr.decode()


def truth(tools, stream, options, first, last):
    """The lowest load of a retraction in equal steps; those beside it are repeated in shorter steps."""
    way = [first + (last - first) * k / 160 for k in range(161)]
    loads = [row['load'] for row in retract(tools, stream, options, way)[0]]
    k = min(range(len(loads)), key=loads.__getitem__)
    a, b = max(k - 2, 0), min(k + 1, 160)
    way[a:] = [way[a] + (way[b] - way[a]) * i / 96 for i in range(97)]
    return min(loads[k], *[row['load'] for row in retract(tools, stream, options, way)[0]])


def pull_off(tools, seed, maps='60', sides='32,64'):
    sides, figures = list(map(int, sides.split(','))), []
    columns = 'map, law, sigma0/E*, cohesive length', 'states', 'convolutions', 'pull-off load', 'spread', 'miss', 'miss over spread'
    print(f'| {" | ".join(columns)} |\n|' + ' --- |' * 7)
    for k in range(int(maps)):
        title, stream, options, first = drawn(tools, random.Random(1000 * int(seed) + k), sides)
        rows, said = retract(tools, stream, options, [first], ['--pull-off'])
        if not rows or rows[-1].get('pull_off_load') is None:
            print(f'| {k} {title} | {said.splitlines()[-1]} |' + ' |' * 5, flush=True)
            continue
        r = rows[-1]
        states = int(re.search(r'(\d+) states', said)[1])
        load, spread, at = (r['pull_off_' + name] for name in ('load', 'spread', 'approach'))
        miss = load - truth(tools, stream, options, first, at - .6 * (first - at)) if len(sides) > 1 else float('nan')
        figures.append((spread / abs(load), miss / abs(load), miss / max(spread, 1e-300), states, r['convolutions']))
        print(f'| {k} {title} | {states} | {r["convolutions"]:.0f} | {load:.5e} | {spread / abs(load):.2e} | {miss / abs(load):.2e} | '
              f'{figures[-1][2]:.3g} |', flush=True)
    spreads, misses, ratios, counts, convolutions = zip(*figures)
    print(f'\n{sum(v > 1 for v in ratios)} of {len(ratios)} misses exceed the spread, by at most '
          f'{max(0, *(m - s for m, s in zip(misses, spreads))):.2e} of the load. '
          f'Spread: median {statistics.median(spreads):.2e}, largest {max(spreads):.2e}. '
          f'States: median {statistics.median(counts):.0f}. Convolutions: median {statistics.median(convolutions):.0f}.')


if __name__ == '__main__':
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.environ.setdefault('RC_THREADS', '1')
    tools, *rest = sys.argv[1:]
    pull_off(Path(tools), *rest[1:]) if rest[:1] == ['pull-off'] else main(tools, *rest)
