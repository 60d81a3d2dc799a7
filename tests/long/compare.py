# SPDX-License-Identifier: GPL-3.0-or-later
"""compare.py OUT REFERENCE < TABLE: compares results of pipelines with those of the reference. Each line of
the table begins with the name of a result and the kind of comparison (pipelines.sh). Prints the largest
difference for each kind of comparison; names every result whose difference is too large, and then fails.
"""
import json
import math
import os
import sys

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'python'))
import rcg

ALLOWED = {'exact': 0.0, 'close': 1e-12, 'sums': 1e-10, 'solved': 2e-9}


def difference(a, b, how):
    """The difference of two arrays, relative to the second; infinite if only one of them has a number at a place."""
    if a.shape != b.shape or (numpy.isfinite(a) != numpy.isfinite(b)).any():
        return math.inf
    a, b = a[numpy.isfinite(a)], b[numpy.isfinite(b)]
    if (a == b).all():
        return 0.0
    if how == 'solved':
        return float(abs(a - b).sum() / abs(b).sum())
    return float(abs(a - b).max() / abs(b).max())


def of_words(a, b):
    """The difference of two values of a header: computed numbers, or words that must be equal."""
    if a == b:
        return 0.0
    try:
        return abs(float(a) - float(b)) / abs(float(b))
    except (TypeError, ValueError, ZeroDivisionError):
        return math.inf


def of_json(a, b):
    """The difference of two values of a report: numbers, lists relative to their largest number, objects member by member."""
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return max([of_json(a[k], b[k]) for k in a], default=0.0)
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        if all(isinstance(x, (int, float)) for x in a + b):
            return difference(numpy.array(a, float), numpy.array(b, float), 'close') if a else 0.0
        return max([of_json(x, y) for x, y in zip(a, b)], default=0.0)
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return of_words(a, b)
    return 0.0 if a == b else math.inf


def of_files(a, b, how):
    if how == 'exact':
        with open(a, 'rb') as one, open(b, 'rb') as other:
            return 0.0 if one.read() == other.read() else math.inf
    if a.endswith('.json'):
        with open(a) as one, open(b) as other:
            return max(of_json(json.loads(x), json.loads(y)) for x, y in zip(one, other, strict=True))
    ours, theirs = rcg.read(a), rcg.read(b)
    if len(ours) != len(theirs) or not ours:
        return math.inf
    worst = 0.0
    for f, g in zip(ours, theirs):
        if f.keys.keys() != g.keys.keys():
            return math.inf
        worst = max([worst, difference(f.values, g.values, how)] + [of_words(f.keys[k], g.keys[k]) for k in f.keys])
    return worst


def main(out, reference):
    worst, failed, n = {how: (0.0, '') for how in ALLOWED}, False, 0
    for line in sys.stdin:
        name, how = line.split()[:2]
        d = of_files(os.path.join(out, name), os.path.join(reference, name), how)
        n += 1
        if not d <= ALLOWED[how]:
            print(f'NOT OK: {name} differs by {d:.2g}, more than {ALLOWED[how]:g} ({how})')
            failed = True
        if d > worst[how][0]:
            worst[how] = d, name
    print(f'{n} results;', '; '.join(f'{how} {d:.1g} {name}'.rstrip() for how, (d, name) in worst.items()))
    return 1 if failed or n == 0 else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
