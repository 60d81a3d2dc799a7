# SPDX-License-Identifier: GPL-3.0-or-later
"""The rc-* tools as functions, made from the option tables of the tools, so that both agree.

Tables come from the file tables.json beside this module, which the build makes, or from the tools
themselves (`rc-solve --completions json`).
"""
import contextlib
import json
import keyword
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
import warnings

import numpy

from . import stream
from .stream import Error, Frame

# The functions and their tools. An import of files is `open`: import is a word of Python.
FUNCTIONS = {name: 'rc-' + name for name in
             'add cost deflect detrend export fatigue heat info leak pick render report scene slip solve stress synth wear'.split()}
FUNCTIONS['open'] = 'rc-import'
# Options that the functions set themselves, or that print text for people at a terminal.
HIDDEN = {'o', 'report', 'json', 'help', 'version', 'verbose', 'debug', 'progress', 'formats', 'list', 'dry-run'}
PIPE_BYTES = 1 << 20
PATIENCE = 0.4  # seconds that an interrupted tool has after each of two signals, before it is killed
PROGRESS_AFTER = 2.0  # seconds without progress, so that short runs show none
# What repr() shows of a report.
SHOWN_FIGURES = ('load', 'contact_area', 'contact_fraction', 'max_pressure', 'mean_pressure', 'approach',
                 'pressure_error_estimate')


class ToolWarning(UserWarning):
    """A warning of a tool that did its work; `tool` is its name."""

    def __init__(self, text, tool):
        super().__init__(text)
        self.tool = tool

    def __reduce__(self):
        return ToolWarning, (str(self), self.tool), self.__dict__


class NotConverged(Error):
    """A tool stopped short of the requested accuracy: `result` holds the best result it found."""

    def __init__(self, text, result):
        super().__init__(text, 3, result.frames, result.lines)
        self.result = result

    def __reduce__(self):
        return NotConverged, (str(self), self.result), self.__dict__


# ---- folders of the tools and their tables ----

_found, _tables = {}, {}


def place(tool):
    """The path of an rc-* tool: the folder RC_BIN, else beside this package as pip installed both, else PATH."""
    if os.sep in tool or not tool.startswith('rc-'):
        return tool
    if 'RC_BIN' in os.environ:
        return os.path.abspath(os.path.join(os.environ['RC_BIN'], tool))  # tools may run in another folder
    if not _found:
        _found.update(_installed())
    return _found.get(tool, tool)


def _installed():
    from importlib import metadata
    found = {'': ''}
    try:
        for file in metadata.files('rough-contact') or ():
            if file.name.startswith('rc-') and file.parent.name == 'bin':
                found[file.name] = os.path.realpath(file.locate())
    except metadata.PackageNotFoundError:
        pass
    return found


def table(tool):
    """The option table of a tool, as its --completions json prints it."""
    if not _tables:
        name = os.path.join(os.path.dirname(__file__), 'tables.json')
        if os.path.exists(name):
            with open(name, encoding='utf-8') as file:
                _tables.update((row['tool'], row) for row in map(json.loads, file))
    if tool not in _tables:
        status, output, words = execute([tool, '--completions', 'json'])
        if status != 0:
            raise Error(words, status)
        _tables[tool] = json.loads(output)
    return _tables[tool]


def options_of(tool):
    """{keyword of Python: row of the option table}."""
    rows = {}
    for row in table(tool)['options']:
        for name in (row['name'], row['alias']):
            if name is not None and row['name'] not in HIDDEN:
                rows[python_name(name)] = row
    return rows


def python_name(option):
    """pull-off is pull_off; yield, a word of Python, is yield_."""
    name = option.replace('-', '_')
    return name + '_' if keyword.iskeyword(name) else name


# ---- one run of a tool ----

def execute(command, data=None, timeout=None, progress=False, folder=None, started=None):
    """Runs a command on a sequence of bytes (None: no input): exit status, output (see _taken), messages.

    progress: False; None shows it where a person watches; True always; or a function of a dict with the keys
    progress (the share of the case that is done, or None), tool and text. folder: where the command runs.
    started: a function of the process, through which another thread can end it.
    """
    shown, failures, messages, late = _progress_of(progress), [], [], []
    if timeout is not None and not 0 <= timeout <= threading.TIMEOUT_MAX:
        raise ValueError('timeout=%r: it must be a number of seconds' % (timeout,))
    try:
        child = subprocess.Popen([place(command[0])] + ['--progress=json'] * (shown is not None) + command[1:],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=folder,
                                 stdin=subprocess.DEVNULL if data is None else subprocess.PIPE)
    except FileNotFoundError:
        raise Error('%s: not found: install the tools, or name their folder in PATH or RC_BIN' % command[0], 127) from None

    def failing(act, *given):
        """What a thread does: if it fails, it ends the tool, and the exception is raised below."""
        try:
            act(*given)
        except BaseException as e:
            failures.append(e)
            _end(child)

    def expire():
        if child.poll() is None:
            late.append('%s: stopped after timeout=%g s' % (command[0], timeout))
            child.terminate()

    threads = [threading.Thread(target=failing, args=(_listen, child.stderr, messages, shown), daemon=True)]
    if data is not None:
        threads.append(threading.Thread(target=failing, args=(_feed, child.stdin, data), daemon=True))
    if timeout is not None:
        threads.append(threading.Timer(timeout, expire))
    limit = None
    try:
        if started is not None:
            started(child)
        _widen(child.stdout)
        for thread in threads:
            thread.start()
        output = _taken(child.stdout)
        child.wait()
    except BaseException:  # Ctrl-C
        limit = PATIENCE  # processes that the tool started may hold its pipes
        child.stdout.close()  # nobody reads any more: the tool must not wait for a reader
        _end(child)
        raise
    finally:
        if timeout is not None:
            threads[-1].cancel()
        for thread in threads:
            if thread.ident is not None:  # it was started
                thread.join(limit)
        for pipe in (child.stdout, child.stderr) if not any(thread.is_alive() for thread in threads) else ():
            pipe.close()
        if hasattr(shown, 'end'):
            shown.end()
    if failures:
        raise failures[0]
    words = b''.join(messages).decode('utf-8', 'replace').strip()
    if late and child.returncode not in (0, 3):
        words = late[0]  # what the tool says of its signal tells less
    if child.returncode < 0 and not words:
        words = '%s: ended by signal %d' % (command[0], -child.returncode)
    return child.returncode, output, words


