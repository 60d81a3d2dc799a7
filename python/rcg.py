"""Grid streams (RCG1) as numpy arrays, and the rc-* tools on them.

    import numpy, rcg
    surface = rcg.frame('height', heights, dx=1.1e-6)             # a 2-D array, metres
    frames, lines = rcg.report('rc-solve', surface, load='60N', estar='114GPa')
    pressure = frames[0].values                                   # pascals
    area = lines[0]['contact_area']                               # square metres

The stream is described in rcg(5), each tool in a page of its own.
"""
import json
import os
import re
import subprocess
import tempfile
import warnings
import zlib

import numpy

__version__ = '0.1.0'
__all__ = ['Error', 'Frame', 'frame', 'loads', 'read', 'dumps', 'write', 'run', 'report']

HEADER_MAX = 65536
REQUIRED = ('channel', 'nx', 'ny', 'dx', 'dy', 'unit', 'type')
KEY = re.compile(r'[a-z][a-z0-9._-]*\Z')
NUMBER = re.compile(r'[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\Z')
UNITS = dict.fromkeys(('height', 'gap', 'displacement', 'plastic', 'residual'), 'm')
UNITS.update(dict.fromkeys('pressure hardness sxx syy szz sxy sxz syz mises tresca s1 s2 s3'.split(), 'Pa'))
UNITS.update(dict.fromkeys('exx eyy exy exz eyz peeq'.split(), '1'))
TYPES = {'f64': numpy.dtype('<f8'), 'f32': numpy.dtype('<f4')}
# Where a tool has its report lines when it has no --report.
LINES_ON_OUTPUT = {'rc-info': '--json'}


class Error(Exception):
    """A stream that is damaged, or a tool that failed: its words, and `status`, its exit status.

    Where a tool stopped short of the accuracy asked for (status 3), `frames` and `lines` hold the
    best it has found, marked converged=no.
    """

    def __init__(self, words, status=1, frames=(), lines=()):
        super().__init__(words)
        self.status = status
        self.frames = list(frames)
        self.lines = list(lines)


# ---- frames ----

class Frame:
    """One map: `values`, a 2-D array whose row 0 is the first, and `keys`, the lines of its header.

    `channel`, `unit`, `dx`, `dy` and `dunit`, the unit of these (m where there is no such key), are
    taken from the keys. When the frame is written,
    `nx`, `ny` and `type` are those of the values: float32 is f32, everything else f64.
    """

    def __init__(self, values, keys):
        self.values = values
        self.keys = keys

    def __repr__(self):
        ny, nx = self.values.shape
        return '<rcg.Frame %s: %d x %d nodes of %s x %s %s, %s>' % (
            self.channel, nx, ny, self.keys['dx'], self.keys['dy'], self.dunit, self.unit)

    @property
    def channel(self):
        return self.keys['channel']

    @channel.setter
    def channel(self, name):
        self.keys['channel'] = name

    @property
    def unit(self):
        return self.keys['unit']

    @property
    def dunit(self):
        return self.keys.get('dunit', 'm')

    @property
    def dx(self):
        return float(self.keys['dx'])

    @property
    def dy(self):
        return float(self.keys['dy'])


def _text(value):
    """As it stands in a header or on a command line; numbers as the shortest that read back."""
    if isinstance(value, (bool, numpy.bool_)):
        return 'yes' if value else 'no'
    if isinstance(value, (int, numpy.integer)):
        return '%d' % value
    if isinstance(value, (float, numpy.floating)):
        for digits in (15, 16, 17):
            text = '%.*g' % (digits, value)
            if float(text) == value:
                break
        return text
    if isinstance(value, str):
        return value
    raise TypeError('%r is neither a text nor a number' % (value,))


