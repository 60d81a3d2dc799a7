# SPDX-License-Identifier: GPL-3.0-or-later
"""yield_lists.py FIRST LISTS [TRUTH [INCREMENTS]]: estimates of --yield on random lists of loads.

Seeds FIRST, FIRST + 1, ...: a self-affine or curved map of 3 x 5 to 64 x 64 nodes, periodic or, a third of them, free;
a yield stress and a hardening modulus; and one load, up-0-up, up-down-higher or three loads up. Each list is solved in
INCREMENTS (16; also auto, or 16,half) and against it in 512 (192 from 48 x 48 on, and for auto three times as many, from 48 to 200), with
contacts to 1e-5 and twice as many slabs (at most 160), by the rc-solve TRUTH (default: the one in the path). Prints a line for each load, and at the end the share of estimates below 0.99 of the error, their median and
their 90 % point, and the applications. Fails if more than 2.5 %, or 1 % with a companion run, of the estimates of errors above
1e-5 are below the error. On a free map the estimate is compared without the part for the edge of the map, which both
runs have in common.
"""
import json
import os
import subprocess
import sys
import tempfile

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'python'))
import rcg

SIDES = [(3, 5), (8, 8), (12, 16), (16, 16), (20, 20), (24, 24), (24, 32), (32, 32), (48, 48), (64, 64)]
WEIGHTS = [1, 2, 4, 8, 6, 6, 3, 3, 1, 0.5]
KINDS = {'one': [1], 'up0up': [1, 0, 1], 'updownhigher': [1, 0.5, 1.3], 'threeup': [0.5, 1, 1.5]}


def surface(random, seed, shape, path):
    """Writes heights with spacings of 1 um."""
    ny, nx = shape
    if min(shape) < 8 or random.random() < 0.25:
        y, x = numpy.mgrid[:ny, :nx]
        r2 = (x - nx / 2 + random.random()) ** 2 + (y - ny / 2 + random.random()) ** 2
        heights = -r2 * 1e-12 / (2 * 1e-6 * max(shape) * random.uniform(2, 8))
        heights += random.uniform(0, 0.02) * 1e-6 * random.standard_normal(shape) * (random.random() < 0.5)
        rcg.write(path, [rcg.frame('height', heights, 1e-6)])
        return
    side = min(shape)
    subprocess.run(['rc-synth', 'selfaffine', '--nx', str(nx), '--ny', str(ny), '--dx', '1um', '--hurst',
                    f'{random.uniform(0.5, 0.9):.3f}', '--rms-slope', f'{random.uniform(0.05, 0.25):.3f}',
                    '--short-cut', f'{random.uniform(2, 6):.2f}um', '--rolloff', f'{max(6, random.uniform(0.5, 1) * side):.2f}um',
                    '--seed', str(seed), '-o', path], check=True)


def pressures(tool, surface_file, options, where):
    """Reports and pressures of the cases; None if the tool refuses the problem."""
    report, out = os.path.join(where, 'report.json'), os.path.join(where, 'out.rcg')
    done = subprocess.run([tool, '--quiet', *options, '--output', 'pressure', '--report', report, '-o', out, surface_file],
                          capture_output=True, text=True)
    if done.returncode not in (0, 3):
        return None
    with open(report) as file:
        return [json.loads(line) for line in file], rcg.read(out)


def draw(seed):
    random = numpy.random.default_rng(seed)
    shape = SIDES[random.choice(len(SIDES), p=numpy.array(WEIGHTS) / sum(WEIGHTS))]
    kind = list(KINDS)[seed % len(KINDS)]
    periodic = random.random() < 2 / 3
    stress = 10 ** random.uniform(-0.5, 0.6)  # GPa
    hardening = 0 if random.random() < 0.25 else stress * 10 ** random.uniform(-1, 1.3)
    mean = stress * random.uniform(0.03, 0.6 if periodic else 0.15)
    loads = ','.join('0' if f == 0 else f'{f * mean:.5g}GPa' for f in KINDS[kind])
    options = ['--mean-pressure', loads, '--E1', '210GPa', '--nu1', '0.3', '--E2', 'rigid', '--history',
               '--yield', f'{stress:.4g}GPa,{hardening:.4g}GPa'] + ['--periodic'] * periodic
    return random, shape, kind, periodic, options


def main(first, lists, truth='rc-solve', increments='16'):
    told, applications = [], {}
    with tempfile.TemporaryDirectory() as where:
        file = os.path.join(where, 'surface.rcg')
        for seed in range(int(first), int(first) + int(lists)):
            random, shape, kind, periodic, options = draw(seed)
            surface(random, seed, shape, file)
            fine = '192' if min(shape) >= 48 else '512'
            asked = pressures('rc-solve', file, options + ['--increments', increments], where)
            if asked and increments == 'auto':
                fine = str(min(max(48, 3 * max(report['increments'] or 0 for report in asked[0])), 200))
            slabs = min(2 * max(report['slabs'] or 1 for report in asked[0]), 160) if asked else 1
            exact = asked and pressures(truth, file, options + ['--increments', fine, '--tol', '1e-5', '--slabs', str(slabs)], where)
            if not exact:
                print(seed, kind, shape, 'refused')
                continue
            for k, (report, ours, theirs) in enumerate(zip(asked[0], asked[1], exact[1])):
                if report['applications'] is None:
                    continue
                use = 'first' if k == 0 else {'up0up': ['', 'unload', 'reload'], 'updownhigher': ['', 'unload', 'higher'],
                                              'threeup': ['', 'higher', 'higher']}[kind][k]
                applications.setdefault(use, []).append(report['applications'])
                if not abs(theirs.values).sum() > 0 or report['pressure_error_estimate'] is None:
                    continue
                error = abs(ours.values - theirs.values).sum() / abs(theirs.values).sum()
                estimate = report['pressure_error_estimate'] - (report.get('image_error_estimate') or 0)
                told.append((error, estimate))
                print(seed, kind, 'x'.join(map(str, shape)), 'periodic' if periodic else 'free', use,
                      f"{report['applications']} applications, error {error:.2e}, told {estimate:.2e}, {estimate / error:.2f}",
                      'BELOW' if estimate < 0.99 * error else '', flush=True)
    error, estimate = numpy.array(told).T
    large = error > 1e-5
    ratio = estimate[large] / error[large]
    below = (ratio < 0.99).mean()
    print(f'{len(error)} loads, {large.sum()} errors above 1e-5: {(ratio < 0.99).sum()} estimates below ({100 * below:.1f} %), '
          f'{(estimate < 0.99 * error).sum()} of all; least {ratio.min():.2f}, median {numpy.median(ratio):.1f}, '
          f'90 % {numpy.quantile(ratio, 0.9):.1f}; median error {numpy.median(error):.1e}')
    for use, counts in applications.items():
        print(f'{use}: {len(counts)} loads, mean {numpy.mean(counts):.1f}, median {numpy.median(counts):.0f} applications')
    return 0 if below <= (0.01 if increments.endswith('half') else 0.025) else 1


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