def _end(child):
    """Ends a tool. After the first signal it finishes an iteration and writes; a second one ends it at once."""
    try:
        for _ in range(2):
            child.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(PATIENCE)
    finally:
        child.kill()
        child.wait()


def _listen(pipe, messages, shown):
    """Lines of progress go to `shown`, all others are messages."""
    for line in pipe:
        if shown is not None and line.startswith(b'{"progress": '):
            shown(json.loads(line))
        else:
            messages.append(line)


class _Line:
    """Progress as one line of a terminal or notebook, which the next replaces and the end removes."""

    def __init__(self):
        self.began, self.width = time.monotonic(), 0

    def __call__(self, said):
        if time.monotonic() - self.began < PROGRESS_AFTER:
            return
        done = '' if said['progress'] is None else '%3.0f %%  ' % (100 * said['progress'])
        text = '%s: %s%s' % (said['tool'], done, said['text'])
        sys.stderr.write('\r' + text.ljust(self.width))
        sys.stderr.flush()
        self.width = len(text)

    def end(self):
        if self.width > 0:
            sys.stderr.write('\r' + ' ' * self.width + '\r')
            sys.stderr.flush()


def _progress_of(wanted):
    """The function that progress goes to, or None."""
    if callable(wanted):
        return wanted
    watched = sys.stderr is not None and (sys.stderr.isatty() or 'ipykernel' in sys.modules)
    return _Line() if wanted or (wanted is None and watched) else None


def _widen(pipe):
    """Fewer and larger transfers where the system allows it (Linux)."""
    try:
        import fcntl
        fcntl.fcntl(pipe.fileno(), getattr(fcntl, 'F_SETPIPE_SZ', 1031), PIPE_BYTES)
    except (ImportError, OSError):
        pass


class _Stream:
    """The grid stream that a tool wrote: its frames, or what is wrong with it, and its bytes."""

    def __init__(self, pipe):
        self.frames, self.bytes, self.error = [], [], None
        try:
            self.frames = stream.parse(pipe, self.bytes)
        except Error as e:
            self.error = e
            while pipe.read(PIPE_BYTES):  # to the end of the tool, whose own message says more
                pass


def _taken(pipe):
    """What a tool writes: a _Stream, or bytes if it is something else."""
    head = pipe.peek(3)[:3]
    return _Stream(pipe) if head and b'RCG'.startswith(head) else pipe.read()


def _feed(pipe, data):
    """Writes the input of a tool, and always ends it: a tool waits for the end."""
    try:
        _widen(pipe)
        for part in data:
            pipe.write(part)
    except BrokenPipeError:
        pass  # the tool ended before it had read everything, and its messages say why
    finally:
        with contextlib.suppress(BrokenPipeError):
            pipe.close()


def _reported(command, data, has_report, timeout=None, progress=False):
    """Works as execute(), with the lines of the tool's report: exit status, output, messages, list of dicts."""
    if not has_report:
        return execute(command, data, timeout, progress) + ([],)
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, 'report.json')
        at = command.index('--') if '--' in command else len(command)
        found = execute(command[:at] + ['--report', name] + command[at:], data, timeout, progress)
        if not os.path.exists(name):
            return found + ([],)
        with open(name, encoding='utf-8') as file:
            return found + ([json.loads(line) for line in file],)


def _frames_of(tool, output):
    if output and not isinstance(output, _Stream):
        raise Error('the output of %s is not a grid stream: run it in a shell' % tool)
    if output and output.error is not None:
        raise output.error
    return output.frames if output else []


# ---- arguments ----

PLAIN_UNITS = ('m', 'N', 'Pa', 's', 'm/s', 'Hz', 'K')  # spelled alike in the tables, pint and astropy


def _text(value, unit=''):
    """An argument as text: a number in SI, (60, 'N') and quantities of pint and astropy, which must fit the unit of the option."""
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str) and not isinstance(value[0], str):
        return stream._text(value[0]) + value[1]
    if hasattr(value, 'to_base_units') and hasattr(value, 'magnitude'):
        return stream._text(float((value.to(unit) if unit in PLAIN_UNITS else value.to_base_units()).magnitude))
    if hasattr(value, 'si') and hasattr(value.si, 'value'):
        return stream._text(float(value.to_value(unit) if unit in PLAIN_UNITS else value.si.value))
    if hasattr(value, '__fspath__'):
        return os.fspath(value)
    if isinstance(value, tuple):
        return ','.join(_text(one, unit) for one in value)
    if isinstance(value, numpy.ndarray) and value.ndim == 0:
        value = value[()]
    return stream._text(value)


def _is_list(value):
    return isinstance(value, (list, range)) or (isinstance(value, numpy.ndarray) and value.ndim > 0)


def _arguments(row, keyword_, value):
    """The words on the command line for one option of the table."""
    dashed = ('-' if len(row['name']) == 1 else '--') + row['name']
    if value is None or value is False:
        return []
    if value is True:
        if row['argument'] is None or row['optional'] or row['type'] == 'step':
            return [dashed]
        raise TypeError('%s=True: the option needs a value, %s: %s' % (keyword_, row['argument'], _help(row)))
    if row['type'] == 'flag':
        raise TypeError('%s=%r: the option is True or False' % (keyword_, value))
    if row['repeats']:
        return [word for one in (value if _is_list(value) else [value])
                for word in ([dashed] if one is True else [dashed, _text(one, row['unit'])])]
    text = ','.join(_text(one, row['unit']) for one in (value if _is_list(value) else [value]))
    for word in text.split(',') if row['type'] == 'words' else [text] if row['type'] == 'choice' else []:
        if row['only_words'] and row['words'] and word not in row['words']:
            raise ValueError('%s=%r: %s' % (keyword_, word, _one_of(word, row['words'])))
    return [dashed, text]


def _one_of(word, known):
    import difflib
    near = difflib.get_close_matches(word, known, 1)
    return 'did you mean %r?' % near[0] if near else 'it must be one of %s' % ', '.join(known)


def _help(row):
    return row['help'].replace('%s', ', '.join(row['words'])) + '; ' * bool(row['rules']) + row['rules']