def _array(values):
    """Two dimensions, float32 or float64; one row is a profile, what is masked is missing."""
    if isinstance(values, numpy.ma.MaskedArray):
        kind = values.dtype if values.dtype.kind == 'f' else numpy.float64
        values = values.astype(kind).filled(numpy.nan)
    values = numpy.atleast_2d(numpy.asarray(values))
    if values.dtype.kind not in 'biuf':
        raise TypeError('values of type %s are no real numbers' % values.dtype)
    if values.ndim != 2 or values.size == 0:
        raise ValueError('values of shape %r are no map: give rows and columns' % (values.shape,))
    single = values.dtype.kind == 'f' and values.dtype.itemsize == 4
    return values.astype(numpy.float32 if single else numpy.float64)


def frame(channel, values, dx, dy=None, unit=None, **keys):
    """A Frame of these values: spacings in metres or dunit= (dy as dx), the unit that of the channel.

    Further keys become lines of the header: frame('pressure', p, dx=1e-6, case=2, load=60.0).
    """
    unit = UNITS.get(channel) if unit is None else unit
    if unit is None:
        raise ValueError('the unit of channel %r is not known: give unit=' % channel)
    values = _array(values)
    ny, nx = values.shape
    head = {'channel': channel, 'nx': str(nx), 'ny': str(ny), 'dx': _text(dx),
            'dy': _text(dx if dy is None else dy), 'unit': unit, 'type': _type(values)}
    for name, value in keys.items():
        if name in head:
            raise ValueError('%s is not a further key: it comes from the other arguments' % name)
        head[name] = _text(value)
    made = Frame(values, head)
    _header(made)  # refuses what no stream can hold
    return made


def _type(values):
    return 'f32' if values.dtype.itemsize == 4 else 'f64'


def _frames(frames):
    return [frames] if isinstance(frames, Frame) else list(frames)


# ---- writing ----

def _header(made):
    ny, nx = made.values.shape
    keys = dict(made.keys)
    keys.update(nx=str(nx), ny=str(ny), type=_type(made.values))
    lines = ['RCG1']
    for name in REQUIRED:
        if name not in keys:
            raise ValueError('a frame without the key %s' % name)
    for name, value in keys.items():
        if not KEY.match(name):
            raise ValueError('key %r is not of the form [a-z][a-z0-9._-]*' % name)
        if not isinstance(value, str) or '\0' in value:
            raise ValueError('key %s=%r: the value must be a text without NUL' % (name, value))
        lines.append(name + '=' + value.replace('\\', '\\\\').replace('\n', '\\n'))
    _spacings(keys, ValueError)
    _case(keys, ValueError)
    head = ('\n'.join(lines) + '\n\n').encode()
    if len(head) > HEADER_MAX:
        raise ValueError('a header of %d bytes: %d is the most' % (len(head), HEADER_MAX))
    return head


def dumps(frames):
    """The stream of a frame or a list of them, as bytes."""
    parts = []
    frames = _frames(frames)
    for f in frames:
        whole = Frame(_array(f.values), f.keys)
        body = _header(whole) + whole.values.astype(TYPES[_type(whole.values)]).tobytes()
        parts.append(body)
        parts.append(b'crc32 %08x\n' % zlib.crc32(body))
    parts.append(b'RCGEND %d\n' % len(frames))
    return b''.join(parts)


def write(file, frames):
    """Writes the stream of the frames into a file: its name, or one that is open in binary."""
    data = dumps(frames)
    if hasattr(file, 'write'):
        file.write(data)
        return
    with open(file, 'wb') as out:
        out.write(data)


# ---- reading ----

def _spacings(keys, error):
    for name in ('dx', 'dy'):
        text = keys[name]
        if not NUMBER.match(text) or not 0 < float(text) < float('inf'):
            raise error('%s=%s: it must be a number of metres above 0' % (name, text))


def _case(keys, error):
    text = keys.get('case', '1')
    if not re.match(r'[0-9]{1,15}\Z', text) or int(text) == 0:
        raise error('case=%s is not a whole number from 1' % text)
    return int(text)


def _cut(where):
    return Error('the stream stops %s: the program that wrote it died or the file is cut off; '
                 'run that program again' % where)


