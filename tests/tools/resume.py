# SPDX-License-Identifier: GPL-3.0-or-later
"""
The law of --resume: a run with one thing changed since its checkpoint is refused, and the message names the
thing, or its result is that of a fresh run with the change. Changed are each option of `--completions json`,
each key of rcg(5) and each frame of the input, and each file that an option names. An option or a key without
a case here breaks the law.

    resume.py quick|full FOLDER [MODE...]

The checkpoint of a complete run is cut after some of its states, as a power failure does; quick: once, full: five
times. The last line has the counts: `refused` and `effective` changes, `wrong` results and refusals that do not name
the change. Many keys are changed at once, and a group that is refused or wrong is divided.
"""
import array
import json
import math
import os
import re
import subprocess
import sys
import zlib

full, folder, only = sys.argv[1] == 'full', sys.argv[2], sys.argv[3:]
os.chdir(folder)
environment = dict(os.environ, LC_ALL='C', RC_THREADS='1')
counts = dict.fromkeys(('modes', 'options', 'keys', 'frames', 'files', 'resumed', 'refused', 'effective', 'impossible',
                        'wrong', 'unnamed', 'broken'), 0)
END = b'RCGEND 1\n'
bound = 1e-4  # rc-solve(1), --resume: at most 1e-4


# ---- streams ----

def parse(data):
    frames, at = [], 0
    while data[at:at + 5] == b'RCG1\n':
        end = data.index(b'\n\n', at)
        keys = dict(line.split('=', 1) for line in data[at + 5:end].decode().split('\n'))
        n = int(keys['nx']) * int(keys['ny'])
        v = array.array('d' if keys['type'] == 'f64' else 'f')
        at = end + 2
        v.frombytes(data[at:at + n * v.itemsize])
        at = data.index(b'\n', at + n * v.itemsize) + 1
        frames.append((keys, v))
    return frames


def stream(frames):
    out = b''
    for keys, v in frames:
        part = b'RCG1\n' + ''.join('%s=%s\n' % k for k in keys.items()).encode() + b'\n' + v.tobytes()
        out += part + b'crc32 %08x\n' % zlib.crc32(part)
    return out + b'RCGEND %d\n' % len(frames)


def tool(args, data=b''):
    r = subprocess.run(args, input=data, capture_output=True, env=environment, timeout=600)
    return r.returncode, r.stdout, r.stderr.decode(errors='replace')


def made(*args, data=b''):
    status, out, words = tool([*args], data)
    if status not in (0, 3):
        sys.exit('%s: %s' % (' '.join(args), words))
    return out


# ---- results ----

COST = re.compile('error|convolutions|iterations|seconds|memory|steps|contacts|kkt|increments|rejected|threads|effects|'
                  'source|method|kernel|applications|passes|fallbacks|cohesive|evaluations|stability|restarts|gain|repulsive|jumps')


def far(a, b, scale):
    if a == b or (a != a and b != b) or max(abs(a), abs(b)) < 1e-18:
        return 0
    return abs(a - b) / scale if scale > 0 else math.inf


def size_of(name, of):
    """The size that a number is compared with: components with the length of their vector."""
    values = [of.get(name)]
    if name[-2:] in ('_x', '_y'):
        values = [of.get(name[:-1] + axis) for axis in 'xy']
    return max((abs(float(v)) for v in values if v is not None), default=0)