def arguments(tool, given):
    """The command line of these keywords, in their order."""
    rows, words = options_of(tool), []
    for name, value in given.items():
        if name not in rows:
            raise TypeError('%s has no option %s: %s' % (tool, name, _one_of(name, sorted(rows))))
        words += _arguments(rows[name], name, value)
    return words


def frames_from(surface, dx=None):
    """The frames of a Result, a Frame or several, or a file; of an array or a nested list with dx=; of a DataArray of xarray."""
    frames = _ready(surface)
    if frames and dx is not None:
        raise TypeError('dx= is the spacing of an array: frames and files have their own')
    if frames is not None and dx is None:
        return frames
    if hasattr(surface, 'dims') and hasattr(surface, 'coords'):
        return [_from_xarray(surface, dx)]
    if dx is None:
        raise TypeError('%s has no spacing: give dx= in metres, or (dx, dy)'
                        % ('the array' if hasattr(surface, '__array__') else 'a ' + type(surface).__name__))
    return [stream.frame('height', surface, *stream.steps(dx))]


def _ready(surface):
    """The frames of what has some; None for anything else."""
    if isinstance(surface, Frame):
        return [surface]
    if isinstance(surface, Result):
        return surface.frames
    if isinstance(surface, str) or hasattr(surface, '__fspath__'):
        return open_file(surface).frames
    if isinstance(surface, (list, tuple)) or hasattr(surface, '__next__'):
        found = surface if isinstance(surface, (list, tuple)) else list(surface)
        if hasattr(surface, '__next__') or not found or any(isinstance(one, (Frame, Result)) for one in found):
            return stream._frames(found)
    return None


METRES = ('m', 'metre', 'metres', 'meter', 'meters')


def _from_xarray(surface, dx):
    """A Frame of a DataArray: its dimensions are rows and columns, its coordinates are even and in metres."""
    if hasattr(surface, 'data_vars'):
        raise TypeError('a Dataset has several maps: give one of them, as dataset[%r]' % next(iter(surface.data_vars), 'height'))
    if set(surface.dims) == {'x', 'y'}:
        surface = surface.transpose('y', 'x')
    channel, unit = surface.name or 'height', surface.attrs.get('units')
    known = stream.UNITS.get(channel, unit)
    if unit is not None and unit != known and not (known == 'm' and unit in METRES):
        raise ValueError('%s in %s: it must be in %s' % (channel, unit, known))
    steps = {d: _step(surface.coords[d]) for d in surface.dims if d in surface.coords and surface.coords[d].size > 1}
    if steps and dx is not None:
        raise TypeError('dx= is the spacing of an array without coordinates: this one has the coordinates %s' % ', '.join(map(str, steps)))
    if not steps and dx is None:
        raise TypeError('the array has no coordinates: give dx= in metres, or (dx, dy)')
    along = stream.steps(dx) if not steps else [steps.get(d, next(iter(steps.values()))) for d in reversed(surface.dims)]
    return stream.frame(channel, surface.values, along[0], along[-1], unit=known)


def _step(coordinate):
    """The even spacing of a coordinate, in metres."""
    unit, places = coordinate.attrs.get('units', 'm'), numpy.asarray(coordinate.values)
    if unit not in METRES:
        raise ValueError('coordinate %s in %s: it must be in metres' % (coordinate.name, unit))
    if places.dtype.kind not in 'iuf':
        raise TypeError('coordinate %s of type %s: it must be numbers' % (coordinate.name, places.dtype))
    steps = numpy.diff(places.astype(float))
    step = float(places[-1] - places[0]) / len(steps)
    if not (step > 0 and abs(steps - step).max() <= 1e-3 * step):
        raise ValueError('coordinate %s is not even and increasing: sort it, or interpolate it on even places' % coordinate.name)
    return step


def _data(surface, dx=None):
    return surface.stream() if isinstance(surface, Result) else stream.pieces(frames_from(surface, dx))


# ---- results ----