def _value(name, raw):
    """Of a header line, its escapes resolved."""
    def resolved(match):
        if match.group(1) not in (b'\\', b'n'):
            raise Error('the value of header key %s holds a backslash that is neither \\\\ nor \\n'
                        % name)
        return b'\n' if match.group(1) == b'n' else b'\\'

    try:
        return re.sub(br'\\(.?)', resolved, raw, flags=re.DOTALL).decode('utf-8')
    except UnicodeDecodeError:
        raise Error('the value of header key %s is not UTF-8' % name) from None


def _head(data, at):
    """The keys of the header whose first line ends before data[at], and where its values begin."""
    start, keys = at - len(b'RCG1\n'), {}
    while True:
        end = data.find(b'\n', at, start + HEADER_MAX)
        if end < 0:
            if len(data) < start + HEADER_MAX:
                raise _cut('inside a header')
            raise Error('the header is longer than %d bytes' % HEADER_MAX)
        line, at = data[at:end], end + 1
        if not line:
            break
        if b'\0' in line:
            raise Error('the header holds a NUL byte')
        name, equals, raw = line.partition(b'=')
        name = name.decode('utf-8', 'replace')
        if not equals or not KEY.match(name):
            raise Error('header line %r is not KEY=VALUE with a key of the form '
                        '[a-z][a-z0-9._-]*' % line[:60].decode('utf-8', 'replace'))
        if name in keys:
            raise Error('header key %s stands twice' % name)
        keys[name] = _value(name, raw)
    for name in REQUIRED:
        if name not in keys:
            raise Error('the header has no %s= line' % name)
    for name in ('nx', 'ny'):
        if not re.match(r'[0-9]+\Z', keys[name]) or int(keys[name]) == 0:
            raise Error('%s=%.40s is not a whole number above 0' % (name, keys[name]))
    _spacings(keys, Error)
    if keys['type'] not in TYPES:
        raise Error('type=%.40s is neither f64 nor f32' % keys['type'])
    return keys, at


def _one(data, start, at):
    """The frame whose first line is data[start:at], and where the next line begins."""
    keys, at = _head(data, at)
    nx, ny, kind = int(keys['nx']), int(keys['ny']), TYPES[keys['type']]
    end = at + nx * ny * kind.itemsize
    if end > len(data):
        raise _cut('inside the values of a frame')
    found = data[end:end + len(b'crc32 01234567\n')]
    wanted = b'crc32 %08x\n' % zlib.crc32(memoryview(data)[start:end])
    if found != wanted:
        if len(found) < len(wanted):
            raise _cut('before the checksum of a frame')
        if not re.match(rb'crc32 [0-9a-f]{8}\n', found):
            raise Error('no crc32 line follows the values: nx, ny or type in the header do not '
                        'match the data')
        raise Error("the checksum is %s, the data's is %s: the stream is damaged; make it again"
                    % (found[6:14].decode(), wanted[6:14].decode()))
    values = numpy.frombuffer(data, kind, nx * ny, at).reshape(ny, nx)
    return Frame(values.astype(kind.newbyteorder('=')), keys), end + len(wanted)


def _failure(line):
    words = line[len(b'RCGFAIL'):].decode('utf-8', 'replace').strip()
    tail = ' (exit status 2)'
    status = 2 if words.endswith(tail) else 1
    words = words[:-len(tail)] if status == 2 else words
    words = ''.join(c if c.isprintable() else '?' for c in words) or 'without a message'
    return Error('the program that wrote this stream failed: ' + words, status)


