# SPDX-License-Identifier: GPL-3.0-or-later
"""bars.py scenes|fractals|patches SEED COUNT BIN: how often the bars of rc-cost hold the value of the true surface.

scenes    random surfaces on 512^2 or 1024^2 nodes, measured on 128^2 or 256^2 with noise: means over 4 x 4 nodes or every
          fourth node. The truth is the result of the noiseless, finely resolved map. Shortest waves of 3 to 8 measured nodes,
          isotropic, anisotropic and not Gaussian; white and correlated noise; SIGMA told rightly, twice or half of it.
          rc-cost --noise --resolution. Status 1 unless 88 to 97 % of the values are within the bars, and at least 80 % of each
          figure with 20 values or more; or if more than 5 % of the maps whose waves have 4 nodes or more are flagged with the
          right SIGMA. Half of it leaves noise in the map, twice of it may exceed the map
fractals  surfaces whose waves go on to half a node. Status 1 unless each one is flagged
patches   a quarter of a periodic surface with a roll-off of 1/16 to 1/4 of its side is measured. rc-cost --patch. Status 1 unless
          80 % of the figures without "on this area" are within the bars
BIN holds the tools. A further argument is a file for the values of "scenes", one JSON object a line. Case c of SEED draws from the seed SEED * 100003 + c.
"""
import collections
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

STEP = 1e-6        # m, of the measured map
MODULUS = 1e9      # Pa
FINE = 4           # nodes of the truth for each measured one


def tool(name, *words, data=None):
    done = subprocess.run([os.path.join(BIN, name), *words], input=data, capture_output=True)
    if done.returncode not in (0, 3):
        raise RuntimeError(f'{name} {" ".join(words)}: {done.stderr.decode()}')
    return done.stdout


def figures(data, command):
    """The figures of all programs of a pipe by program and name."""
    found = {}
    for words in command:
        with tempfile.TemporaryDirectory() as folder:
            report = os.path.join(folder, 'report.json')
            data = tool(*words, '--quiet', '--report', report, data=data)
            with open(report) as lines:
                found[words[0]] = json.loads(lines.readline())
    return found


def study(data, options, command):
    """Rows of the report of rc-cost."""
    pipe = []
    for words in command:
        pipe += ['|', *words] if pipe else words
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, 'report.json')
        tool('rc-cost', '--quiet', '--limit', '1h', *options, '--report', report, '--', *pipe, data=data)
        with open(report) as lines:
            rows = [json.loads(line) for line in lines]
    failed = [r for r in rows if r['what'] == 'run' and r['state'] != 'done']
    if failed:
        raise RuntimeError(f'{failed[0]["name"]}: {failed[0]["why"]}')
    return [r for r in rows if r['what'] == 'figure']


def heights_of(data):
    return rcg.loads(data)[0].values


def dumped(heights, step):
    return rcg.dumps([rcg.frame('height', heights, step)])


