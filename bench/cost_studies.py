#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies of rc-cost for commands of all effects, of one program and of pipes.

    bench/cost_studies.py TOOLS [NAME ...]      TOOLS holds the programs; NAME: only these studies

Each study has its default trials, except for that of OPTIONS. A row has their number (left out ones not counted), those on the front, the proposal for an
error of 1 %, estimate over error of the trials on the map's own grid with an error above 1e-5 (number, smallest, median),
and the processor time of the study over that of its most accurate run. The reference is compared with one that is tighter by
the factor given: the last column has its true error over the error that rc-cost tells for it, `no` where this is above 1.
The proposed command runs twice and must give the same bytes.
"""
import json
import os
import resource
import shlex
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

STEEL = '--E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3'
RUBBER = '--relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid'
LIMITS = '--bending-limit 600MPa --torsion-limit 400MPa'
ROUGH = 'rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 40um --short-cut 8um --seed 7'
BALL = 'rc-synth sphere --nx 48 --dx 10um --radius 7.5mm'
MAPS = {
    'rough': ROUGH,
    'small': ROUGH.replace('--nx 64', '--nx 24'),
    'ball': BALL,
    'contact': f'{BALL} | rc-solve --quiet --load 20N {STEEL}',
    'pressed': f'{ROUGH} | rc-solve --quiet --periodic --mean-pressure 0.5GPa {STEEL}',
}
OPTIONS = {'yield': ['--vary', 'increments=8,16', '--vary', 'slabs=6,12']}  # others than the default trials
# name: map, command, the option that the tighter reference has, its factor
STUDIES = {
    'elastic, periodic': ('rough', 'rc-solve --periodic --mean-pressure 0.5GPa --estar 114GPa', 'tol', 1e-2),
    'elastic, free': ('rough', 'rc-solve --load 0.5N --estar 114GPa', 'tol', 1e-2),
    'hardness': ('rough', 'rc-solve --periodic --mean-pressure 0.5GPa --estar 114GPa --hardness 6GPa', 'tol', 1e-2),
    'list of loads': ('rough', 'rc-solve --periodic --mean-pressure 0.1GPa,0.5GPa,1GPa --estar 114GPa', 'tol', 1e-2),
    'coat': ('rough', 'rc-solve --periodic --mean-pressure 0.5GPa --E1 210GPa --nu1 0.3 --layer 2um,400GPa,0.25 --E2 rigid',
             'tol', 1e-2),
    'travel': ('rough', f'rc-solve --load 5mN --radius 0.5mm {STEEL} --travel=-5um,0,5um', 'tol', 1e-2),
    'yield': ('small', 'rc-solve --periodic --mean-pressure 0.5GPa --E1 210GPa --nu1 0.3 --E2 rigid --yield 2GPa,5GPa',
              'increments', 2),
    'adhesion': ('rough', 'rc-solve --periodic --mean-pressure 1MPa --estar 100MPa --adhesion 1J/m2,exponential,200nm', 'tol',
                 1e-2),
    'creep': ('ball', f'rc-solve --load 20mN {RUBBER} --time 1ms', 'tol', 1e-1),
    'sliding rubber': ('rough', f'rc-solve --periodic --mean-pressure 0.1MPa {RUBBER} --speed 1mm/s', 'tol', 1e-2),
    'partial slip': ('contact', 'rc-slip --mu 0.3 --tangential 3N', 'tol', 1e-2),
    'rolling': ('contact', 'rc-slip --mu 0.3 --steady --creep 1e-3,5e-4', 'tol', 1e-2),
    'wear': ('contact', 'rc-wear --coefficient 1e-5mm3/Nm --distance 10mm', 'tol', 1e-1),
    'deflections': ('pressed', 'rc-deflect', 'tol', 1e-2),
    'stress': ('contact', 'rc-stress --depths 20um:200um:5', 'tol', 1e-2),
    'flash temperature': ('contact', 'rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5,1e-5', 'tol', 1e-2),
    'heating up': ('contact', 'rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5,1e-5 --time 1ms', 'tol', 1e-1),
    'fatigue': ('contact', f'rc-fatigue {LIMITS} --pass x --depths 20um:100um:3', 'tol', 1e-2),
    'leak': ('rough', 'rc-solve --periodic --mean-pressure 0.2GPa --estar 114GPa | rc-leak', 'tol', 1e-2),
    'contact and stress': ('ball', f'rc-solve --load 20N {STEEL} | rc-stress --depths 20um:200um:5', 'tol', 1e-2),
    'contact, rolling, fatigue': ('ball', f'rc-solve --load 20N {STEEL} | rc-slip --mu 0.3 --steady --creep 1e-3,0 | '
                                  f'rc-fatigue {LIMITS} --pass x --depths 20um:100um:3', 'tol', 1e-2),
    'contact, wear, stress': ('ball', f'rc-solve --load 20N {STEEL} | rc-wear --coefficient 1e-5mm3/Nm --distance 10mm | '
                              'rc-stress --depths 20um:200um:5', 'tol', 1e-1),
}


def study(tools, options, file, command):
    """Runs rc-cost; returns its rows and the processor seconds."""
    words = [w for stage in command.split('|') for w in ['|', *shlex.split(stage)]][1:]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run([f'{tools}/rc-cost', '--quiet', '--limit', '1h', *options, '--report', 'r.json', '-o', 'r.txt', file,
                          '--', *words], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if run.returncode not in (0, 3):
        sys.exit(f'{command}: {run.stderr}')
    with open('r.json', encoding='utf-8') as f:
        return [json.loads(line) for line in f], after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def check_reference(tools, file, command, key, factor, reference):
    """Returns the error of this reference against one that is tighter by the factor."""
    value = reference[key]
    others = [w for k in ('slabs',) if k in reference for w in ('--vary', f'{k}={reference[k]:g}')]
    own = ['--grid', '1', '--tol', f'{value:g}'] if key == 'tol' else ['--vary', f'{key}={value:g}']  # --tol: of all programs
    rows, _ = study(tools, [*own, '--reference', f'{key}={value * factor:g}', *others, '--of', reference['of']], file, command)
    return next(r['error'] for r in rows if r['what'] == 'trial')


def main():
    tools = Path(sys.argv[1]).resolve()
    print('| command | trials | front | proposal for 1 % | estimate over error | study over run | reference |')
    print('| --- | --- | --- | --- | --- | --- | --- |')
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.environ.update(PATH=f'{tools}:{os.environ["PATH"]}', RC_THREADS='1', OMP_WAIT_POLICY='passive')
        for name, command in MAPS.items():
            subprocess.run(f'{command} -o {name}.rcg', shell=True, check=True)
        for name, (surface, command, key, factor) in STUDIES.items():
            if sys.argv[2:] and name not in sys.argv[2:]:
                continue
            file = f'{surface}.rcg'
            rows, seconds = study(tools, OPTIONS.get(name, []), file, command)
            reference = next(r for r in rows if r['what'] == 'reference')
            done = [r for r in rows if r['state'] == 'done']
            good = [r for r in done if r['bound'] is not None and r['bound'] <= 0.01]
            proposal = min(good, key=lambda r: r['processor_seconds'], default=None)
            same = '-'
            if proposal is not None:
                bytes_of = [subprocess.run(f'{proposal["command"]} --quiet', shell=True, capture_output=True, check=False).stdout
                            for _ in range(2)]
                same = f'{proposal.get("grid", 1)}, {proposal[key]:g}, ' + ('same bytes' if bytes_of[0] == bytes_of[1] else 'DIFFERS')
            ratios = [r['estimate'] / r['estimate_of_error'] for r in done
                      if r.get('grid', 1) == 1 and r['estimate'] is not None and r['what'] == 'trial'
                      and (r['estimate_of_error'] or 0) > 1e-5]
            told = reference['bound']
            off = check_reference(tools, file, command, key, factor, reference)
            ratio = f'{len(ratios)}, {min(ratios):.2f}, {statistics.median(ratios):.2f}' if ratios else '-'
            if told is None or off is None:
                covered = 'unknown'
            else:
                covered = f'{off:.1e} of {told:.1e}' + ('' if off <= told else ' no')
            print(f'| {name} | {len(done)} of {len(rows)} | {sum(r["front"] for r in done)} | {same} | {ratio} | '
                  f'{seconds / max(reference["processor_seconds"], 1e-3):.1f} | {covered} |', flush=True)


main()