def differ(mine, right, rows, right_rows, within, loose):
    """Where two results differ by more than this part, or ''."""
    if len(mine) != len(right):
        return '%d frames instead of %d' % (len(mine), len(right))
    for (k, v), (l, w) in zip(mine, right):
        if set(k) != set(l):
            return '%s: keys %s' % (l['channel'], set(k) ^ set(l))
        for name in l:
            if k[name] == l[name] or name in ('converged', 'height.error', 'pressure.error', 'traction.error'):
                continue
            try:
                if far(float(k[name]), float(l[name]), size_of(name, l)) > 10 * within:
                    return '%s: key %s %s instead of %s' % (l['channel'], name, k[name], l[name])
            except ValueError:
                return '%s: key %s %s instead of %s' % (l['channel'], name, k[name], l[name])
        size = sum(abs(x) for x in w if math.isfinite(x))
        off = sum(far(x, y, size) for x, y in zip(v, w))
        if off > within * (10 if l['channel'] != 'pressure' else 1) and sum(map(abs, v)) + size > 0:
            return '%s off by %.2g' % (l['channel'], off)
    for a, b in zip(rows, right_rows):
        for name in b:
            if COST.search(name) or loose and loose in name or a.get(name) == b[name]:
                continue
            x, y = a.get(name), b[name]
            if x is None or y is None or isinstance(y, (str, dict, list)):
                if not isinstance(y, (str, dict, list)):
                    return 'report: %s %s instead of %s' % (name, x, y)
            elif far(x, y, size_of(name, b)) > 100 * within:
                return 'report: %s %s instead of %s' % (name, x, y)
    return ''


# ---- modes ----

made_maps = {}


def surface(name, *args):
    if name not in made_maps:
        made_maps[name] = made('rc-synth', *args)
        open(name + '.rcg', 'wb').write(made_maps[name])
    return made_maps[name]


def rough():
    return surface('rough', 'selfaffine', '--nx', '16', '--dx', '1um', '--hurst', '.8', '--rms-slope', '.1', '--seed', '3')


def counter():
    return surface('other', 'selfaffine', '--nx', '16', '--dx', '1um', '--hurst', '.8', '--rms-slope', '.1', '--seed', '5')


def with_frame(data, channel, unit, value):
    keys, v = parse(data)[0]
    keys = dict(keys, channel=channel, unit=unit, type='f64')
    return stream(parse(data) + [(keys, array.array('d', (value * (1 + k % 3) for k in range(len(v)))))])


def hard():
    return with_frame(rough(), 'hardness', 'Pa', 3e9)


def solved(*args):
    return lambda: made('rc-solve', '--quiet', *args, data=rough())


STEEL = '--E1 200GPa --nu1 .3 --E2 200GPa --nu2 .3'.split()
MIXED = '--E1 2GPa --nu1 .4 --E2 rigid'.split()
GUM = '--relaxation 10MPa,100MPa:1s --nu1 .4 --E2 100MPa --nu2 .3'.split()
TSV = ('yield.tsv', '0 2GPa\n.1 4GPa\n', '0 3GPa\n.1 4GPa\n')
RELAX = ('relax.txt', 'tau E\n1 100MPa\ninf 10MPa\n', 'tau E\n2 100MPa\ninf 10MPa\n')
PATH = ('path.txt', '5mN 0 0\n10mN 1mN 0\n10mN 2mN 0\n', '5mN 0 0\n10mN 1mN 0\n10mN 1.5mN 0\n')
WEAR = '--coefficient 1e-6mm3/Nm --distance 1cm,10cm --tol .02'.split()


def slip_cycle():
    frames = parse(made('rc-slip', '--quiet', '--mu', '.3', '--path', '10mN,0,0;10mN,2mN,0;10mN,-2mN,0', '--output', 'height,slip',
                        data=solved('--load', '10mN', *STEEL)()))
    return stream(frames)


