# SPDX-License-Identifier: GPL-3.0-or-later
"""estimates.py hist|adhesion|tilt|maps|first|grid|heat|passes SEED COUNT BIN: compares estimated and true error of the pressure
for random contacts.

hist      lists of loads with a hardness and --history         truth: the same list with --tol 1e-8
adhesion  paths with --adhesion, a fifth on 64 to 150 nodes     truth: the same path with --tol 1e-8
tilt      --tilt free, most of them with a hardness            truth: the same contact with --tol 1e-9
maps      free maps, of them two thirds with --yield and one   truth: the contact on a map that is two or three times
          third with a hardness                                as wide, in 96 increments, with --tol 1e-6
first     bodies with --yield near first yield, all boundaries  truth: rc-stress: its largest Mises stress is 1.02 to 1.3
                                                               times the yield stress, so that the body yields
grid      elastic contacts with --discretization, all           truth: figures of the same waves on nodes 4 and 8 times as
          boundaries                                            dense, extrapolated
heat      rc-heat --time, all boundaries                        truth: 64 time steps, extrapolated with 32
passes    --travel --passes of rollers and balls that yield     truth: steps of an eighth and a sixteenth, 32 increments
BIN holds rc-solve and rc-synth. Case c of SEED draws from the seed SEED * 100003 + c. Prints a line for each state whose
estimate is below 0.99 of an error above 1e-6, and at the end the shares of such states. Status 1 where an error above 1e-5
has such an estimate. "first" prints the bodies that remain elastic. Status 1 where one above 1.05 has no warning, or where they
are more than 2 %. "grid" leaves out a figure whose two truths differ by more than a tenth of its error. Status 1 where a figure
whose estimate is below its error, or where the largest pressure grows by half without a warning. "heat" leaves out a case whose
truths (32 and 64 time steps) differ by more than a tenth of its error. Status 1 where more than 1 % of the estimates are below their
errors. "passes" counts the positions after steps with and without a warning of long steps or of few voxels that flow. Status 1
where an estimate without it is below its error.
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'python'))
import rcg

MODULUS = 1e9  # Pa
STEP = 1e-6    # m


class Case:
    """A surface, the options of rc-solve for it, and the options for its reference solution."""

    def __init__(self, surface, options, tight, wide=None, tol=()):
        self.surface, self.options, self.tight, self.tol = surface, options, tight, list(tol)
        self.wide = surface if wide is None else wide


def synth(kind, shape, *options):
    ny, nx = shape
    return subprocess.run([os.path.join(BIN, 'rc-synth'), kind, '--nx', str(nx), '--ny', str(ny), '--dx', '1um', *options],
                          capture_output=True).stdout


def selfaffine(r, shape, rms):
    return synth('selfaffine', shape, '--hurst', '0.8', '--rms-height', repr(rms), '--short-cut', '%gum' % r.choice([2, 4, 8]),
                 '--seed', str(r.randrange(10 ** 6)))


def hist_or_path(r, kind):
    least, most = (64, 150) if kind == 'adhesion' and r.random() < 0.2 else (12, 36)
    nx = r.randint(least, most)
    ny = r.choice([1 if most < 64 else nx, nx, r.randint(least * 2 // 3, most)])
    rms = 10 ** r.uniform(-8, -6.7)
    options = ['--estar', repr(MODULUS)] + ['--periodic'] * (r.random() < 0.5)
    surface = selfaffine(r, (ny, nx), rms)
    area, slope = nx * ny * STEP ** 2, rms / (max(nx, ny) * STEP / 4)
    if not surface:
        return None
    if kind == 'hist':
        hardness = MODULUS * slope * 10 ** r.uniform(-1.3, 0.3)
        n = r.randint(2, 5)
        top = hardness * area * 10 ** r.uniform(-2, -0.1)
        loads = [top * r.uniform(0.1, 1) for _ in range(n)]
        return Case(surface, options + ['--history', '--hardness', repr(hardness), '--load', ','.join(map(repr, loads))],
                    ['--tol', '1e-8'])
    rho = STEP * 10 ** r.uniform(-2, -0.7)
    work = MODULUS * rho * rho / (r.choice([1.5, 2, 4, 8]) * STEP)
    law = r.choice(['exponential', 'dugdale', 'compact', 'jkr', 'exponential'])
    reach = '' if law == 'jkr' else ',%r' % (rho * (1 if law == 'exponential' else 3))
    n = r.randint(1, 4)
    approaches = [rms * r.uniform(-1, 1.2) for _ in range(n)]
    options += ['--adhesion', '%r,%s%s' % (work, law, reach)]
    if r.random() < 0.3:
        options += ['--hardness', repr(work / rho * 10 ** r.uniform(0.3, 1.3))]
    if r.random() < 0.15:
        options += ['--layer', '%r,%r,0.3' % (STEP * r.uniform(1, 6), MODULUS * 10 ** r.uniform(-0.7, 0.7))]
        options[0:2] = ['--E1', repr(MODULUS), '--nu1', '0.3', '--E2', 'rigid']
    if r.random() < 0.35:
        options += ['--load=' + ','.join(repr(MODULUS * slope * area * 10 ** r.uniform(-2, 0.5)) for _ in range(n))]
    else:
        options += ['--approach=' + ','.join(map(repr, approaches))]
    return Case(surface, options, ['--tol', '1e-8'], tol=['--tol', r.choice(['1e-3', '1e-4', '3e-4'])])


def tilted(r):
    nx = r.randint(8, 40)
    ny = r.choice([1, nx, r.randint(6, 40), r.randint(6, 40)])
    rms = 10 ** r.uniform(-8.5, -6.5)
    surface = selfaffine(r, (ny, nx), rms)
    hard = MODULUS * rms / (max(nx, ny) * STEP / 4) * 10 ** r.uniform(-1.3, 0.5)
    load = hard * nx * ny * STEP ** 2 * 10 ** r.uniform(-2.5, -0.05)
    at = [r.uniform(-0.4, 0.4) * n if r.random() < 0.7 and n > 1 else 0 for n in (nx, ny)]
    options = ['--estar', repr(MODULUS), '--tilt', 'free', '--at=%gum,%gum' % tuple(at), '--load', repr(load)]
    options += ['--hardness', repr(hard)] * (r.random() < 0.8)
    return surface and Case(surface, options, ['--tol', '1e-9'], tol=['--tol', r.choice(['1e-3', '1e-4', '1e-4', '1e-5'])])


def wide_map(r):
    """A ball, two balls or a rough ball, in the middle of a map that is two or three times as wide."""
    n, times = r.choice([16, 20, 24, 28, 32]), r.choice([2, 3])
    side = n * times
    random_of = numpy.random.default_rng(r.randrange(10 ** 9))
    y, x = (numpy.mgrid[:side, :side] - (side - 1) / 2 + 0.3) * STEP
    radius = STEP * n * r.uniform(1, 6)
    shape = r.choice(['ball', 'balls', 'rough'])
    apart = n * STEP * r.uniform(0.1, 0.2) if shape == 'balls' else 0
    heights = -numpy.minimum((x - apart) ** 2, (x + apart) ** 2) / (2 * radius) - y ** 2 / (2 * radius)
    contact = n * STEP * r.uniform(0.08, 0.24)  # radius, about
    if shape == 'rough':
        waves = numpy.fft.rfft2(random_of.standard_normal((side, side)))
        q = numpy.hypot(*numpy.meshgrid(numpy.fft.fftfreq(side), numpy.fft.rfftfreq(side), indexing='ij'))
        rough = numpy.fft.irfft2(waves * (q < 0.25) / numpy.maximum(q, 1 / n) ** 1.8, (side, side))
        heights += rough / rough.std() * contact ** 2 / radius * r.uniform(0.05, 0.3)
    first = (side - n) // 2
    small = rcg.dumps([rcg.frame('height', heights[first:first + n, first:first + n].copy(), STEP)])
    large = rcg.dumps([rcg.frame('height', heights, STEP)])
    mean = 0.4 * MODULUS * contact / radius  # of Hertz, Pa
    load = numpy.pi * contact ** 2 * mean
    options = ['--E1', repr(MODULUS), '--nu1', repr(r.uniform(0, 0.45)), '--E2', 'rigid']
    if r.random() < 1 / 3:
        options += ['--hardness', repr(mean * r.uniform(1, 1.4)), '--load', repr(load * r.uniform(0.3, 1))]
        return Case(small, options, ['--tol', '1e-6'], wide=large)
    stress = mean * r.uniform(0.3, 0.8)
    modulus = stress * 10 ** r.uniform(-1, 1.5) if r.random() < 0.7 else 0
    options += ['--yield', '%r,%r' % (stress, modulus), '--load', repr(load * r.uniform(0.3, 1))]
    return Case(small, options + ['--increments', '16'], ['--increments', '96', '--tol', '1e-6'], wide=large)


def anywhere(r):
    """A rough map, a ball or a rough ball on a map or a profile with any boundary: heights, options, Poisson's ratio."""
    nx = r.choice([16, 24, 32, 48])
    ny = r.choice([nx, nx, r.choice([16, 24, 32]), 1])
    random_of = numpy.random.default_rng(r.randrange(10 ** 9))
    side, flat = max(nx, ny), ny == 1
    y, x = numpy.mgrid[:ny, :nx].astype(float)
    kind = r.choice(['rough', 'rough', 'ball', 'rough ball'])
    heights = numpy.zeros((ny, nx))
    if kind != 'ball':
        waves = numpy.fft.rfft2(random_of.standard_normal((ny, nx)))
        q = numpy.hypot(*numpy.meshgrid(numpy.fft.fftfreq(ny), numpy.fft.rfftfreq(nx), indexing='ij'))
        cut, hurst = min(1 / r.choice([2, 3, 4, 6, 8]), 0.25 if flat else 1), r.uniform(0.3, 1)
        waves *= (q > 0) * (q <= cut) * numpy.maximum(q, 1 / side) ** -(hurst + (0.5 if flat else 1))
        rough = numpy.fft.irfft2(waves, (ny, nx))
        heights += rough / rough.std() * STEP * 10 ** r.uniform(-2, -0.5)
    if kind != 'rough':
        radius = STEP * side * r.uniform(1, 20)
        away = (x - nx / 2 + r.random()) ** 2 + (0 if flat else (y - ny / 2 + r.random()) ** 2)
        heights -= away * STEP ** 2 / (2 * radius)
    sides = r.choice([[], [], ['--periodic'], ['--periodic'], ['--periodic=x', '--datum', '1mm'], ['--periodic=y', '--datum', '1mm']])
    if flat and 'x' in ''.join(sides[:1]) + 'x' * (not sides):
        sides = ['--periodic']  # a profile does not exist on a free map
    nu = r.uniform(0, 0.45)
    slope = numpy.sqrt(numpy.mean(numpy.diff(heights, axis=1) ** 2)) / STEP
    mean = MODULUS * slope * 10 ** r.uniform(-2.3, -0.5)
    return heights, sides + ['--E1', repr(MODULUS), '--nu1', repr(nu), '--E2', 'rigid', '--mean-pressure', repr(mean)], nu


