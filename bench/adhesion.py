#!/usr/bin/env python3
"""The cost of adhesion on many surfaces: convolutions of a state, with stability and certificate.

    bench/adhesion.py TOOLS [SIDES [TOL]]      TOOLS holds rc-solve and rc-synth; SIDES 256,512,1024; TOL 1e-4

The first two cases are those of bench/peers/adhesion.py. The other sixteen differ in law, roughness, control, boundary, coat,
hardness and sides. A dash: not converged. The spacing and E* are 1.
"""
import json
import os
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


if __name__ == '__main__':
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.environ.setdefault('RC_THREADS', '1')
    main(*sys.argv[1:])