class Scene:
    """A surface of nx measured nodes a side, its fine map, and a command."""

    def __init__(self, seed, fractal=False):
        self.r = r = random.Random(seed)
        self.random = numpy.random.default_rng(r.randrange(10 ** 9))
        self.side, self.fractal = r.choice([128, 128, 256]), fractal
        self.shortest = 2 / FINE if fractal else r.choice([3, 4, 5, 6, 8])  # nodes
        self.slope = r.choice([0.05, 0.1, 0.2])
        # squares have waves of half the length, cubes of a third: all surfaces are smooth below the shortest wave
        self.kind, power = r.choice([('isotropic', 1), ('anisotropic', 1), ('skewed', 2), ('kurtosis', 3)])
        cut = self.shortest if fractal else power * self.shortest
        options = ['--hurst', '%g' % r.uniform(0.4, 1), '--rms-height', '1', '--short-cut', '%gm' % (cut * STEP),
                   '--rolloff', '%gm' % (STEP * math.exp(r.uniform(math.log(max(16, 1.5 * cut)), math.log(self.side / 3))))]
        if self.kind == 'anisotropic':
            options += ['--anisotropy', '%g' % r.uniform(1.5, 4), '--direction', '%g' % r.uniform(0, 180)]
        h = heights_of(tool('rc-synth', 'selfaffine', '--nx', str(FINE * self.side), '--dx', '%gm' % (STEP / FINE), *options, '--seed',
                            str(r.randrange(10 ** 6))))
        h = h + (0, 0, r.uniform(-0.3, 0.3), r.uniform(-0.05, 0.15))[power] * h ** power
        gradient = [(numpy.roll(h, -1, axis) - h) / (STEP / FINE) for axis in (0, 1)]
        h *= self.slope / math.sqrt(sum(numpy.mean(g ** 2) for g in gradient))
        self.fine = dumped(h, STEP / FINE)
        pressure = MODULUS * self.slope * math.exp(r.uniform(math.log(0.012), math.log(0.2)))
        solve = ['rc-solve', '--periodic', '--mean-pressure', repr(pressure)]
        self.name, self.command = r.choice([
            ('leak', [solve + ['--estar', repr(MODULUS), '--stiffness'], ['rc-leak']]),
            ('leak', [solve + ['--estar', repr(MODULUS), '--stiffness'], ['rc-leak']]),
            ('heat', [solve + ['--estar', repr(MODULUS)], ['rc-heat', '--mu', '0.3', '--speed', '1', '--conductivity', '45,45',
                                                           '--diffusivity', '1e-5,1e-5', '--time', '20us']]),
            ('rubber', [['rc-solve', '--periodic', '--mean-pressure', repr(pressure / 5), '--relaxation', '200MPa,2GPa:0.3ms', '--nu1', '0.5',
                         '--E2', 'rigid', '--speed', '30mm/s']])])

    def measure(self):
        """The map with noise, and SIGMA[,LENGTH] as rc-cost is told."""
        fine, r = heights_of(self.fine), self.r
        n = self.side
        points = r.random() < 0.4
        h = fine[::FINE, ::FINE].copy() if points else fine.reshape(n, FINE, n, FINE).mean(axis=(1, 3))
        share = r.choice([0.05, 0.15, 0.3, 0.6])  # slope of the noise over that of the surface
        noise = self.random.standard_normal((n, n))
        length = 0
        if r.random() < 0.2:
            length = r.uniform(1.5, 3)
            q = 2 * math.pi * numpy.hypot(*numpy.meshgrid(numpy.fft.fftfreq(n), numpy.fft.rfftfreq(n), indexing='ij'))
            noise = numpy.fft.irfft2(numpy.fft.rfft2(noise) * numpy.exp(-(q * length) ** 2 / 8), (n, n))
            noise /= noise.std()
        sigma = share * self.slope * STEP * max(length, 1) / 2
        wrong = 1 if self.fractal else r.choice([1, 1, 1, 2, 0.5])
        self.told = '%gm' % (wrong * sigma) + (',%gm' % (length * STEP) if length else '')
        self.what = dict(kind=self.kind, command=self.name, side=n, shortest=self.shortest, noise_slope=share, correlated=bool(length),
                         sigma=wrong, sampling='points' if points else 'means')
        return dumped(h + sigma * noise, STEP)


def within(row, truth):
    return abs(row['value'] - truth) <= row['bar'] + 1e-6 * abs(truth)


