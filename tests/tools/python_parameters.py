# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters of ISO 25178-2 and ISO 21920-2 by numpy, programmed from the standards, compared with those of rc-info: python_parameters.py FILE.

Hills by pointers to the steepest of eight neighbours, saddles of all pairs of hills that touch, and Wolf's rule literally: repeatedly the lowest hill joins the hill across its highest saddle. Prints each parameter with both values; fails if the largest relative difference is too large."""
import json
import subprocess
import sys

import numpy as np
import rcg

TOLERANCE = 1e-12


def pairs(grid):
    """Every pair of neighbours once."""
    return ((grid[:, :-1], grid[:, 1:]), (grid[:-1], grid[1:]), (grid[:-1, :-1], grid[1:, 1:]),
            (grid[:-1, 1:], grid[1:, :-1]))


def ascent(z, dx, dy):
    """The peak that steepest ascent reaches from each node."""
    ny, nx = z.shape
    node = np.arange(nx * ny).reshape(ny, nx)
    steepest, to = np.zeros_like(z), node.copy()
    padded = np.pad(z, 1, constant_values=-np.inf)
    number = np.pad(node, 1)
    for j in (-1, 0, 1):
        for i in (-1, 0, 1):
            if i == j == 0:
                continue
            there = slice(1 + j, ny + 1 + j), slice(1 + i, nx + 1 + i)
            slope = (padded[there] - z) / np.hypot(i * dx, j * dy)
            better = slope > steepest
            steepest[better] = slope[better]
            to[better] = number[there][better]
    to = to.ravel()
    while (to[to] != to).any():
        to = to[to]
    return to


def prune(z, peak):
    height, saddle = z.ravel(), {}
    for a, b in pairs(np.arange(z.size).reshape(z.shape)):
        a, b = a.ravel(), b.ravel()
        differ = peak[a] != peak[b]
        for p, q, at in zip(peak[a[differ]], peak[b[differ]], np.minimum(height[a[differ]], height[b[differ]])):
            for one, other in ((p, q), (q, p)):
                own = saddle.setdefault(one, {})
                own[other] = max(own.get(other, -np.inf), at)
    least = 0.05 * (z.max() - z.min())
    while True:
        lowest, gone = min((height[k] - max(own.values()), k) for k, own in saddle.items() if own)
        if lowest >= least:
            return peak
        to = max(saddle[gone], key=saddle[gone].get)
        for other, at in saddle.pop(gone).items():
            del saddle[other][gone]
            if other != to:
                saddle[to][other] = saddle[other][to] = max(saddle[other].get(to, -np.inf), at)
        peak[peak == gone] = to


def features(z, dx, dy):
    """Density, curvature, five highest, mean area."""
    ny, nx = z.shape
    peak = prune(z, ascent(z, dx, dy))
    hill = peak.reshape(z.shape)
    edge = set(np.concatenate((hill[0], hill[-1], hill[:, 0], hill[:, -1])))
    all_of = np.unique(peak)
    inner = np.array([k for k in all_of if 0 < k // nx < ny - 1 and 0 < k % nx < nx - 1])
    j, i = inner // nx, inner % nx
    bend = -0.5 * ((z[j, i + 1] - 2 * z[j, i] + z[j, i - 1]) / dx ** 2 + (z[j + 1, i] - 2 * z[j, i] + z[j - 1, i]) / dy ** 2)
    area = np.mean([(peak == k).sum() for k in all_of if k not in edge]) * dx * dy
    return len(inner) / (z.size * dx * dy), bend.mean(), np.sort(z[j, i])[-5:].mean() - z.mean(), area


def profiles(z, dx):
    d = z - z.mean(1, keepdims=True)
    n = d.shape[1]
    parts = [d[:, s * n // 5:(s + 1) * n // 5] for s in range(5)]
    slope = (z[:, 6:] - z[:, :-6] - 9 * (z[:, 5:-1] - z[:, 1:-5]) + 45 * (z[:, 4:-2] - z[:, 2:-4])) / (60 * dx)
    rq = np.sqrt((d ** 2).mean(1))
    rows = dict(ra=np.abs(d).mean(1), rq=rq, rsk=(d ** 3).mean(1) / rq ** 3, rku=(d ** 4).mean(1) / rq ** 4, rt=np.ptp(d, axis=1),
                rp=np.mean([p.max(1) for p in parts], axis=0), rv=np.mean([-p.min(1) for p in parts], axis=0),
                rz=np.mean([np.ptp(p, axis=1) for p in parts], axis=0), rdq=np.sqrt((slope ** 2).mean(1)))
    return {name: (v.mean(), v.std(ddof=1)) for name, v in rows.items()}


frame = rcg.read(sys.argv[1])[0]
z, dx, dy = frame.values, float(frame.dx), float(frame.dy)
line = json.loads(subprocess.run(['rc-info', '--json', '--areal', '--profile', 'rows', '--smr', '100nm', sys.argv[1]],
                                 check=True, stdout=subprocess.PIPE).stdout)
up, down = features(z, dx, dy), features(-z, dx, dy)
own = dict(spd=up[0], svd=down[0], spc=up[1], s5p=up[2], s5v=down[2], s10z=up[2] + down[2], sha=up[3], sda=down[3])
both = [(name, v, line['features'][name]) for name, v in own.items()]
for name, (mean, spread) in profiles(z, dx).items():
    both += [(name, mean, line['profile'][name]), (name + ' deviation', spread, line['profile']['deviation'][name])]
both.append(('smr', (z - z.mean() >= 100e-9).mean(), line['smr']['ratio'][0]))
for name, mine, theirs in both:
    print('%-14s %-22.16g %-22.16g' % (name, mine, theirs))
# a skewness near 0 is a difference of large sums
worst = max(abs(mine - theirs) / max(abs(mine), 1 if name.startswith('rsk') else 0) for name, mine, theirs in both)
print('worst %.2g' % worst)
sys.exit(0 if worst <= TOLERANCE else 1)