# name: tool, options, input, files (name, content, other content)
MODES = {
    'list': ('rc-solve', STEEL + '--load 10mN,20mN,30mN --tol 1e-6'.split(), rough, ()),
    'estar': ('rc-solve', '--estar 100GPa --mean-pressure 40MPa,80MPa --periodic --tol 1e-6'.split(), rough, ()),
    'approach': ('rc-solve', STEEL + '--approach .05um,.1um --tol 1e-6'.split(), rough, ()),
    'layer': ('rc-solve', STEEL + '--layer 1um,100GPa,.3 --load 10mN,20mN --tol 1e-6'.split(), rough, ()),
    'history': ('rc-solve', STEEL + '--load 10mN,30mN,5mN --hardness 5GPa --history --tol 1e-6'.split(), rough, ()),
    'map': ('rc-solve', STEEL + '--load 10mN,20mN --history --tol 1e-6'.split(), hard, ()),
    'tilt': ('rc-solve', STEEL + '--load 10mN,20mN --tilt free --at .2um,0 --tol 1e-6'.split(), rough, ()),
    'yield': ('rc-solve', STEEL + '--load 10mN,20mN,5mN --yield 2GPa --increments 2 --slabs 2'.split(), rough, ()),
    'table': ('rc-solve', STEEL + '--load 10mN,20mN --yield yield.tsv --increments 2 --slabs 2'.split(), rough, (TSV,)),
    'adhesion': ('rc-solve', '--estar 10MPa --adhesion 50mJ/m2,exponential,.5um --approach=-.2um,0,.1um --tol 1e-6'.split(), rough, ()),
    'time': ('rc-solve', GUM + '--load 1uN,2uN,1uN --time 0,1s,3s --tol 1e-3'.split(), rough, ()),
    'creep': ('rc-solve', '--relaxation relax.txt --nu1 .4 --E2 rigid --load 1uN --time 1s,3s --increments 4'.split(), rough, (RELAX,)),
    'speed': ('rc-solve', GUM + '--load 1uN --speed 1um/s,3um/s --shift 2 --track repeated --periodic --tol 1e-4'.split(), rough, ()),
    'travel': ('rc-solve', STEEL + '--load 10mN --radius 20um --travel=-2um,0,2um --tol 1e-6'.split(), rough, ()),
    'window': ('rc-solve', STEEL + '--load 10mN --counter other.rcg --counter-travel 0 --travel=-2um,0,2um --window 8x8 --tol 1e-6'.split(), rough, ()),
    'counter': ('rc-solve', STEEL + '--load 10mN --counter other.rcg --travel=-2um,0,2um --periodic --tol 1e-6'.split(), rough, ()),
    'passes': ('rc-solve', STEEL + '--load 10mN --radius 20um --travel=-2um,0,2um --yield 2GPa --increments 2 --slabs 2 --passes 2'.split(), rough, ()),
    'tangential': ('rc-slip', '--mu .3 --tangential 1mN --increments 2 --tol 1e-6'.split(), solved('--load', '10mN', *STEEL), ()),
    'displacement': ('rc-slip', '--mu .3 --displacement 1nm,1nm --nu .3 --increments 2 --tol 1e-6'.split(), solved('--load', '10mN', '--estar', '110GPa'), ()),
    'dissimilar': ('rc-slip', '--mu .3 --tau-max 1GPa --tangential 1mN --increments 2 --tol 1e-5'.split(), solved('--load', '10mN', '--radius', '10um', *MIXED), ()),
    'path': ('rc-slip', ['--mu', '.3', '--path', '10mN,0,0;10mN,2mN,0;10mN,-2mN,0', '--output', 'pressure,traction-x,slip,dissipation'],
             solved('--load', '10mN', *STEEL), ()),
    'path-file': ('rc-slip', '--mu .3 --history path.txt --increments 2'.split(), solved('--load', '10mN', *STEEL), (PATH,)),
    'steady': ('rc-slip', '--mu .3 --creep 1e-2,0 --steady --tol 1e-5'.split(), solved('--load', '10mN', '--radius', '10um', *STEEL), ()),
    'force': ('rc-slip', '--mu .3 --creep-force .5mN --steady --tol 1e-5'.split(), solved('--load', '10mN', '--radius', '10um', *MIXED), ()),
    'positions': ('rc-slip', '--mu .3 --creep 1e-2,0 --tol 1e-5'.split(),
                  solved('--load', '10mN', '--radius', '20um', '--travel=0,1um,2um', *STEEL), ()),
    'wear': ('rc-wear', WEAR, solved('--load', '10mN', *STEEL), ()),
    'archard': ('rc-wear', '--archard 1e-4,1e-4 --hardness 1GPa --distance 1mm,2mm --motion track:60um'.split(),
                solved('--load', '10mN', '--hardness', '8GPa', *STEEL), ()),
    'energy': ('rc-wear', '--energy 1e-6mm3/J --mu .3 --distance 1cm,10cm'.split(),
               lambda: stream(parse(made('rc-solve', '--quiet', '--load', '10mN', *STEEL, data=hard())) + parse(hard())[1:]), ()),
    'coefficient': ('rc-wear', '--distance 1cm,3cm'.split(),
                    lambda: stream(parse(with_frame(solved('--load', '10mN', '--layer', '1um,100GPa,.3', *STEEL)(), 'wear-coefficient', '1/Pa', 1e-15))), ()),
    'cycles': ('rc-wear', '--coefficient 1e-4mm3/Nm --cycles 1e3,1e4'.split(), slip_cycle, ()),
    'sliding': ('rc-wear', '--coefficient 1e-6mm3/Nm,1e-6mm3/Nm --motion sliding --counter other.rcg --distance 1cm,2cm'.split(),
                solved('--load', '10mN', '--periodic', *STEEL), ()),
}