def scenes(seed, count):
    by_figure, by_what = collections.defaultdict(list), collections.defaultdict(list)
    false, ended = collections.Counter(), collections.Counter()
    bars, errors = collections.defaultdict(list), collections.defaultdict(list)
    for case in range(count):
        scene = Scene(seed * 100003 + case)
        measured = scene.measure()
        rows = study(measured, ['--noise', scene.told, '--resolution'], scene.command)
        flagged = not rows[0]['waves_end']
        if scene.shortest >= 4:
            told = scene.what['sigma']
            ended[told] += 1
            false[told] += flagged
        if flagged:
            print(f'case {case}: flagged, ratio {rows[0]["slope_ratio"]}: {scene.what}')
            continue
        truth = figures(scene.fine, scene.command)
        hits = []
        for row in rows:
            true = truth[row['program']].get(row['name'])
            if row['bar'] is None or true is None or row['bar'] == 0:
                continue
            if DATA:
                DATA.write(json.dumps(dict(row, truth=true, case=case, **scene.what)) + '\n')
            hit = within(row, true)
            hits.append(hit)
            by_figure[row['name']].append(hit)
            if true:
                bars[row['name']].append(row['bar'] / abs(true))
                errors[row['name']].append(abs(row['value'] / true - 1))
            for key, value in scene.what.items():
                by_what[key, value].append(hit)
            if not hit:
                print(f'case {case}: {row["name"]} {row["value"]:.4g}, bar {row["bar"]:.2g}, truth {true:.4g}: {scene.what}')
        print(f'case {case}: {sum(hits)} of {len(hits)} within the bars', flush=True)
    print('\nfigure: values, share within the bars, median error, median bar')
    for name, hits in sorted(by_figure.items()):
        print(f'{name:28} {len(hits):4} {100 * numpy.mean(hits):5.1f} % {100 * numpy.median(errors[name]):6.2f} % {100 * numpy.median(bars[name]):6.2f} %')
    for (key, value), hits in sorted(by_what.items(), key=str):
        print(f'{key} {value}: {len(hits)} values, {100 * numpy.mean(hits):.1f} %')
    every = [hit for hits in by_figure.values() for hit in hits]
    share = 100 * numpy.mean(every)
    low = [name for name, hits in by_figure.items() if len(hits) >= 20 and numpy.mean(hits) < 0.8]
    print(f'{count} scenes, {len(every)} values: {share:.1f} % within the bars; below 80 %: {low or "none"}')
    for told in sorted(ended):
        print(f'{false[told]} of {ended[told]} maps whose waves have 4 nodes or more are flagged, with {told:g} times their SIGMA')
    return 88 <= share <= 97 and not low and false[1] <= 0.05 * ended[1]


def fractals(seed, count):
    flagged = 0
    for case in range(count):
        scene = Scene(seed * 100003 + case, fractal=True)
        rows = study(scene.measure(), ['--noise', scene.told, '--resolution'], scene.command)
        flagged += not rows[0]['waves_end']
        print(f'case {case}: ratio {rows[0]["slope_ratio"]}: {scene.what}', flush=True)
    print(f'{flagged} of {count} fractals are flagged')
    return flagged == count


def patches(seed, count):
    by_figure = collections.defaultdict(list)
    for case in range(count):
        r = random.Random(seed * 100003 + case)
        n, slope = 128, 0.1
        whole = tool('rc-synth', 'selfaffine', '--nx', str(2 * n), '--dx', '1um', '--hurst', '%g' % r.uniform(0.5, 1), '--rms-slope', repr(slope),
                     '--short-cut', '6um', '--rolloff', '%gum' % r.choice([16, 32]), '--seed', str(r.randrange(10 ** 6)))
        left, top = r.randrange(2 * n), r.randrange(2 * n)
        part = numpy.roll(heights_of(whole), (-top, -left), axis=(0, 1))[:n, :n].copy()
        patch = tool('rc-detrend', '--plane', '--mirror', 'xy', '--quiet', data=dumped(part, STEP))
        pressure = MODULUS * slope * math.exp(r.uniform(math.log(0.015), math.log(0.15)))
        command = [['rc-solve', '--periodic', '--mean-pressure', repr(pressure), '--estar', repr(MODULUS), '--stiffness'], ['rc-leak']]
        truth = figures(whole, command)
        for row in study(patch, ['--patch'], command):
            true = truth[row['program']].get(row['name'])
            if row['why'] is None and row['bar'] and true:
                by_figure[row['name']].append(within(row, true))
        print(f'case {case}: done', flush=True)
    for name, hits in sorted(by_figure.items()):
        print(f'{name:28} {len(hits):4} {100 * numpy.mean(hits):5.1f} %')
    share = 100 * numpy.mean([hit for hits in by_figure.values() for hit in hits])
    print(f'{count} patches: {share:.1f} % within the bars')
    return share >= 80


if __name__ == '__main__':
    BIN = sys.argv[4]
    DATA = open(sys.argv[5], 'w') if len(sys.argv) > 5 else None
    os.environ['RC_THREADS'] = '1'
    sys.exit(0 if {'scenes': scenes, 'fractals': fractals, 'patches': patches}[sys.argv[1]](int(sys.argv[2]), int(sys.argv[3])) else 1)