class Result:
    """The frames and the report of one call.

    Channels are attributes: result.pressure is a 2-D array in SI, or a 3-D one where there are several
    cases or depths. report is a dict in SI, with arrays where there are several cases; its figures are
    attributes too. cases is a list with a Result for each case. Iteration gives the frames, and len() their number.
    """

    def __init__(self, tool, command, output=b'', frames=None, lines=(), warnings_=()):
        self.tool, self.command = tool, command
        self.lines, self.warnings = list(lines), list(warnings_)
        self._output, self._frames = output, frames

    def __getstate__(self):
        return dict(self.__dict__, _frames=self.frames, _output=None)  # for pickle and copy: without views of bytes

    @property
    def frames(self):
        if self._frames is None:
            self._frames, self._output = _frames_of(self.tool, self._output), None
        return self._frames

    def __iter__(self):
        return iter(self.frames)

    def __len__(self):
        return len(self.frames)

    def __bool__(self):
        return True  # also without frames, as that of rc-info

    def stream(self):
        """The grid stream for the next tool: the bytes of the tool, until the frames are read and may change."""
        whole = self._frames is None and isinstance(self._output, _Stream) and self._output.error is None
        return self._output.bytes if whole else stream.pieces(self.frames)

    def save(self, file):
        """Writes the grid stream to a file; export() writes other formats."""
        stream.write(file, self.frames)

    def frame(self, channel, **keys):
        """The first frame of this channel whose header has these keys: frame('mises', case=2)."""
        for f in self.frames:
            if f.channel == channel and all(f.keys.get(k) == stream._text(v) for k, v in keys.items()):
                return f
        raise KeyError('%s gave no frame %s' % (self.tool, ', '.join([channel] + ['%s=%s' % k for k in keys.items()])))

    @property
    def channels(self):
        return list(dict.fromkeys(f.channel for f in self.frames))

    @property
    def dx(self):
        return self.frames[0].dx

    @property
    def dy(self):
        return self.frames[0].dy

    @property
    def report(self):
        if len(self.lines) == 1:
            return self.lines[0]
        names = dict.fromkeys(name for line in self.lines for name in line)
        return {name: _column([line.get(name) for line in self.lines]) for name in names}

    @property
    def converged(self):
        return all(line.get('converged', True) is not False for line in self.lines)

    @property
    def cases(self):
        numbers = dict.fromkeys([_case(f) for f in self.frames] + [line['case'] for line in self.lines if 'case' in line])
        return [Result(self.tool, self.command, frames=[f for f in self.frames if _case(f) == n],
                       lines=[line for line in self.lines if line.get('case') == n], warnings_=self.warnings)
                for n in sorted(numbers)]

    def __getattr__(self, name):
        if name.startswith('_'):
            raise AttributeError(name)
        maps = [f for f in self.frames if f.channel == name or python_name(f.channel) == name]
        if maps:
            _alike(maps)
            return maps[0].values if len(maps) == 1 else numpy.stack([f.values for f in maps])
        report = self.report
        if name in report:
            return report[name]
        raise AttributeError('%s gave no %s: %s' % (self.tool, name, _one_of(name, self.channels + list(report))))

    def __array__(self, dtype=None, copy=None):
        """numpy takes a result of one map as its values."""
        if len(self.frames) != 1:
            raise TypeError('%s gave %d maps: name one, as result.%s' % (
                self.tool, len(self.frames), python_name(self.channels[0]) if self.frames else 'report'))
        return self.frames[0].__array__(dtype, copy)

    def __dir__(self):
        return sorted(set(object.__dir__(self)) | set(map(python_name, self.channels)) | set(self.report))

    def _summary(self):
        cases = len(self.cases) if self.frames or self.lines else 0
        head = '%s: %d case%s%s' % (self.tool, cases, '' if cases == 1 else 's', '' if self.converged else ', not converged')
        rows = []
        for channel in self.channels:
            all_of = [f for f in self.frames if f.channel == channel]
            f, sizes = all_of[0], _sizes(all_of)
            rows.append((channel, '%s%s%s, %.4g to %.4g %s' % (
                '%d of ' % len(all_of) if len(all_of) > 1 else '', 'the sizes ' * (len(sizes) > 1), _some(sizes),
                min(numpy.nanmin(g.values) for g in all_of), max(numpy.nanmax(g.values) for g in all_of), f.unit)))
        if len(self.lines) == 1:
            rows += [(name, '%.4g' % self.lines[0][name]) for name in SHOWN_FIGURES
                     if isinstance(self.lines[0].get(name), (int, float))]
        return head, rows

    def __repr__(self):
        head, rows = self._summary()
        return '\n'.join(['<' + head] + ['  %-24s %s' % row for row in rows]) + '>'

    def _repr_html_(self):
        import base64
        import html
        head, rows = self._summary()
        cells = ''.join('<tr><td>%s</td><td>%s</td></tr>' % tuple(map(html.escape, row)) for row in rows)
        numbers = sorted(set(map(_case, self.frames)))
        first = [f for f in self.frames if _case(f) == numbers[0]]
        try:
            picture = '<img alt="map" src="data:image/png;base64,%s">' % base64.b64encode(
                draw(first, width=480, quiet=True)).decode() if first else ''
        except Error as e:  # a result without a map that can be drawn is still a table
            picture = html.escape(str(e))
        if len(numbers) > 1:
            picture += '<p>case %d of %s</p>' % (numbers[0], ', '.join(map(str, numbers)) if numbers[0] > 1 else len(numbers))
        return '<p><b>%s</b></p>%s<table>%s</table>' % (html.escape(head), picture, cells)

    def to_xarray(self):
        """A Dataset with a variable a channel; dimensions case and depth where there are several.

        x and y begin in the middle of the map, as on pictures. Several cases have their load, time or another figure
        that the command gave as a coordinate too; swap_dims makes it the index:
        result.to_xarray().swap_dims(case='load').sel(load=20).
        """
        import xarray
        parts = {}
        for f in self.frames:
            parts.setdefault(f.channel, {})[_case(f), float(f.keys.get('depth', 'nan'))] = f
        data = {}
        for channel, found in parts.items():
            cases = sorted({case for case, _ in found})
            depths = sorted({depth for _, depth in found if depth == depth})
            f = next(iter(found.values()))
            _alike(found.values(), spacings=True)
            ny, nx = f.values.shape
            cube = numpy.full((len(cases), max(1, len(depths)), ny, nx), numpy.nan, f.values.dtype)
            for (case, depth), one in found.items():
                cube[cases.index(case), depths.index(depth) if depth == depth else 0] = one.values
            coords = {'case': cases, 'depth': ('depth', depths, {'units': f.dunit}),
                      'y': ('y', (numpy.arange(ny) - (ny - 1) / 2) * f.dy, {'units': f.dunit}),
                      'x': ('x', (numpy.arange(nx) - (nx - 1) / 2) * f.dx, {'units': f.dunit})}
            dims = [d for d in coords if d in 'yx' or (d == 'depth' and depths) or (d == 'case' and len(cases) > 1)]
            shape = [len(coords[d] if d == 'case' else coords[d][1]) for d in dims]
            data[channel] = xarray.DataArray(cube.reshape(shape), {d: coords[d] for d in dims}, dims,
                                             attrs={'units': f.unit, 'long_name': channel.replace('-', ' ')})
        figures = self.lines[0] if len(self.lines) == 1 else {}
        attributes = {k: v for k, v in figures.items() if isinstance(v, (float, str)) or type(v) is int}
        return xarray.Dataset(data, self._along_cases(data), attrs=dict(attributes, command=' '.join(self.command)))

    def _along_cases(self, data):
        """The axes of a history that differ between the cases, as coordinates."""
        numbers = {line['case']: line for line in self.lines if 'case' in line}
        cases = next((list(array.coords['case'].values) for array in data.values() if 'case' in array.dims), [])
        units = self._units()
        found = {}
        for name in AXES:
            lines = [numbers.get(case, {}) for case in cases]
            asked = [line.get('asked_' + name) for line in lines]  # without rounding: sel() compares exactly
            values = [line.get(name) for line in lines] if None in asked else asked
            if None not in values and len(set(values)) > 1:
                found[name] = ('case', values, {'units': units[name]} if units.get(name) else {})
        return found

    @property
    def units(self):
        """{channel or figure of the report: its unit}: result.units['pressure'] is 'Pa'."""
        return dict({f.channel: f.unit for f in self.frames}, **self._units())

    def _units(self):
        """{figure: its unit in the report}."""
        return {row['name']: row['unit'] for row in table(self.tool).get('figures', []) if row['unit']}

    def to_pandas(self):
        """A DataFrame with a row a case (rc-info: a row a frame) and a column a figure that some case has.

        attrs['units'] has the units of the columns.
        """
        import pandas
        made = pandas.json_normalize(self.lines)
        made = made.drop(columns=[name for name in made if made[name].isna().all()])
        units = self._units()
        made.attrs['units'] = {name: units[name] for name in made if name in units}
        return made