# Not compared: the dissipated energy of dissimilar bodies jumps by some percent also from one --tol to another.
LOOSE = {'dissimilar': 'dissipated'}

# ---- changes ----

SKIPPED = set('report steps checkpoint resume interval dry-run o quiet verbose debug progress help version'.split())
LISTS = {'load': 'load', 'mean-pressure': 'load', 'approach': 'approach', 'time': 'time', 'speed': 'speed', 'travel': 'position',
         'distance': 'distance', 'cycles': 'cycles'}
# option: other values; a list changes by 10 % and grows by itself. None: a flag
OTHER = {
    'rc-solve': {
        'load': ['15mN'], 'mean-pressure': ['50MPa'], 'approach': ['.02um'], 'estar': ['50GPa'], 'E1': ['100GPa'], 'nu1': ['.2'],
        'E2': ['50GPa', 'rigid'], 'nu2': ['.1'], 'layer': ['1um,50GPa,.3', '2um,100GPa,.2'], 'hardness': ['3GPa'], 'radius': ['30um'], 'cylinder': ['20um'],
        'periodic': [None, 'y'], 'datum': ['1mm'], 'yield': ['3GPa', '2GPa,1GPa'], 'adhesion': ['80mJ/m2,exponential,.5um', '50mJ/m2,dugdale,.5um'],
        'history': [None], 'tilt': ['free'], 'at': ['.5um,.5um'], 'increments': ['3'], 'slabs': ['3'],
        'relaxation': ['20MPa,100MPa:1s'], 'shift': ['3'], 'temperature': ['40degC'], 'time': ['0,1s'], 'speed': ['2um/s'], 'along': ['y'], 'track': ['fresh', 'repeated'],
        'pull-off': [None], 'travel': ['-1um'], 'counter': ['rough.rcg'], 'counter-travel': ['.5'], 'window': ['10x10'], 'passes': ['3', '1'],
        'kernel': ['direct', 'mlms'], 'method': ['pk99'], 'tol': ['1e-2', '1e-8'], 'output': ['gap,pressure', 'plastic'], 'stiffness': [None],
        'conductivity': ['45W/mK,16W/mK'], 'discretization': [None], 'body1': ['copper'], 'body2': ['copper'], 'materials': []},
    'rc-slip': {
        'mu': ['.2'], 'tau-max': ['.5GPa'], 'tangential': ['1.5mN', '1mN,1mN'], 'displacement': ['2nm,1nm'],
        'path': ['10mN,0,0;10mN,1mN,0;10mN,-2mN,0', '10mN,0,0;10mN,2mN,0;10mN,-2mN,0;10mN,0,0'], 'history': [], 'creep': ['2e-2,0', '1e-2,0,100'],
        'creep-force': ['.7mN'], 'steady': [None], 'increments': ['3', 'auto'], 'coupling': ['goodman', 'none'], 'nu': ['.2'],
        'E1': ['210GPa'], 'nu1': ['.25'], 'E2': ['190GPa'], 'nu2': ['.25'], 'body1': [], 'body2': [], 'materials': [], 'periodic': [None], 'tol': ['1e-3', '1e-7'],
        'output': ['traction-x,state', 'pressure,slip,dissipation,height']},
    'rc-wear': {
        'coefficient': ['2e-6mm3/Nm', '1e-6mm3/Nm,1e-6mm3/Nm'], 'archard': ['2e-4,1e-4'], 'hardness': ['2GPa'], 'energy': ['2e-6mm3/J'],
        'mu': ['.2'], 'distance': ['2cm'], 'cycles': ['2e3'], 'motion': ['same', 'track:50um'], 'counter': ['rough.rcg'],
        'until': ['depth=1nm'], 'tol': ['.05', '.2'], 'output': ['height', 'pressure,wear,contact']},
}
COMMON = {'threads': ['2'], 'memory': ['4G'], 'type': ['f32']}
# both bodies of rc-slip, which must be those of the stream
TOGETHER = {('rc-slip', o): '--E1 200GPa --nu1 .3 --E2 200GPa --nu2 .3'.split() for o in ('E1', 'nu1', 'E2', 'nu2')}
TOGETHER['rc-solve', 'temperature'] = '--shift wlf,17.44,51.6,20degC'.split()
# the stream fixes bodies and boundary; of the path and of a table of materials only the contents change
FIXED = {('rc-slip', o) for o in 'history E1 nu1 E2 nu2 body1 body2 materials periodic'.split()} | {('rc-solve', 'materials')}
# keys of rcg(5): other values
KEYS = {
    'case': [], 'source': ['other'], 'file.*': [], 'history': ['rc-synth 0 sphere'], 'periodic': ['yes', 'x'], 'filled': ['3'], 'outliers': ['3'], 'spikes': ['3'],
    'dunit': [], 'taper': ['2e-6'], 'form.radius': ['1'], 'form': ['sphere 1e-3'], 'boundary': ['periodic', 'free', 'periodic-y'], 'datum': ['1e-3'], 'estar': ['1e11'],
    'e1': ['1.5e11'], 'nu': ['.25'], 'e2': ['1.5e11'], 'nu2': ['.25'], 'load': ['.02'], 'hardness': ['3e9'], 'hardness_map': ['yes'], 'separated': ['yes'],
    'cycles': ['3'], 'wear_1': ['1e-15'], 'wear_2': ['1e-15'], 'coat_left': ['1e-3'], 'bending_limit': ['1e8'], 'torsion_limit': ['1e8'], 'yield': ['1e9'],
    'hardening': ['1e9'], 'slabs': ['3'], 'approach': ['1e-7'], 'position': ['1e-6'], 'height': ['1e-6'], 'converged': ['yes', 'no'],
    'window_x': ['1e-6'], 'creep_x': ['1'], 'creep_y': ['1'], 'spin': ['1'], 'friction': ['.2'], 'tau_max': ['1e9'], 'tangential_x': ['1'],
    'tangential_y': ['1'], 'displacement_x': ['1'], 'displacement_y': ['1'], 'mu': ['.3'], 'depth': ['1e-6'],
    'layers': ['1e-6,1e11,0.3;inf,2e11,0.3', '1e-6,5e10,0.3;inf,2e11,0.3'], 'layers.residual': ['1e8'], 'height.error': ['1e-7'], 'pressure.error': ['1e-3'], 'traction.error': ['1e-3'],
    'material': ['1'], 'frames': ['2'], 'section': ['x'], 'at': ['0'], 'depths': ['0'], 'adhesion': ['0.05,jkr,1e-9'],
    'time': ['2'], 'speed': ['.1'], 'distance': ['.1'], 'thickness': ['1e-6'], 'window': ['hann'], 'max_temperature': ['10'],
    'direction': ['x'], 'flow_conductance': ['1e-18'], 'flow_rate': ['1e-9'], 'pressure_drop': ['1e6'], 'viscosity': ['1e-3'],
    'throat_x': ['0'], 'throat_y': ['0'], 'align.shift_x': ['1e-6'], 'align.shift_y': ['1e-6'], 'align.rotation': ['1e-3'],
    'align.residual': ['1e-9'], 'align.volume': ['1e-15'], 'align.volume_error': ['1e-17'],
}
FRAMES = {'height': 'm', 'pressure': 'Pa', 'gap': 'm', 'displacement': 'm', 'contact': '1', 'hardness': 'Pa', 'wear-coefficient': '1/Pa', 'slip': 'm'}


