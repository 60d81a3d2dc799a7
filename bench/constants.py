#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Half and double of constants of libcontact, and what they change in small problems. Comments there quote the results.

    constants.py SET FILE:NAME...            constants.py elastic solver/pcg.c:enough

constants.txt has the problems of each SET. The library is built as it is, and with half and double of each constant, in
RC_WORK (default /tmp/rc-constants). A line of the output has the constant, the factor, the problems whose work, estimate
or result changes, the work (convolutions or applications) over that of the library as it is, its least and largest ratio
in one problem, the largest ratio of a problem's true errors, and how many more estimates are below the true error. True
errors are relative L1 differences from a run of the library as it is with a far smaller tolerance; of a pull-off, that
of its load. All runs use one thread, and counts repeat exactly.
"""
import json
import os
import re
import shutil
import subprocess
import sys

import numpy

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, HERE + '/python')
from rcg import stream  # noqa: E402

WORK = os.environ.get('RC_WORK', '/tmp/rc-constants')
TOOLS = ['rc-synth', 'rc-solve', 'rc-slip', 'rc-wear', 'rc-heat', 'rc-stress', 'rc-fatigue', 'rc-leak']
COMPARED = ['traction-x', 'wear-1', 'wear', 'temperature-1', 'dangvan', 'mises', 'fluid-pressure', 'pressure']
ESTIMATES = ['traction_error_estimate', 'pressure_error_estimate', 'mismatch']


def build(place, constant='', factor=1.0):
    """The folder of the tools, built with a constant times a factor."""
    listed = subprocess.run(['git', '-C', HERE, 'ls-files'], capture_output=True, text=True, check=True).stdout
    for name in listed.split('\n')[:-1]:
        with open(HERE + '/' + name, 'rb') as f:
            content = f.read()
        if constant and name == 'libcontact/' + constant.split(':')[0]:
            content = scaled(content.decode(), constant, factor).encode()
        path = place + '/' + name
        if os.path.exists(path) and open(path, 'rb').read() == content:
            continue
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'wb') as f:
            f.write(content)
    for step in (['-S', place, '-B', place + '/build', '-DRC_TESTS=OFF'],
                 ['--build', place + '/build', '--target', *TOOLS]):
        subprocess.run(['cmake', *step], check=True, stdout=subprocess.DEVNULL)
    return place + '/build/tools'


def scaled(text, constant, factor):
    name = constant.split(':')[1]
    text, found = re.subn(r'((?:const \w+ |, |^ +)%s =\s+)([^,;\n/]*[^,;\n/ ])|(#define %s +)(\S+)' % (name, name),
                          lambda m: '%s%s(%g * (%s))' % (m[1] or m[3], '(int)' if m[1] and name.isupper() else '', factor,
                                                         m[2] or m[4]), text, flags=re.M)
    if found != 1:
        sys.exit('constants.py: %s: %d declarations instead of one' % (constant, found))
    return text


def execute(tools, command):
    environment = dict(os.environ, PATH=tools + ':' + os.environ['PATH'], RC_THREADS='1', OMP_NUM_THREADS='1')
    return subprocess.run(command, shell=True, cwd=WORK, env=environment, stderr=subprocess.PIPE, check=False).returncode


def run(tools, command, more=''):
    """The frames and the reports of a command; None if it fails."""
    if '--tol' in more:
        command = re.sub(r'--tol \S+', '', command)
    command, file = command.rsplit(' ', 1)
    if execute(tools, '%s %s --quiet --report r.json -o o.rcg %s' % (command, more, file)) not in (0, 3):
        return None
    with open(WORK + '/r.json', encoding='utf-8') as f:
        return stream.read(WORK + '/o.rcg'), [json.loads(line) for line in f]


def errors(command, got, truth):
    """The relative L1 difference of each case; of a pull-off, that of the load."""
    if '--pull-off' in command:
        return [abs(got[1][-1]['load'] / truth[1][-1]['load'] - 1)]
    channel = next(c for c in COMPARED if any(f.channel == c for f in truth[0]))
    pairs = zip(*([f.values for f in frames if f.channel == channel] for frames in (got[0], truth[0])))
    sums = [(numpy.nansum(abs(a - b)), numpy.nansum(abs(b))) for a, b in pairs]
    return [d / s if s > 0 else 0 for d, s in sums]


def work(reports):
    for key in 'convolutions', 'applications':
        if any(r.get(key) for r in reports):
            return sum(r.get(key) or 0 for r in reports)
    return 1


def estimates(reports):
    return [next((r[k] for k in ESTIMATES if r.get(k) is not None), numpy.inf) for r in reports]


def below(command, got, wrong):
    return 0 if '--pull-off' in command else sum(e > 1.02 * t + 1e-12 for e, t in zip(wrong, estimates(got[1])))


def compare(command, new, old, truth):
    """If the result changed, both works, the ratio of the errors, more estimates below the error."""
    e, e0 = errors(command, new, truth), errors(command, old, truth)
    same = work(new[1]) == work(old[1]) and estimates(new[1]) == estimates(old[1]) and not any(errors(command, new, old))
    return (not same, work(new[1]), work(old[1]), max(e) / max(e0) if max(e0) > 0 else 1,
            below(command, new, e) - below(command, old, e0))


def main():
    with open(HERE + '/bench/constants.txt', encoding='utf-8') as f:
        lines = [line.rstrip('\n').split(' ', 2) for line in f if not line.startswith('#')]
    if len(sys.argv) < 3 or sys.argv[1] == 'surface' or sys.argv[1] not in [line[0] for line in lines]:
        sys.exit(__doc__)
    usual = build(WORK + '/usual')
    problems = []
    for chosen, tight, command in lines:
        if chosen == 'surface' and execute(usual, command) != 0:
            sys.exit('constants.py: ' + command)
        if chosen == sys.argv[1]:
            old = run(usual, command)
            problems.append((command, old, old if tight == '-' else run(usual, command, tight.replace('_', ' '))))
    print('constant\tfactor\tchanged\twork\tleast\tmost\terror\tbelow')
    for constant in sys.argv[2:]:
        for factor in 0.5, 2:
            tools = build(WORK + '/changed', constant, factor)
            rows = []
            for command, old, truth in problems:
                new = run(tools, command)
                if new is None:
                    print('%s times %g: %s fails' % (constant, factor, command))
                else:
                    rows.append(compare(command, new, old, truth))
            ratios = [r[1] / r[2] for r in rows]
            print('%s\t%g\t%d of %d\t%.3f\t%.2f\t%.2f\t%.2g\t%+d' % (
                constant, factor, sum(r[0] for r in rows), len(rows), sum(r[1] for r in rows) / sum(r[2] for r in rows),
                min(ratios), max(ratios), max(r[3] for r in rows), sum(r[4] for r in rows)), flush=True)


if __name__ == '__main__':
    main()