# Figures that a list on the command line varies from case to case.
AXES = ('load', 'mean_pressure', 'approach', 'time', 'distance', 'cycles', 'position', 'creep_x', 'creep_y', 'spin',
        'tangential_x', 'tangential_y', 'speed')


def _case(f):
    return int(f.keys.get('case', '1'))


def _sizes(frames):
    return list(dict.fromkeys('%d x %d' % f.values.shape[::-1] for f in frames))


def _some(texts):
    return ', '.join(texts[:3]) + ', ...' * (len(texts) > 3)


def _alike(frames, spacings=False):
    """Refuses frames that make no common array, or with `spacings` have no common positions."""
    steps = dict.fromkeys('%.6g x %.6g %s' % (f.dx, f.dy, f.dunit) for f in frames) if spacings else ()
    for what, found in (('size', _sizes(frames)), ('spacing', list(steps))):
        if len(found) > 1:
            raise Error('cases differ in %s (%s): use result.cases' % (what, _some(found)))


def _column(values):
    """A column of a report as an array; null is NaN."""
    if all(v is None or (isinstance(v, (int, float)) and not isinstance(v, bool)) for v in values):
        return numpy.array([numpy.nan if v is None else v for v in values])
    return numpy.array(values, dtype=object if any(isinstance(v, (dict, list, type(None))) for v in values) else None)


class Picture(bytes):
    """The bytes of a PNG, SVG or PDF, which notebooks show."""

    def _repr_png_(self):
        return bytes(self) if self.startswith(b'\x89PNG') else None

    def _repr_svg_(self):
        return self.decode('utf-8') if self.lstrip().startswith(b'<') else None

    def save(self, file):
        with open(file, 'wb') as out:
            out.write(self)


class Page(str):
    """The HTML of a page, which notebooks show in a frame of its own."""

    def _repr_html_(self):
        import html
        return '<iframe srcdoc="%s" style="width: 100%%; height: 40em; border: 0"></iframe>' % html.escape(self)

    def save(self, file):
        with open(file, 'w', encoding='utf-8') as out:
            out.write(self)


class Verdicts(list):
    """What rcg.scene() returns: a dict for each load, which interpreters and notebooks show as a table of its effects."""

    def _rows(self):
        return [(line, [(e['title'], e['sentence'] or 'data missing: %s' % ', '.join(python_name(n) + '=' for n in (e['missing'] or '').split()))
                        for e in line['scene']]) for line in self]

    @staticmethod
    def _head(line):
        return '%s, case %d, load %.4g N' % (line.get('source', 'surface'), line.get('case', 1), line['load'])

    def __repr__(self):
        return '\n'.join('\n'.join([self._head(line)] + ['  %-30s %s' % row for row in rows]) for line, rows in self._rows())

    def _repr_html_(self):
        import html
        return ''.join('<p><b>%s</b></p><table>%s</table>' % (html.escape(self._head(line)), ''.join(
            '<tr><td>%s</td><td>%s</td></tr>' % tuple(map(html.escape, row)) for row in rows)) for line, rows in self._rows())

    def to_pandas(self):
        """A DataFrame with a row for each load and effect."""
        import pandas
        return pandas.DataFrame([{'case': line.get('case', 1), 'load': line['load'], 'effect': e['effect'], 'verdict': e['verdict'],
                                  'sentence': e['sentence'], 'missing': e['missing']} for line in self for e in line['scene']])


class Trials(list):
    """What rcg.cost() returns: a dict for each trial or figure, which interpreters and notebooks show as a table.

    proposal: the command that budget= or error= selects, as text for a shell, without the surface; None without these
    options.
    """
    SHOWN = {'figure': ('name', 'value', 'unit', 'bar_relative', 'dominant', 'why'), 'run': ('name', 'seconds', 'why')}

    def __init__(self, rows=(), proposal=None):
        super().__init__(rows)
        self.proposal = proposal

    def _table(self):
        """Lines of cells; the first of each kind of rows are their titles."""
        found, heads = [], None
        for row in self:
            names = list(row)
            lists = names[names.index('what') + 1:names.index('nx')] if 'nx' in names else []  # what rc-cost varied
            keys = self.SHOWN.get(row['what']) or ('what', *lists, 'seconds', 'memory', 'error', 'bound', 'why')
            if keys != heads:
                found.append(keys)
                heads = keys
            cells = [row.get(key) for key in keys]
            found.append(['' if cell is None else '%.4g' % cell if isinstance(cell, float) else str(cell) for cell in cells])
        return found

    def __repr__(self):
        table = self._table()
        widths = [max(len(line[k]) for line in table if k < len(line)) for k in range(max(map(len, table), default=0))]
        lines = ['  '.join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in table]
        return '\n'.join(lines + (['proposal: ' + self.proposal] if self.proposal else []))

    def _repr_html_(self):
        import html
        table = '<table>%s</table>' % ''.join(
            '<tr>%s</tr>' % ''.join('<td>%s</td>' % html.escape(cell) for cell in line) for line in self._table())
        return table + ('<p>Proposal: <code>%s</code></p>' % html.escape(self.proposal) if self.proposal else '')


# ---- calls ----

def _has_report(row, given):
    """True if the tool writes a report beside these options: rc-add does so only with align=True."""
    option = next((o for o in row['options'] if o['name'] == 'report'), None)
    return option is not None and all(any(given.get(python_name(o['name'])) for o in rule['options']) for rule in option['needs'])