def loads(data):
    """The frames of a stream, or of several one after another: their cases are numbered on."""
    data = bytes(data)
    frames, first, last, whole, ended, at = [], 0, 0, 0, False, 0
    while at < len(data):
        start, end = at, data.find(b'\n', at)
        line, at = (data[at:], len(data)) if end < 0 else (data[at:end], end + 1)
        if line.startswith(b'RCGFAIL') and end >= 0:
            raise _failure(line)
        if line == b'RCG1' and end >= 0:
            made, at = _one(data, start, at)
            number = first + _case(made.keys, Error)
            if first > 0:
                made.keys['case'] = str(number)
            last = max(last, number)
            frames.append(made)
            whole, ended = whole + 1, False
        elif line.startswith(b'RCGEND ') and end >= 0:
            if line[7:] != b'%d' % whole:
                raise Error('the end line counts %s frames, %d were read: frames are missing'
                            % (line[7:27].decode('utf-8', 'replace'), whole))
            first, whole, ended = last, 0, True
        elif end < 0 and (b'RCG1'.startswith(line) or line.startswith(b'RCG')):
            raise _cut('inside a line')
        else:
            raise Error('%r stands where a frame or an end line should: this is no grid stream, '
                        'or a damaged one' % line[:40].decode('utf-8', 'replace'))
    if not ended:
        raise _cut('without an end line' if frames else 'before it begins')
    return frames


def read(file):
    """The frames of a file: its name, or one that is open in binary."""
    if hasattr(file, 'read'):
        return loads(file.read())
    with open(file, 'rb') as stream:
        return loads(stream.read())


# ---- the tools ----

def _option(name, value):
    """The words that stand for name=value on a command line."""
    dashes = '-' if len(name) == 1 else '--'
    name = dashes + name.replace('_', '-')
    if value is None or value is False:
        return []
    if value is True:
        return [name]
    if isinstance(value, (list, tuple, numpy.ndarray)):
        return [name, ','.join(_text(v) for v in value)]
    return [name, os.fspath(value) if hasattr(value, '__fspath__') else _text(value)]


def _call(tool, frames, args, options):
    """Exit status, standard output and words of a tool."""
    command = [tool] + [a if isinstance(a, str) else os.fspath(a) if hasattr(a, '__fspath__')
                        else _text(a) for a in args]
    for name, value in options.items():
        command += _option(name, value)
    given = {'stdin': subprocess.DEVNULL} if frames is None else {'input': dumps(frames)}
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **given)
    except FileNotFoundError:
        raise Error('%s: not found: install the tools, or name their folder in PATH' % tool,
                    127) from None
    words = done.stderr.decode('utf-8', 'replace').strip()
    if done.returncode not in (0, 3):
        if done.returncode < 0 and not words:
            words = '%s: ended by signal %d' % (tool, -done.returncode)
        raise Error(words, done.returncode)
    return done.returncode, done.stdout, words


def _frames_out(tool, output):
    if output and not output.startswith(b'RCG'):
        raise Error('%s has written something else than a grid stream: run it without rcg' % tool)
    return loads(output) if output else []


def _finish(status, words, frames, lines):
    if status != 0:
        raise Error(words, status, frames, lines)
    if words:
        warnings.warn(words, stacklevel=3)


def run(tool, frames=None, *args, **options):
    """Runs a tool on the frames (None: it reads none) and gives the frames that come out.

    run('rc-solve', surface, load='60N', estar='114GPa', periodic=True) is
    rc-solve --load 60N --estar 114GPa --periodic. Numbers are SI, a list is joined by commas, _ in
    a name is -, one letter is a short option. What stands in args is passed on as it is, before
    the options. What the tool says although it did its work becomes a warning.
    """
    status, output, words = _call(tool, frames, args, options)
    found = _frames_out(tool, output)
    _finish(status, words, found, [])
    return found


def report(tool, frames, *args, **options):
    """As run, with the lines of the tool's report: the frames and a list of dicts."""
    if os.path.basename(tool) in LINES_ON_OUTPUT:
        args += (LINES_ON_OUTPUT[os.path.basename(tool)],)
        status, output, words = _call(tool, frames, args, options)
        found, text = [], output.decode('utf-8')
    else:
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, 'report.json')
            status, output, words = _call(tool, frames, args, dict(options, report=name))
            found = _frames_out(tool, output)
            with open(name, encoding='utf-8') as file:
                text = file.read()
    lines = [json.loads(line) for line in text.splitlines()]
    _finish(status, words, found, lines)
    return found, lines