def tool(name, options, data):
    return subprocess.run([os.path.join(BIN, name), *options], input=data, capture_output=True,
                          env={**os.environ, 'RC_THREADS': '1'})


def report_of(done, table):
    with open(table) as file:
        return json.loads(file.readline()) if done.returncode in (0, 3) else None


def first_yield(seed, count, table):
    missed, silent, high, pressure, cases = 0, 0, 0, [], 0
    for c in range(count):
        r = random.Random(seed * 100003 + c)
        heights, options, nu = anywhere(r)
        surface = rcg.dumps([rcg.frame('height', heights, STEP)])
        elastic = tool('rc-solve', ['--quiet', '--output', 'pressure', *options], surface)
        inside = tool('rc-stress', ['--nu', repr(nu), '--depths', 'auto', '--components', 'mises'], elastic.stdout)
        ratio = 10 ** r.uniform(math.log10(1.02), math.log10(1.3))
        stress = max((float(f.values.max()) for f in rcg.loads(inside.stdout)), default=0) / ratio
        law = ['--yield', '%r,%r' % (stress, stress * r.uniform(0.5, 10)), '--output', 'pressure', '--report', table]
        done = tool('rc-solve', options + law, surface)
        ours = report_of(done, table)
        fine = ours and report_of(tool('rc-solve', options + law + ['--quiet', '--slabs', '32'], surface), table)
        if not ours:
            print(f'case {c}: {done.stderr.decode()}')
            continue
        cases += 1
        if fine and (fine['max_plastic_strain'] or 0) > 0:
            pressure.append(abs(ours['max_pressure'] / fine['max_pressure'] - 1))
        if not (ours['max_plastic_strain'] or 0) > 0:
            warned = b'is below it: take a finer grid' in done.stderr
            missed, high, silent = missed + 1, high + (ratio > 1.05), silent + (ratio > 1.05 and not warned)
            print(f'elastic: case {c}, Mises stress {ratio:.3f} of the yield stress, {ours["contact_nodes"]} nodes in contact',
                  'warned' if warned else 'SILENT', *options, flush=True)
    print(f'{cases} bodies, {missed} remain elastic, {high} of them above 1.05, {silent} without a warning')
    print(f'largest pressure against 32 slabs, {len(pressure)} bodies: median {numpy.median(pressure):.1e}, '
          f'90 % {numpy.quantile(pressure, 0.9):.1e}, most {max(pressure):.1e}')
    return 1 if silent or high > 0.02 * cases else 0