def call(tool, surface=None, operands=(), spacing=None, timeout=None, progress=None, called=(), **given):
    """Runs a tool on a surface (see frames_from; spacing: of an array): a Result. See execute for timeout and progress.

    called: what messages call temporary files, {name: words}.

    Warnings of the tool become ToolWarning; a failure becomes Error with the message of the tool and its exit
    status; a tool that stops short of the requested accuracy becomes NotConverged.
    """
    command = [tool] + arguments(tool, given) + [os.fspath(o) for o in operands]
    row = table(tool)
    data = None if surface is None else _data(surface, spacing)
    status, output, words, lines = _reported(command, data, _has_report(row, given), timeout, progress)
    for name in called:
        words = words.replace(name, called[name])
    if row['writes'] != 'stream' or not isinstance(output, _Stream):
        result = Result(tool, command, frames=[], lines=lines)
    else:
        result = Result(tool, command, output, lines=lines)
    return _settled(status, words, result)


def _warn(text, tool):
    """A warning at the line of the user that called this package."""
    frame, level = sys._getframe(1), 2
    while frame is not None and frame.f_globals.get('__name__', '').startswith('rcg.'):
        frame, level = frame.f_back, level + 1
    warnings.warn(ToolWarning(text, tool), stacklevel=level)


OPTION = re.compile(r'rc-[a-z]+(?: --?[A-Za-z]\S*)+|--([A-Za-z][A-Za-z0-9-]*)(?:(?:=| )(\w(?:[^\s,;:()]|,(?=\S))*))?')


def _as_keywords(words, tool, command=()):
    """A message of a tool with its options as keywords: --dx is dx=, --tilt free is tilt='free'. A value of the command is quoted whole."""
    try:
        rows = {row['name']: (name, row) for name, row in options_of(tool).items()}
    except Error:
        return words
    for dashed, value in zip(command[1:], command[2:]):
        name = dashed[2:] if dashed.startswith('--') else ''
        if name in rows and not rows[name][1]['argument'] is None and not value.startswith('--'):
            words = words.replace('%s %s:' % (dashed, value), '%s=%r:' % (rows[name][0], value))

    def spoken(match):
        name, value = match.groups()
        if name not in rows:  # that of another tool, or of rc-cost's command
            return match.group()
        keyword_, row = rows[name]
        if value is None or value == row['argument']:
            return keyword_ + '=' + (value or '')
        if not (value[0].isdigit() or value in row['words']):
            return keyword_ + '=' + match.group()[len('--' + name):]
        return '%s=%r' % (keyword_, value)

    return OPTION.sub(spoken, words)


def _settled(status, words, result):
    """The result, unless the tool failed; its warnings become warnings of Python."""
    words = _as_keywords(words, result.tool, result.command)
    said = [w[len(result.tool) + 2:] if w.startswith(result.tool + ': ') else w for w in words.splitlines()]
    if status not in (0, 3):
        raise Error(words or '%s ended with status %d' % (result.tool, status), status)
    result.warnings = said
    if status == 3:
        raise NotConverged(words or '%s stopped short of the requested accuracy' % result.tool, result)
    for line in said:
        _warn(line, result.tool)
    return result


def open_file(paths, **given):
    """A measured surface from an instrument or exchange file (rc-import), or the frames of a grid stream.

    A list of files gives a case for each: rcg.open(sorted(glob.glob('scans/*.x3p'))).
    """
    if isinstance(paths, (list, tuple)):
        return _open_all([os.fspath(one) for one in paths], given)
    if _is_stream(paths) and not given:
        return Result('rc-import', ['rc-import', os.fspath(paths)], frames=stream.read(paths))
    return call('rc-import', None, (paths,), **given)


def _is_stream(path):
    with open(path, 'rb') as file:
        return file.read(4) == b'RCG1'


def _open_all(paths, given):
    """The files as cases, in their order: rc-import reads them at once, unless some are streams."""
    if not paths:
        raise ValueError('the list of files is empty')
    if given or not any(map(_is_stream, paths)):
        return call('rc-import', None, paths, **given)
    frames, last = [], 0
    for opened in map(open_file, paths):
        numbers = sorted(set(map(_case, opened.frames)))
        for f in opened.frames:
            f.keys['case'] = str(last + 1 + numbers.index(_case(f)))
        last += len(numbers)
        frames += opened.frames
    return Result('rc-import', ['rc-import'] + paths, frames=frames)


def materials():
    """The named materials of body1= and body2=, as rc-solve --materials prints them: {'steel': {'E': '211.9GPa', 'nu': 0.291, ...}, ...}.

    Values with units are texts that options take: rcg.solve(surface, load='5N', E1=rcg.materials()['copper']['E'], ...). Values
    without a source are left out. pandas.DataFrame(rcg.materials()).T is a table.
    """
    status, output, words = execute(['rc-solve', '--materials'])
    if status != 0:
        raise Error(words, status)
    heads, *rows = [[cell.strip() for cell in line.split('\t')] for line in bytes(output).decode('utf-8').splitlines()]
    found = {}
    for names, *cells in rows:
        row = {head: float(cell) if head == 'nu' else cell for head, cell in zip(heads[1:], cells) if cell not in ('-', '')}
        found.update((name, dict(row)) for name in names.split('|'))
    return found


def sample(name='rough-steel.x3p'):
    """The path of a sample surface: rough-steel.x3p, rough-sphere.x3p or turned-brass.txt."""
    here = os.path.dirname(os.path.abspath(__file__))
    folders = [os.path.join(here, 'samples'), os.path.join(here, '..', '..', 'sample_surfaces')]
    for folder in folders:
        if os.path.exists(os.path.join(folder, name)):
            return os.path.join(folder, name)
    raise FileNotFoundError('no sample %s in %s' % (name, folders[0]))


def draw(surface, path=None, dx=None, **given):
    """A picture of a map, or with curve= of the report: the bytes of a PNG, or a file (.png, .svg, .pdf)."""
    curve = given.get('curve') is not None
    with tempfile.TemporaryDirectory() as folder:
        name = os.fspath(path) if path is not None else os.path.join(folder, 'picture.png')
        report = None
        if curve and isinstance(surface, Result):
            given.setdefault('subtitle', _some(list(dict.fromkeys(str(line.get('source', surface.tool)) for line in surface.lines))))
            report = os.path.join(folder, 'report.json')
            with open(report, 'w', encoding='utf-8') as file:
                file.writelines(json.dumps(line) + '\n' for line in surface.lines)
        command = ['rc-render'] + arguments('rc-render', given) + ['-o', name] + ([report] if report else [])
        status, _, words = execute(command, None if curve else _data(surface, dx))
        words = words.replace(os.path.join(folder, 'report.json'), 'the report')
        _settled(status, words, Result('rc-render', command, frames=[]))
        with open(name, 'rb') as file:
            return Picture(file.read())