def page_keys():
    page = open(os.path.join(os.environ['RC_SOURCE'], 'man/rcg.5')).read()
    part = page[page.index('.Ss Other keys'):page.index('.Ss Axes and signs')]
    return re.findall(r'[\w.*]+', ' '.join(re.findall(r'^\.It Cm (.*)$', part, re.M)))


def table_of(name):
    return json.loads(made(name, '--completions', 'json'))['options']


def value_at(args, option):
    """The place of an option in a command line, and its value."""
    for k, word in enumerate(args):
        if word == '--' + option:
            flag = k + 1 == len(args) or args[k + 1].startswith('--')
            return k, 1 if flag else 2, None if flag else args[k + 1]
        if word.startswith('--' + option + '='):
            return k, 1, word.split('=', 1)[1]
    return None, 0, None


def scaled(item, by):
    return re.sub(r'[0-9.]+(e-?[0-9]+)?', lambda m: repr(float(m[0]) * by), item, count=1)


def option_changes(name, row, args):
    """Command lines with another value of an option, without it, and with a longer list."""
    option = row['name']
    if option in SKIPPED:
        return
    at, words, now = value_at(args, option)
    others = OTHER[name].get(option, COMMON.get(option))
    if others is None:
        broken('no case for --%s of %s' % (option, name))
        return
    if at is not None:
        yield args[:at] + args[at + words:], False
    if at is not None and option in LISTS:
        items = now.split(',')
        others = [','.join([scaled(items[0], 1.1)] + items[1:]), ','.join(items[:-1] + [scaled(items[-1], 1.1)])]
        yield args[:at] + ['--%s=%s' % (option, now + ',' + scaled(items[-1], 1.5))] + args[at + words:], len(items) > 1
    for value in others:
        if at is not None and value == now:
            continue
        one = ['--' + option] if value is None else ['--%s=%s' % (option, value)]
        rest = args if at is None else args[:at] + args[at + words:]
        together = TOGETHER.get((name, option), []) if at is None else []
        k = value_at(together, option)[0]
        if k is not None:
            together = together[:k] + together[k + 2:]
        yield rest + together + one, False