def solve(surface, options, table):
    done = subprocess.run([os.path.join(BIN, 'rc-solve'), '--quiet', '--output', 'pressure', '--report', table, *options],
                          input=surface, capture_output=True, env={**os.environ, 'RC_THREADS': '1'})
    if done.returncode not in (0, 3):
        return None
    with open(table) as file:
        lines = [json.loads(line) for line in file]
    return list(zip(lines, (f.values for f in rcg.loads(done.stdout) if f.channel == 'pressure')))


def middle(values, shape):
    first = [(n - m) // 2 for n, m in zip(values.shape, shape)]
    return values[first[0]:first[0] + shape[0], first[1]:first[1] + shape[1]]


def states(case, kind, table):
    """Yields (error, report, report of the reference) for each state of a case."""
    ours = solve(case.surface, case.options + case.tol, table)
    truth = ours and solve(case.wide, case.options + case.tight, table)
    for (report, p), (theirs, q) in zip(ours or [], truth or []):
        if report['pressure_error_estimate'] is None or (kind != 'maps' and not theirs['converged']):
            continue
        if kind == 'adhesion' and 'yes' in (report.get('separated'), theirs.get('separated')):
            return
        whole = abs(q).sum()
        # pressure on the wider map outside of the other map is an error too
        error = (abs(p - middle(q, p.shape)).sum() + whole - abs(middle(q, p.shape)).sum()) / whole if whole > 0 else 0
        if kind == 'adhesion' and error > 0.02:
            return  # another minimum, and all later states
        yield error, report, theirs


class Waves:
    """Random waves of 4 to 12 nodes and more, a ball where no axis repeats, or both, on any grid of one area."""

    def __init__(self, r):
        self.nx = r.choice([16, 20, 24, 32, 40])
        self.ny = r.choice([self.nx, self.nx, r.choice([16, 24, 32]), 1])
        x, y = r.choice([(1, 1), (1, 1), (0, 0), (0, 0), (1, 0), (0, 1)])
        self.sides = (x, 1 if self.ny == 1 else y)
        random_of = numpy.random.default_rng(r.randrange(10 ** 9))
        cut, hurst, rms = r.uniform(4, 12) * STEP, r.uniform(0.3, 1), 10 ** r.uniform(-2, -0.5) * STEP
        periods = [n * STEP * (1 if side else 1.37) for n, side in zip((self.nx, self.ny), self.sides)]
        most = [int(p / cut) if n > 1 else 0 for p, n in zip(periods, (self.nx, self.ny))]
        self.waves = []
        for a in range(-most[0], most[0] + 1):
            for b in range(0 if a > 0 else 1, most[1] + 1):
                q = 2 * numpy.pi * numpy.array([a / periods[0], b / periods[1]])
                length = numpy.hypot(*q)
                if length <= 2 * numpy.pi / cut:
                    height = random_of.normal() * length ** -(hurst + (0.5 if self.ny == 1 else 1))
                    self.waves.append((*q, height, random_of.uniform(0, 2 * numpy.pi)))
        kind = r.choice(['rough', 'rough', 'ball', 'rough ball']) if sum(self.sides) == 0 else 'rough'
        self.radius = STEP * max(self.nx, self.ny) * r.uniform(1, 30) if 'ball' in kind else numpy.inf
        self.away = r.uniform(-0.5, 0.5) * STEP, r.uniform(-0.5, 0.5) * STEP
        spread = numpy.sqrt(sum(w[2] ** 2 for w in self.waves) / 2)
        self.scale = 0 if kind == 'ball' else rms / spread
        self.options = {(1, 1): ['--periodic'], (0, 0): []}.get(self.sides, ['--periodic=' + 'yx'[self.sides[0]], '--datum', '1mm'])

    def heights(self, times):
        """Heights at the middles of the cells."""
        nx, ny = self.nx * times, self.ny * times if self.ny > 1 else 1
        x = (numpy.arange(nx) + 0.5) * STEP / times
        y = ((numpy.arange(ny) + 0.5) * STEP / times if ny > 1 else numpy.zeros(1))[:, None]
        heights = numpy.zeros((ny, nx))
        for qx, qy, a, phase in self.waves:
            heights += a * self.scale * numpy.cos(qx * x + qy * y + phase)
        middle = [n * STEP / 2 + away for n, away in zip((self.nx, self.ny), self.away)]
        return heights - ((x - middle[0]) ** 2 + (y - middle[1]) ** 2) / (2 * self.radius)


def grid(seed, count, table):
    rows = {'contact_fraction': [], 'max_pressure': [], 'approach': []}
    below, silent, raised, unknown, work = 0, 0, 0, 0, 0
    for c in range(count):
        r = random.Random(seed * 100003 + c)
        s = Waves(r)
        slope = numpy.sqrt(numpy.mean(numpy.diff(s.heights(1), axis=1) ** 2)) / STEP
        mean = MODULUS * slope * 10 ** r.uniform(-2.2, -0.3)
        options = s.options + ['--estar', repr(MODULUS), '--mean-pressure', repr(mean), '--tol', '1e-4']
        data = {k: rcg.dumps([rcg.frame('height', s.heights(k), STEP / k)]) for k in (1, 4, 8)}
        run = ['--output', 'pressure', '--report', table]
        done = tool('rc-solve', options + run + ['--discretization'], data[1])
        ours = report_of(done, table)
        if not ours or ours['contact_area_error_estimate'] is None:
            continue
        four, eight = (report_of(tool('rc-solve', options + run, data[k]), table) for k in (4, 8))
        work += ours['convolutions']
        unknown += ours['max_pressure_error_estimate'] is None
        if eight['max_pressure'] > 1.5 * ours['max_pressure']:
            raised += 1
            silent += b'edge of the map' not in done.stderr and b'does not resolve' not in done.stderr
        for name in rows:
            told = ours[('contact_area' if name == 'contact_fraction' else name) + '_error_estimate']
            if told is None or ours[name] is None or eight[name] is None:
                continue
            error = abs((2 * eight[name] - four[name]) / ours[name] - 1)
            if abs(eight[name] - four[name]) > 0.1 * error * ours[name] and name != 'contact_fraction':
                continue
            rows[name].append((error, told))
            if error > 1e-5 and told < 0.99 * error:
                below += 1
                print(f'below: case {c}, {name}, {s.nx} x {s.ny} nodes, {ours["contact_nodes"]} in contact, told {told:.2e} '
                      f'error {error:.2e}', *options, flush=True)
    for name in rows:
        error, told = numpy.array(rows[name]).T
        ratio = told[error > 1e-5] / error[error > 1e-5]
        print(f'{name}: {len(ratio)} errors above 1e-5, below 0.99: {(ratio < 0.99).sum()}, least {ratio.min():.2f}, '
              f'median {numpy.median(ratio):.2f}, 90 % {numpy.quantile(ratio, 0.9):.1f}')
    print(f'largest pressure without an estimate: {unknown}; larger by half on a finer grid: {raised}, {silent} without a warning; '
          f'{work:.0f} convolutions')
    return 1 if below or silent else 0


def heated(r):
    """A map of heat: that of Hertz or of rough tips, with any boundary. Returns it, its boundary and options."""
    nx = r.choice([16, 24, 32])
    ny = r.choice([nx, nx, r.choice([16, 24]), 1])
    x, y = r.choice([(0, 0), (0, 0), (1, 1), (1, 0), (0, 1)])
    y = 1 if ny == 1 else y
    random_of = numpy.random.default_rng(r.randrange(10 ** 9))
    j, i = numpy.mgrid[:ny, :nx].astype(float)
    if r.random() < 0.5:
        away = ((i - nx / 2 + 0.3) ** 2 + (0 if ny == 1 else (j - ny / 2 + 0.2) ** 2)) / (nx * r.uniform(0.15, 0.4)) ** 2
        heat = numpy.sqrt(numpy.maximum(1 - away, 0))
    else:
        waves = numpy.fft.rfft2(random_of.standard_normal((ny, nx)))
        q = numpy.hypot(*numpy.meshgrid(numpy.fft.fftfreq(ny), numpy.fft.rfftfreq(nx), indexing='ij'))
        rough = numpy.fft.irfft2(waves * (q > 0) * (q < 0.25) * numpy.maximum(q, 1 / nx) ** -1.8, (ny, nx))
        heat = numpy.maximum(rough / rough.std() - r.uniform(0.2, 1.2), 0)
    diffusivity, conductivity = [10 ** r.uniform(-6, -4) for _ in 'ab'], [10 ** r.uniform(0, 2) for _ in 'ab']
    radius = nx * STEP / 4
    speed = 10 ** r.uniform(-1, 2.5) * 2 * diffusivity[1] / radius
    time = 10 ** r.uniform(-2, 1.5) * radius ** 2 / max(diffusivity)
    boundary = {(0, 0): 'free', (1, 1): 'periodic', (1, 0): 'periodic-x', (0, 1): 'periodic-y'}[x, y]
    return 1e8 * heat, boundary, ['--conductivity', '%r,%r' % tuple(conductivity), '--diffusivity', '%r,%r' % tuple(diffusivity),
                                  '--speed', repr(speed), '--time', repr(time), '--output', 'temperature-1,temperature-2']


def heat(seed, count, table):
    rows, work, short = [], 0, 0
    for c in range(count):
        q, boundary, options = heated(random.Random(seed * 100003 + c))
        if not q.any():
            continue
        surface = rcg.dumps([rcg.frame('heat', q, STEP, unit='W/m2', boundary=boundary)])
        run = ['--quiet', '--report', table]

        def temperatures(*more):
            done = tool('rc-heat', options + run + list(more), surface)
            return numpy.array([f.values[q != 0] for f in rcg.loads(done.stdout)]), report_of(done, table)

        ours, report = temperatures()
        steps = [temperatures('--time-steps', n, '--tol', '1e-6')[0] for n in ('16', '32', '64')]
        truth, other = ((4 * steps[k] - steps[k - 1]) / 3 for k in (2, 1))
        scale = abs(truth).max()
        error = abs(ours - truth).max() / scale
        told = report['temperature_error_estimate'] + (report.get('time_error_estimate') or 0)
        work, short = work + report['convolutions'], short + (not report['converged'])
        if abs(truth - other).max() > 0.1 * error * scale:
            continue
        rows.append((error, told))
        if error > 1e-5 and told < 0.99 * error:
            print(f'below: case {c}, {boundary}, {q.shape[1]} x {q.shape[0]} nodes, told {told:.2e} error {error:.2e}', *options,
                  flush=True)
    error, told = numpy.array(rows).T
    ratio = told[error > 1e-5] / error[error > 1e-5]
    below = (ratio < 0.99).sum()
    print(f'{len(ratio)} errors above 1e-5, largest {error.max():.1e}: below 0.99: {below}, least {ratio.min():.2f}, '
          f'median {numpy.median(ratio):.2f}, 90 % {numpy.quantile(ratio, 0.9):.1f}; '
          f'{work / count:.1f} convolutions a case, {short} not converged')
    return 1 if below > 0.01 * len(rows) else 0


LONG = b'take shorter steps', b'longest row of voxels that flow'


def passes(seed, count, table):
    """Steps of an eighth to twice the half width."""
    rows = []
    for c in range(count):
        r = random.Random(seed * 100003 + c)
        roller = r.random() < 0.6
        nx, ny = (r.choice([32, 48, 64]), 1) if roller else (r.choice([24, 32]), r.choice([12, 16]))
        half = r.uniform(3, 6 if roller else 4.5)  # width, nodes
        radius, modulus = STEP * half * r.uniform(20, 60), MODULUS / (1 - 0.3 ** 2)
        peak = half * STEP * modulus / radius * (0.5 if roller else 2 / numpy.pi)
        stress = peak / r.uniform(1.9, 3.2)
        hardening = stress * r.choice([0, 1, 5, 20])
        step = half * 10 ** r.uniform(math.log10(1 / 8), math.log10(2))
        n = min(max(3, int(r.uniform(1, 4) * half / step) + 1) if step < half else r.randint(3, 5), 12)
        rough = numpy.random.default_rng(r.randrange(10 ** 9)).standard_normal((ny, nx)) * r.choice([0, 0, 0.002])
        mean = numpy.pi / 2 * half * peak / nx if roller else 2 * numpy.pi / 3 * half ** 2 * peak / (nx * ny)
        surface = rcg.dumps([rcg.frame('height', rough * (half * STEP) ** 2 / radius, STEP)])
        options = ['--periodic', '--cylinder' if roller else '--radius', repr(radius), '--E1', repr(MODULUS), '--nu1', '0.3',
                   '--E2', 'rigid', '--mean-pressure', repr(mean), '--yield', '%r,%r' % (stress, hardening),
                   '--passes', r.choice('12'), '--output', 'pressure', '--report', table]

        def way(times, *more):
            end = (n - 1) * step / 2
            done = tool('rc-solve', options + ['--travel=%rum:%rum:%d' % (-end, end, (n - 1) * times + 1), *more], surface)
            with open(table) as file:
                lines = [json.loads(line) for line in file]
            frames = [f.values for f in rcg.loads(done.stdout) if f.channel == 'pressure']
            return lines[-len(frames)::times], frames[::times], any(w in done.stderr for w in LONG)

        reports, ours, warned = way(1, '--increments', '16')
        fine, finest = (way(times, '--increments', '32', '--tol', '1e-5')[1] for times in (8, 16))
        for k in range(1, len(ours)):
            told = reports[k]['pressure_error_estimate']
            error, unsure = (abs(p - finest[k]).sum() / finest[k].sum() for p in (ours[k], fine[k]))
            if told is not None and error > 1e-5 and unsure < 0.3 * error:
                rows.append((warned, told / error))
                if told < 0.99 * error and not warned:
                    print(f'below: case {c} position {k} told {told:.2e} error {error:.2e}, step {step / half:.2f} half widths',
                          *options, flush=True)
    for long in (False, True):
        ratio = numpy.array([q for warned, q in rows if warned == long])
        if len(ratio):
            print(f'{"with" if long else "without"} the warning: {len(ratio)} errors above 1e-5, below 0.99: {(ratio < 0.99).sum()}, '
                  f'least {ratio.min():.2f}, median {numpy.median(ratio):.2f}, 90 % {numpy.quantile(ratio, 0.9):.1f}')
    return 1 if any(q < 0.99 for warned, q in rows if not warned) else 0


ALONE = {'first': first_yield, 'grid': grid, 'heat': heat, 'passes': passes}


def main(kind, seed, count):
    if kind in ALONE:
        with tempfile.TemporaryDirectory() as where:
            return ALONE[kind](seed, count, os.path.join(where, 'report'))
    draw = {'hist': lambda r: hist_or_path(r, 'hist'), 'adhesion': lambda r: hist_or_path(r, 'adhesion'),
            'tilt': tilted, 'maps': wide_map}[kind]
    rows, convolutions, short, below = [], 0, 0, 0
    with tempfile.TemporaryDirectory() as where:
        for c in range(count):
            case = draw(random.Random(seed * 100003 + c))
            for k, (error, report, _) in enumerate(states(case, kind, os.path.join(where, 'report')) if case else ()):
                told = report['pressure_error_estimate']
                rows.append((error, told))
                convolutions += report['convolutions'] or 0
                short += not report['converged']
                below += error > 1e-5 and told < 0.99 * error
                if error > 1e-6 and told < 0.99 * error:
                    print(f'below: case {c} state {k} told {told:.2e} error {error:.2e}', *case.options, *case.tol,
                          *(f'{key} {report.get(key)}' for key in ('stability', 'contact_nodes', 'iterations')), flush=True)
    for least in (0, 1e-7, 1e-6, 1e-5, 1e-4):
        ratio = numpy.array([told / error for error, told in rows if error > least])
        if len(ratio):
            print(f'errors above {least:.0e}: {len(ratio)} states, below 0.99: {(ratio < 0.99).sum()}, least {ratio.min():.2f}, '
                  f'median {numpy.median(ratio):.2f}, 90 % {numpy.quantile(ratio, 0.9):.1f}')
    print(f'convolutions a state {convolutions / max(len(rows), 1):.2f}, not converged {short} of {len(rows)}')
    return 1 if below else 0


if __name__ == '__main__':
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    BIN = sys.argv[4]
    sys.exit(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