def save_as(surface, path, dx=None, **given):
    """Writes the frames as a file of another program; the suffix of the path says which format."""
    command = ['rc-export'] + arguments('rc-export', given) + ['-o', os.fspath(path)]
    status, _, words = execute(command, _data(surface, dx))
    _settled(status, words, Result('rc-export', command, frames=[]))


def page(surface, path=None, dx=None, timeout=None, progress=None, **given):
    """The page as HTML text, which notebooks show. path: also write it to this file.

    With the name of a tool first, report('rc-solve', frames, **options) gives the frames and the report lines of this tool.
    """
    with tempfile.TemporaryDirectory() as folder:
        name = surface
        if not isinstance(surface, str) and not hasattr(surface, '__fspath__'):
            name, frames = os.path.join(folder, 'surface.rcg'), frames_from(surface, dx)
            stream.write(name, frames)
            given.setdefault('title', frames[0].keys.get('source', 'surface'))
        command = ['rc-report'] + arguments('rc-report', given) + ['--', os.fspath(name)]
        status, output, words = execute(command, None, timeout, progress)
    result = Result('rc-report', command, frames=[])
    result.page = Page(bytes(output).decode('utf-8'))
    if path is not None and result.page:
        result.page.save(path)
    return _settled(status, words, result).page


def add_two(a, b, dx=None, **given):
    """The sum of two surfaces that face each other, or with subtract=True their difference."""
    with tempfile.TemporaryDirectory() as folder:
        names = [os.path.join(folder, 'a.rcg'), os.path.join(folder, 'b.rcg')]
        ready = [_ready(surface) for surface in (a, b)]
        for name, surface, frames in zip(names, (a, b), ready):
            own = frames is not None and None in ready  # dx= is for the other
            stream.write(name, frames_from(surface if frames is None else frames, None if own else dx))
        return call('rc-add', None, names, called=dict(zip(names, ('the first surface', 'the second surface'))), **given)


def make(shape, **given):
    """A synthetic surface; like= takes a surface or a file with the nodes to use."""
    like = given.get('like')
    if like is None or isinstance(like, str) or hasattr(like, '__fspath__'):
        return call('rc-synth', None, (shape,), **given)
    with tempfile.TemporaryDirectory() as folder:
        given['like'] = os.path.join(folder, 'like.rcg')
        stream.write(given['like'], frames_from(like))
        return call('rc-synth', None, (shape,), **given)


def costs(surface, command, dx=None, timeout=None, progress=None, **given):
    """The trials of a command as a table, a list of dicts: time, memory and error of each. The first one is the reference.

    With noise='5nm', repeat=, resolution=True, patch=True, holes=True or filter= the table has the figures of the measured map with
    their bars (what == 'figure') and then the maps that were run (what == 'run').

    command: 'rc-solve --load 60N --estar 114GPa | rc-leak', or a list of its words. vary: 'increments=8,16', or a list of such texts.

    With error='1%' the attribute proposal is the fastest command whose error is at most this; with budget='5s' it is the
    most accurate one that takes at most this time. The proposal is shown below the table.
    """
    words = ['rc-cost'] + arguments('rc-cost', given) + ['--'] + ([command] if isinstance(command, str) else [os.fspath(w) for w in command])
    status, output, said, lines = _reported(words, _data(surface, dx), True, timeout, progress)
    selects = given.get('error') is not None or given.get('budget') is not None
    proposal = bytes(output).decode().strip() if selects and output else None
    return Trials(_settled(status, said, Result('rc-cost', words, frames=[], lines=lines)).lines, proposal)


def verdicts(surface, dx=None, timeout=None, progress=None, **given):
    """The effects that a contact calls for: a list of dicts, one for each load, whose item 'scene' lists the effects with their verdicts.

    rcg.scene(surface, load='5N', E1='210GPa', nu1=0.3, E2='rigid', hardness='3GPa')[0]['scene'][0]['verdict']
    """
    words = ['rc-scene'] + arguments('rc-scene', given)
    status, _, said, lines = _reported(words, _data(surface, dx), True, timeout, progress)
    return Verdicts(_settled(status, said, Result('rc-scene', words, frames=[], lines=lines)).lines)


SPECIAL = {'cost': costs, 'scene': verdicts, 'open': open_file, 'render': draw, 'report': page, 'export': save_as, 'add': add_two, 'synth': make}


def function(name):
    """The function of a tool, with signature and documentation from its option table."""
    import inspect
    tool = FUNCTIONS[name]
    rows = options_of(tool)

    def solver(surface, *, dx=None, timeout=None, progress=None, **given):
        if surface is None:
            raise TypeError('the surface is None, not a map: give a result, frames, an array with dx=, or the name of a file')
        return call(tool, surface, spacing=dx, timeout=timeout, progress=progress, **given)

    inner = SPECIAL.get(name, solver)

    def made(*operands, **given):
        if name == 'report' and operands and isinstance(operands[0], str) and os.path.basename(operands[0]) in FUNCTIONS.values():
            return lines_of(*operands, **given)
        return inner(*operands, **given)

    own = [p.replace(annotation=_Hint(OWN_HINTS[p.name] + (' | None' if p.default is None else '')))
           for p in inspect.signature(inner).parameters.values() if p.name not in rows and p.name != 'given']
    positional = [p for p in own if p.name not in ('dx', 'timeout', 'progress')]
    named = [inspect.Parameter(python, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=_Hint(annotation(row) + ' | None'))
             for python, row in rows.items()]
    named += [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in own if p not in positional]
    result = {'render': 'Picture', 'report': 'Page', 'export': 'None', 'cost': 'Trials', 'scene': 'Verdicts'}.get(name, 'Result')
    made.__signature__ = _signature()(positional + named, return_annotation=_Hint(result))
    made.__name__ = made.__qualname__ = name
    made.__module__ = 'rcg'
    made.__doc__ = documentation(name, rows)
    return made