# ---- the law ----

def broken(what):
    counts['broken'] += 1
    print('BROKEN:', what, flush=True)


class Mode:
    def __init__(self, name):
        self.name = name
        self.tool, self.args, maker, self.files = MODES[name]
        counter(), rough()
        self.write_files(1)
        self.data = maker()
        self.fresh_of = {}
        self.file = 'state.ck'
        if os.path.exists(self.file):
            os.remove(self.file)
        self.base = self.run(self.args + ['--checkpoint', self.file, '--interval', '1e-9'], self.data)
        if self.base[0] not in (0, 3):
            sys.exit('mode %s: %s' % (name, self.base[3]))
        data = open(self.file, 'rb').read()
        ends = [m.end() for m in re.finditer(END, data)]
        few = sorted({max(1, round(len(ends) * part)) for part in ((.2, .4, .6, .8, .95) if full else (.6,))} - {len(ends)})
        self.cuts = [data[:ends[k - 1]] for k in few] + [data]
        self.known = {}  # what is wrong already without a change

    def write_files(self, which):
        for f in self.files:
            open(f[0], 'w').write(f[which])

    def run(self, args, data):
        for f in ('out.rcg', 'report.json'):
            if os.path.exists(f):
                os.remove(f)
        status, _, words = tool([self.tool, '--quiet', *args, '--report', 'report.json', '-o', 'out.rcg'], data)
        frames = parse(open('out.rcg', 'rb').read()) if os.path.exists('out.rcg') else []
        rows = [json.loads(line) for line in open('report.json')] if os.path.exists('report.json') else []
        return status, frames, rows, words

    def fresh(self, args, data):
        key = (tuple(args), hash(data), self.files and open(self.files[0][0]).read())
        if key not in self.fresh_of:
            self.fresh_of[key] = self.run(args, data)
        return self.fresh_of[key]

    def within(self, args):
        now = value_at(args, 'tol')[2]
        return bound if now == value_at(self.args, 'tol')[2] else max(bound, 2 * float(now or 1e-3))

    def attempt(self, names, args, data, cut):
        """What a resumed run with a change does: impossible, refused, unnamed, wrong or effective; and why."""
        open('again.ck', 'wb').write(cut)
        status, frames, rows, words = self.run(args + ['--checkpoint', 'again.ck', '--resume'], data)
        counts['resumed'] += 1
        if status == 2:
            return 'impossible', ''
        named = re.search('another (problem|grid).*', words)
        if status == 1 and named and names and re.search(names, named[0]):
            return 'refused', named[0]
        right = self.fresh(args, data)
        if right[0] not in (0, 3):
            return ('wrong', 'exit %d, a fresh run %d' % (status, right[0])) if status in (0, 3) else ('impossible', '')
        if status not in (0, 3):
            return 'unnamed', 'exit %d, and not by its name: %s' % (status, words.strip()[-200:])
        if status != right[0]:
            return 'wrong', 'exit %d, a fresh run %d: %s' % (status, right[0], words.strip()[-160:])
        why = differ(frames, right[1], rows, right[2], self.within(args), LOOSE.get(self.name))
        if names is None:
            self.known[len(cut)] = why
        elif why.split(' ')[:3] == self.known.get(len(cut), '').split(' ')[:3]:
            why = ''
        return ('wrong' if why else 'effective'), why

    def resume(self, what, names, args, data, free=False):
        """True if the change is possible in this mode."""
        for cut in self.cuts:
            outcome, why = self.attempt(names, args, data, cut)
            if outcome == 'refused' and free and self.fresh(args, data)[0] in (0, 3):
                outcome, why = 'wrong', 'refused, although the page lets it change: ' + why
            counts[outcome] += 1
            if outcome == 'impossible':
                return False
            if outcome in ('wrong', 'unnamed'):
                broken('%s, checkpoint of %d of %d bytes: %s: %s' % (self.name, len(cut), len(self.cuts[-1]), what, why))
        return True

    def options(self, rows, possible):
        for row in rows:
            for args, longer in option_changes(self.tool, row, self.args):
                option = row['name']
                names = LISTS.get(option, r'--%s\b' % re.escape(option))
                if (self.tool, option) in TOGETHER:
                    names = '--E1|' + names
                free = (longer and self.tool != 'rc-slip' and option != 'time' and '--passes' not in self.args) or \
                    (not row.get('result', True) and 'dissipation' not in args[-1] and 'dissipation' not in ' '.join(self.args))
                if self.resume('--%s: %s' % (option, ' '.join(args)), names, args, self.data, free):
                    possible.add((self.tool, option))

    def key_changes(self, names):
        for f, (keys, _) in enumerate(parse(self.data)):
            for key in names + [k for k in keys if k not in names]:
                now = keys.get(key)
                if key in ('channel', 'nx', 'ny', 'unit', 'type', 'dx', 'dy'):
                    continue
                if key not in KEYS:
                    broken('no case for the key %s' % key)
                    continue
                for value in [v for v in KEYS[key] if v != now] + ([None] if now is not None and KEYS[key] else []):
                    yield f, key, value

    def keys(self, names):
        """Changes many keys at once; a group that is refused or wrong is divided."""
        frames = parse(self.data)
        changes = list(self.key_changes(names))
        counts['frames'] += len(frames)
        counts['keys'] += len(changes)
        groups = []  # of changes of different keys
        for change in changes:
            for group in groups:
                if change[:2] not in [c[:2] for c in group]:
                    group.append(change)
                    break
            else:
                groups.append([change])
        while groups:
            group = groups.pop()
            changed = [(dict(k), v) for k, v in frames]
            for f, key, value in group:
                changed[f][0][key] = value
                if value is None:
                    del changed[f][0][key]
            data = stream(changed)
            pattern = r'key (%s) was|^another problem: (%s) was' % (('|'.join(re.escape(key) for _, key, _ in group),) * 2)
            for cut in self.cuts:
                outcome, why = self.attempt(pattern, self.args, data, cut)
                if outcome == 'refused' and len(group) > 1:
                    key = next(filter(None, re.search(pattern, why).groups()))
                    groups += [[c] for c in group if c[1] == key] + [[c for c in group if c[1] != key]]
                    groups = [g for g in groups if g]
                    break
                if outcome != 'effective' and len(group) > 1:
                    groups += [group[:len(group) // 2], group[len(group) // 2:]]
                    break
                counts[outcome] += len(group)
                if outcome in ('wrong', 'unnamed'):
                    f, key, value = group[0]
                    broken('%s, checkpoint of %d of %d bytes: key %s of %s is %s: %s' %
                           (self.name, len(cut), len(self.cuts[-1]), key, frames[f][0]['channel'], value, why))
                if outcome == 'impossible':
                    break

    def frames(self):
        frames = parse(self.data)
        wider = [(dict(k, dx=repr(float(k['dx']) * 1.1)), v) for k, v in frames]
        self.resume('another dx', 'another grid|load was', self.args, stream(wider))
        for f, (keys, v) in enumerate(frames):
            channel = keys['channel']
            same = lambda x: 1 - x if channel == 'contact' else x * 1.05
            changed = frames[:f] + [(keys, array.array(v.typecode, map(same, v)))] + frames[f + 1:]
            self.resume('frame %s changed' % channel, 'frame (%s|height|pressure)|(load|distance|cycles) was' % channel, self.args, stream(changed))
            self.resume('frame %s left out' % channel, 'frame %s|(load|distance|cycles) was' % channel, self.args, stream(frames[:f] + frames[f + 1:]))
        for channel, unit in FRAMES.items():
            if not any(k['channel'] == channel for k, _ in frames):
                keys = dict(frames[0][0], channel=channel, unit=unit, type='f64')
                v = [1 if unit == '1' else 2e9 if unit == 'Pa' else 1e-15 if unit == '1/Pa' else 1e-9] * len(frames[0][1])
                self.resume('frame %s added' % channel, 'frame %s' % channel, self.args, stream(frames + [(keys, array.array('d', v))]))

    def contents(self):
        for f in self.files:
            counts['files'] += 1
            self.write_files(2)
            self.resume('content of %s' % f[0], 'contents of|--path', self.args, self.data)
            self.write_files(1)
        if 'other.rcg' in self.args:
            counts['files'] += 1
            keys, v = parse(counter())[0]
            for changed in ((keys, array.array('d', (1.1 * x for x in v))), (dict(keys, periodic='no'), v)):
                open('other.rcg', 'wb').write(stream([changed]))
                self.resume('content of other.rcg', 'frame counter|key counter', self.args, self.data)
            open('other.rcg', 'wb').write(counter())


possible, tables = set(), {}
for name in only or MODES:
    mode = Mode(name)
    counts['modes'] += 1
    if mode.tool not in tables:
        tables[mode.tool] = table_of(mode.tool)
        counts['options'] += sum(r['name'] not in SKIPPED for r in tables[mode.tool])
    mode.resume('nothing', None, mode.args, mode.data)
    mode.options(tables[mode.tool], possible)
    mode.keys(page_keys())
    mode.frames()
    mode.contents()
if not only:
    for name, rows in tables.items():
        for row in rows:
            if row['name'] not in SKIPPED and (name, row['name']) not in possible | FIXED:
                broken('--%s of %s is possible in no mode' % (row['name'], name))
print(', '.join('%s %d' % item for item in counts.items()))
sys.exit(counts['broken'] > 0)