def _signature():
    """A signature with all options for editors, which help() prints in short: the text below has the options."""
    import inspect

    class Short(inspect.Signature):
        def __str__(self):
            first = [name for name, p in self.parameters.items() if p.kind not in (p.KEYWORD_ONLY, p.VAR_KEYWORD)]
            return '(%s, **options)' % ', '.join(first)

        def format(self, **_):
            return str(self)

        def whole(self):
            return inspect.Signature.__str__(self)

    return Short


class _Hint(str):
    """A type hint that help() and the stub show without quotation marks."""
    __repr__ = str.__str__


# The first line of the documentation of each function.
EXAMPLES = {
    'add': "both = rcg.add(surface, roughness)",
    'cost': "rows = rcg.cost(surface, 'rc-solve --load 60N --estar 114GPa', tol=[1e-2, 1e-4])",
    'deflect': "bent = rcg.deflect(result, estar='114GPa')",
    'detrend': "flat = rcg.detrend(surface, poly=2, spikes=5, fill=True)",
    'export': "rcg.export(surface, 'surface.sdf')",
    'fatigue': "index = rcg.fatigue(result, nu=0.3, depths='auto', bending_limit='600MPa', torsion_limit='400MPa', pass_='x')",
    'heat': "hot = rcg.heat(result, mu=0.1, speed='1m/s', body1='steel', body2='copper')",
    'info': "figures = rcg.info(surface, areal=True).report",
    'leak': "flow = rcg.leak(result, viscosity='1mPas', pressure_drop='100kPa')",
    'open': "surface = rcg.open('rough-steel.x3p')",
    'pick': "part = rcg.pick(surface, crop='0,0,128,128')",
    'render': "rcg.render(result, 'pressure.png', channel='pressure')",
    'report': "rcg.report('rough-steel.x3p', 'page.html', load='10N', estar='114GPa')",
    'scene': "rows = rcg.scene(surface, load='10N', body1='steel', body2='steel', hardness='6GPa')",
    'slip': "stuck = rcg.slip(result, mu=0.3, nu=0.3, tangential='0.1N')",
    'solve': "result = rcg.solve(surface, load='60N', estar='114GPa')",
    'stress': "below = rcg.stress(result, nu=0.3, depths='auto', components='mises')",
    'synth': "ball = rcg.synth('sphere', nx=128, dx='5um', radius='7.5mm')",
    'wear': "worn = rcg.wear(result, coefficient='1e-6mm3/Nm', distance='0,1m,10m')",
}

# Type hints by the type of an option; those of other parameters. stubs.py explains the names.
HINTS = {'flag': 'bool', 'number': 'Quantity', 'count': 'int', 'numbers': 'Quantity | list[Quantity]', 'words': 'str | list[str]',
         'step': 'bool | Quantity | list[Quantity | bool]'}
OWN_HINTS = {'surface': 'Surface', 'command': 'str | list[str]', 'a': 'Surface', 'b': 'Surface', 'path': 'Path', 'paths': 'Path | list[Path]', 'shape': 'str',
             'dx': 'float | tuple[float, float]', 'timeout': 'float', 'progress': 'bool | Callable[[dict[str, Any]], object]'}


def annotation(row):
    if row['type'] == 'choice' and row['words']:
        return 'Literal[%s]' % ', '.join(map(repr, row['words'])) + ' | bool' * row['optional']
    return HINTS.get(row['type'], 'Any') + ' | bool' * row['optional']


def documentation(name, rows):
    import inspect
    tool = FUNCTIONS[name]
    row = table(tool)
    text = ['Example: ' + EXAMPLES[name], '', row['summary'] + '.', '']
    if name in SPECIAL:
        text += [inspect.cleandoc(SPECIAL[name].__doc__), '']
    else:
        text += ['timeout: seconds, after which the tool stops. progress: True, False, or a function of a dict (default: progress',
                 'appears where a person watches).', '']
    text += ['Numbers are SI; texts may carry a unit (%s). The manual is %s(1).' % ("'60N', '114GPa'", tool), '']
    if row['operand_words']:
        text += ['shape: ' + ', '.join(row['operand_words']), '']
    for python, o in rows.items():
        unit = ' [%s]' % o['unit'] if o['unit'] else ''
        words = ' {%s}' % ', '.join(o['words']) if o['words'] else ''
        text.append('%s%s%s\n    %s' % (python, unit, words, _help(o)))
    return '\n'.join(text) + '\n'


# ---- calls by the names of the tools ----

def _words_of(args, options):
    words = [a if isinstance(a, str) else _text(a) for a in args]
    for name, value in options.items():
        dashed = ('-' if len(name) == 1 else '--') + name.replace('_', '-')
        if value is True:
            words.append(dashed)
        elif value is not None and value is not False:
            listed = isinstance(value, (list, tuple, numpy.ndarray))
            words += [dashed, ','.join(map(stream._text, value)) if listed else _text(value)]
    return words


def _named(tool, frames, args, options, with_report):
    command = [tool] + _words_of(args, options)
    data = None if frames is None else _data(frames)
    if with_report and os.path.basename(tool) == 'rc-info':
        status, output, words = execute(command + ['--json'], data)
        lines, output = [json.loads(line) for line in output.decode('utf-8').splitlines()], b''
    else:
        status, output, words, lines = _reported(command, data, with_report)
    if status not in (0, 3):
        raise Error(words, status)
    found = _frames_of(tool, output)
    if status != 0:
        raise Error(words, status, found, lines)
    if words:
        _warn(words, tool)
    return found, lines


def run(tool, frames=None, *args, **options):
    """Runs a tool on the frames (None: no input) and returns the frames that it writes.

    run('rc-solve', surface, load='60N', estar='114GPa', periodic=True) is
    rc-solve --load 60N --estar 114GPa --periodic. Numbers are SI, a list is joined by commas, _ in a name is -,
    one letter is a short option. args stand before the options, unchanged; a tool without input may have them
    at once: run('rc-synth', 'sphere', nx=64). A warning of the tool becomes a warning of Python.
    """
    if isinstance(frames, str):
        frames, args = None, (frames,) + args
    return _named(tool, frames, args, options, False)[0]


def lines_of(tool, frames, *args, **options):
    """Works as run(), with the lines of the tool's report: the frames and a list of dicts. rcg.report() calls it."""
    return _named(tool, frames, args, options, True)
