# SPDX-License-Identifier: GPL-3.0-or-later
"""The checks of pipe_python.sh for the package rcg, one function each: python_rcg.py. For each line of its input it runs
the check whose name and arguments are in the file asked, each with a zero byte behind it, in a process of its own. The
outputs of the check go to said.out and said.err, and its exit status is printed. So numpy is loaded once."""
import base64
import concurrent.futures
import copy
import functools
import io
import json
import math
import multiprocessing
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
import zlib

import numpy

import rcg


def tool(*command, **more):
    """Exit status and standard output of a command."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)
    return done.returncode, done.stdout


def content(name):
    with open(name, 'rb') as file:
        return file.read()


def refused(data):
    try:
        rcg.loads(data)
    except rcg.Error as error:
        assert str(error) and error.status in (1, 2)
        return True
    return False


# ---- streams ----

def round_trip(*names):
    for name in names:
        data = content(name)
        assert rcg.dumps(rcg.loads(data)) == data, name
        rcg.write('copy.rcg', rcg.read(name))
        assert content('copy.rcg') == data, name
        with open(name, 'rb') as file:
            out = io.BytesIO()
            rcg.write(out, rcg.read(file))
        assert out.getvalue() == data, name


def text_is(name, key, text):
    # older Pythons read arguments as ASCII in an ASCII locale
    assert rcg.read(name)[0].keys[key] == os.fsencode(text).decode('utf-8')


def waves(name):
    """The spacings of a spectrum are in rad/m, those of other maps in m."""
    spectrum, = rcg.read(name)
    assert spectrum.dunit == 'rad/m' and 'x 98174.77042468105 rad/m, m4>' in repr(spectrum)
    made = rcg.frame('psd', spectrum.values, spectrum.dx, unit='m4', dunit='rad/m')
    assert made.dunit == 'rad/m' and rcg.loads(rcg.dumps([made]))[0].dunit == 'rad/m'
    assert rcg.frame('height', [[1.0, 2.0]], 1e-6).dunit == 'm'


def missing(name, row, column):
    values = rcg.read(name)[0].values
    places = [list(place) for place in numpy.argwhere(numpy.isnan(values))]
    assert places == [[int(row), int(column)]]


def same_values(name, npy):
    values, expected = rcg.read(name)[0].values, numpy.load(npy)
    assert values.dtype == expected.dtype and values.shape == expected.shape
    assert values.tobytes() == expected.tobytes()
    values[0, 0] = 1  # a user's array


def joined(name, numbered):
    ours = [(f.keys.get('case', '1'), f.channel) for f in rcg.read(name)]
    assert ours == [(f.keys.get('case', '1'), f.channel) for f in rcg.read(numbered)]
    assert {case for case, channel in ours} == set('12345')


def cut(name):
    data = content(name)
    for n in range(len(data)):
        assert refused(data[:n]), n


def changed(name):
    data = content(name)
    for n in range(len(data)):
        bad = data[:n] + bytes([data[n] ^ 0x10]) + data[n + 1:]
        assert refused(bad), n


def headers():
    """Streams that are valid except for their headers."""
    good = [b'channel=height', b'nx=2', b'ny=1', b'dx=1e-06', b'dy=1e-06', b'unit=m', b'type=f64']

    def stream(lines, values=bytes(16)):
        body = b'RCG1\n' + b''.join(line + b'\n' for line in lines) + b'\n' + values
        return body + b'crc32 %08x\nRCGEND 1\n' % zlib.crc32(body)

    def with_line(old, new):
        return stream([new if line.startswith(old) else line for line in good])

    cases = [stream(good[:k] + good[k + 1:]) for k in range(len(good))]
    cases += [stream(good + [line]) for line in good]
    cases += [stream(good + [line]) for line in (
        b'note', b'=1', b'Note=1', b'1note=1', b'no te=1', b'note=\\t', b'note=\\', b'note=\\\\\\',
        b'note=\xff', b'note=\xed\xa0\x80', b'note=a\0b', b'case=0', b'case=', b'case=1.0',
        b'case=-1', b'case=1234567890123456', b'note=' + b'x' * 65536, b'n\xc3\xb6te=1')]
    cases += [with_line(b'nx', b'nx=' + text) for text in (
        b'0', b'-2', b'+2', b'2.0', b' 2', b'2 ', b'', b'1e0', b'99999999999999999999', b'3')]
    cases += [with_line(b'dx', b'dx=' + text) for text in (
        b'0', b'-1', b'nan', b'inf', b'1e999', b'1,5', b' 1', b'', b'0x1', b'1_0')]
    cases += [with_line(b'type', b'type=' + text) for text in (b'f16', b'F64', b'', b'f32')]
    cases += [stream([b'\r' if not line else line + b'\r' for line in good])]
    whole = stream(good)
    cases += [whole.replace(b'RCGEND 1', b'RCGEND ' + text) for text in (b'2', b'01', b'', b'1 ')]
    cases += [b'', b'RCG2\n', b'PK\3\4', b'nonsense', whole + b'RCG', whole + b'\n', whole[:-9]]
    for data in cases:
        assert refused(data), data[:200]
        assert tool('rc-info', input=data)[0] == 1, data[:200]
    for data in (stream(good), stream(good[::-1]), stream(good + [b'note=']), whole + whole,
                 stream(good + [b'note=\\\\n\\n=\xc2\xb5']),
                 stream(good + [b'case=123456789012345']), with_line(b'dx', b'dx=1'),
                 with_line(b'dx', b'dx=1.e-6'), with_line(b'dx', b'dx=+1E-6'),
                 with_line(b'dx', b'dx=5.'), with_line(b'dx', b'dx=.5')):
        assert refused(data) == (tool('rc-info', input=data)[0] == 1), data[:200]
    assert not refused(whole)


def failed(name):
    try:
        rcg.read(name)
    except rcg.Error as error:
        assert str(error).endswith('failed: rc-solve: disk on fire'), error
        assert error.status == 2
        return
    raise AssertionError('read')


# ---- frames ----

def arrays():
    def back(values, **more):
        return rcg.loads(rcg.dumps(rcg.frame('height', values, 1e-6, **more)))[0]

    a = numpy.arange(12.0).reshape(3, 4)
    for values in (a, a.astype(int), a.astype('>f8'), a.astype('f2'), a.astype(numpy.longdouble),
                   numpy.asfortranarray(a), a.T[::-1].T[::-1].T[::-1].T[::-1], a.tolist(), a > -1):
        f = back(values)
        assert f.values.dtype == numpy.float64 and f.keys['type'] == 'f64'
        assert numpy.array_equal(f.values, numpy.asarray(values, float))
    for values in (a.astype('f4'), a.astype('>f4')):
        f = back(values)
        assert f.values.dtype == numpy.float32 and f.keys['type'] == 'f32'
        assert numpy.array_equal(f.values, a)
    for kind in (float, 'f4', int):
        f = back(numpy.ma.masked_equal(a.astype(kind), 5))
        assert numpy.isnan(f.values[1, 1]) and numpy.isnan(f.values).sum() == 1
    f = back(a[0])
    assert f.values.shape == (1, 4) and f.keys['ny'] == '1'
    f = back(a, dy=0.1 + 0.2, case=2, load=60.0, area=1e-12, periodic=True, nodes=numpy.int64(7))
    assert (f.dx, f.dy, f.unit, f.channel) == (1e-6, 0.1 + 0.2, 'm', 'height')
    keys = [f.keys[name] for name in ('dx', 'dy', 'case', 'load', 'area', 'periodic', 'nodes')]
    assert keys == ['1e-06', '0.30000000000000004', '2', '60', '1e-12', 'yes', '7'], keys
    assert rcg.frame('mises', a, 1e-6).unit == 'Pa'
    assert rcg.frame('hardness', a, 1e-6).unit == 'Pa'
    assert rcg.frame('dirt', a, 1, unit='kg').unit == 'kg'
    for arguments in (('1.1um', '1.29um'), (1.1e-6, '1.29um'), ('1100nm', 1.29e-6), (('1.1um', '1.29um'),), ((1.1, 'um'), (1.29, 'um'))):
        one = rcg.frame('height', a, *arguments)
        assert (one.dx, one.dy) == (1.1e-6, 1.29e-6) and one.keys['dx'] == '1.1e-06', arguments
    assert rcg.frame('height', a, '5 \u00b5m').dy == 5e-6
    f.values, f.channel = f.values[:, :2].astype('f4'), 'gap'  # the header follows
    f = rcg.loads(rcg.dumps(f))[0]
    assert [f.keys[k] for k in ('channel', 'nx', 'ny', 'type')] == ['gap', '2', '3', 'f32']
    two = [f, rcg.frame('height', a, 1e-6, case=3)]
    status, text = tool('rc-info', '--json', input=rcg.dumps(two))
    assert status == 0 and json.loads(text.decode().splitlines()[1])['maximum'] == 11


def no_frames():
    a = numpy.ones((2, 2))
    for wrong, arguments, keys in (
            (ValueError, ('dirt', a, 1), {}), (ValueError, ('height', a, 0), {}),
            (ValueError, ('height', a, -1e-6), {}), (ValueError, ('height', a, math.nan), {}),
            (ValueError, ('height', a, math.inf), {}), (TypeError, ('height', a, '1.1furlong'), {}),
            (TypeError, ('height', a, ('1um', '2um', '3um')), {}), (TypeError, ('height', a, ('1um', '2um'), '3um'), {}),
            (ValueError, ('height', a, '1um'), {'dunit': 'rad/m'}), (ValueError, ('height', a, '-1um'), {}),
            (ValueError, ('height', a[None], 1), {}), (ValueError, ('height', a[:0], 1), {}),
            (TypeError, ('height', a * 1j, 1), {}), (TypeError, ('height', [['a']], 1), {}),
            (TypeError, ('height', a, None), {}), (ValueError, ('height', a, 1), {'nx': 2}),
            (ValueError, ('height', a, 1), {'Note': 'x'}),
            (ValueError, ('height', a, 1), {'case': 0}),
            (ValueError, ('height', a, 1), {'note': 'a\0b'}),
            (TypeError, ('height', a, 1), {'note': [1]}),
            (ValueError, ('height', a, 1), {'note': 'x' * 65536})):
        try:
            rcg.frame(*arguments, **keys)
        except wrong as error:
            assert str(error)
        else:
            raise AssertionError((arguments, keys))


def hertz(order):
    """R = 2.385 mm, E* = 114 GPa, 2 N on 129 x 121 nodes: to the accuracy for this number of cells in the radius."""
    radius, estar, load, dx, dy = 2.385e-3, 114e9, 2.0, 1.1e-6, 1.2e-6
    nx, ny = 129, 121
    x, y = (numpy.arange(nx) - (nx - 1) / 2) * dx, (numpy.arange(ny) - (ny - 1) / 2) * dy
    ball = rcg.frame('height', -(x ** 2 + y[:, None] ** 2) / (2 * radius), dx, dy)
    frames, lines = rcg.report('rc-solve', ball, load=load, estar=estar, output='pressure')
    a = (3 * load * radius / (4 * estar)) ** (1 / 3)
    p = frames[0].values
    assert abs(p.max() * 2 * math.pi * a ** 2 / (3 * load) - 1) <= float(order) * (dy / a) ** 2
    assert abs(p.sum() * dx * dy / load - 1) < 1e-9
    # the error of the area is less than the area of the cells that the edge crosses
    crossed = 2 * math.pi * a * math.hypot(dx, dy)
    assert abs((p > 0).sum() * dx * dy - math.pi * a ** 2) < crossed
    assert abs(lines[0]['contact_area'] - (p > 0).sum() * dx * dy) < 1e-6 * dx * dy


# ---- tools ----

def run(name):
    ball = rcg.read(name)
    first = ['rc-solve', '--load', '0.5,1.25', '--estar', '114e9', '--output', 'pressure,gap',
             '--quiet']
    second = ['rc-stress', '--nu', '0.3', '--depths', '0:3um:3', '--components', 'mises,szz']
    solved = tool(*first, input=content(name))[1]
    stressed = tool(*second, input=solved)[1]
    frames = rcg.run('rc-solve', ball, load=[0.5, 1.25], estar=114e9, output='pressure,gap',
                     quiet=True)
    assert rcg.dumps(frames) == solved and len(frames) == 4
    frames = rcg.run('rc-stress', frames, nu=0.3, depths='0:3um:3', components=['mises', 'szz'])
    assert rcg.dumps(frames) == stressed and len(frames) == 12
    made = rcg.run('rc-synth', None, 'sphere', nx=33, ny=47, dx='1.1um', dy='1.29um',
                   radius='2.385mm')
    assert rcg.dumps(made) == content(name)


def report(name):
    ball, wanted = rcg.read(name)[0], dict(load='1,2', estar='114GPa', quiet=True)
    frames, lines = rcg.report('rc-solve', ball, **wanted)
    assert rcg.dumps(frames) == rcg.dumps(rcg.run('rc-solve', ball, **wanted))
    text = tool('rc-solve', '--load', '1,2', '--estar', '114GPa', '--quiet', '--report', '-',
                name)[1]
    there = [json.loads(line) for line in text.decode().splitlines()]
    assert len(lines) == 2 and list(lines[0]) == list(there[0])
    for ours, theirs in zip(lines, there):
        for key in ours:
            # keys that differ from run to run, or that follow from the file name
            if key not in ('seconds', 'peak_memory', 'memory_estimate', 'source', 'file'):
                assert ours[key] == theirs[key], key
    frames, lines = rcg.report('rc-info', ball)
    assert frames == [] and len(lines) == 1 and lines[0]['channel'] == 'height'
    assert lines[0]['maximum'] == ball.values.max() and lines[0]['nx'] == 33


def options(name):
    ball = rcg.read(name)
    pressed = rcg.run('rc-solve', ball, load=1, estar=114e9, periodic=True, resume=False, tol=None,
                      stiffness=True, type='f32', output='pressure', quiet=True)[0]
    history = pressed.keys['history']
    assert '--periodic' in history and '--load 1' in history and pressed.keys['type'] == 'f32'
    pressed = rcg.run('rc-solve', ball, mean_pressure='10MPa', estar='114GPa', quiet=True)[0]
    assert '--mean-pressure 10000000' in pressed.keys['history'], pressed.keys['history']
    for load, text in ((0.1 + 0.2, '0.30000000000000004'), (numpy.float64(0.25), '0.25'),
                       (numpy.float32(0.5), '0.5'), (numpy.int16(2), '2'), (1e-7, '1e-07')):
        pressed = rcg.run('rc-solve', ball, load=load, estar=114e9, output='pressure',
                          quiet=True)[0]
        assert pressed.keys['load'] == text, pressed.keys['load']
    assert rcg.run('rc-render', ball, '--raw', o='ball.png') == []
    assert content('ball.png')[1:4] == b'PNG'
    picked = rcg.run('rc-pick', ball, '--set', 'a=1', '--set', 'b=2')[0]
    assert picked.keys['a'] + picked.keys['b'] == '12'


def error_of(*arguments, **more):
    try:
        rcg.run(*arguments, **more)
    except rcg.Error as error:
        return error
    raise AssertionError('it ran')


def fails(name):
    hole = rcg.read(name)
    error = error_of('rc-solve', hole, load=1, estar=114e9)
    assert error.status == 1 and str(error).startswith('rc-solve: ') and 'NaN' in str(error), error
    error = error_of('rc-solve', hole, lod=1)
    assert error.status == 2
    assert str(error) == 'rc-solve: unknown option --lod: did you mean --load?', error
    error = error_of('rc-nothing', hole)
    assert error.status == 127 and 'rc-nothing: not found' in str(error)
    error = error_of('rc-info', hole)
    assert error.status == 1 and 'rc-info' in str(error)
    error = error_of('sh', None, '-c', 'kill -9 $$')
    assert error.status == -9 and str(error) == 'sh: ended by signal 9'
    error = error_of('sh', hole, '-c', 'echo RCGFAIL sh: halfway')
    assert 'sh: halfway' in str(error)
    big = rcg.frame('height', numpy.zeros((1500, 1500)), 1)  # more bytes than a pipe can hold
    error = error_of('rc-solve', big, '--nonsense')
    assert error.status == 2


def short():
    rough = rcg.run('rc-synth', 'selfaffine', nx=64, dx='1um', hurst=0.8,
                    rms_height='100nm', seed=5)
    wanted = dict(periodic=True, load='0.1N', estar='100GPa', tol=1e-17, output='pressure')
    error = error_of('rc-solve', rough, **wanted)
    assert error.status == 3 and 'not converged' in str(error)
    assert [f.keys['converged'] for f in error.frames] == ['no'] and error.lines == []
    try:
        rcg.report('rc-solve', rough, **wanted)
    except rcg.Error as error:
        assert error.status == 3 and len(error.frames) == 1
        assert [line['converged'] for line in error.lines] == [False]
        return
    raise AssertionError('it ran')


def warns():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter('always')
        wave = rcg.run('rc-synth', None, 'wave', nx=32, dx='1um', amplitude='1um',
                       wavelength='32um')
        assert not caught
        rcg.run('rc-solve', wave, load=0.01, estar='1GPa')
        assert len(caught) == 1 and str(caught[0].message).startswith('rc-solve: ')
        assert caught[0].filename == __file__
        rcg.run('rc-solve', wave, load=0.01, estar='1GPa', quiet=True)
        assert len(caught) == 1


# ---- functions ----

def raised(kind, call, *arguments, **more):
    try:
        call(*arguments, **more)
    except kind as error:
        return error
    raise AssertionError('no %s' % kind.__name__)


def functions(name):
    """The functions give the same bytes as the tools, from a file, a frame, an array or a result."""
    wanted = dict(load=[(0.5, 'N'), '1250mN'], estar='114GPa', output=['pressure', 'gap'], quiet=True)
    solved = tool('rc-solve', '--load', '0.5N,1250mN', '--estar', '114GPa', '--output', 'pressure,gap', '--quiet',
                  input=content(name))[1]
    ball = rcg.open(name)
    for surface in (name, ball, ball.frames, ball.frames[0]):
        result = rcg.solve(surface, **wanted)
        assert rcg.dumps(result.frames) == solved
    stressed = tool('rc-stress', '--nu', '0.3', '--depths', '0:3um:3', '--components', 'mises,szz', input=solved)[1]
    untouched = rcg.solve(ball, **wanted)  # whose bytes are passed on unchanged
    stress = rcg.stress(untouched, nu=0.3, depths='0:3um:3', components=['mises', 'szz'])
    assert rcg.dumps(stress.frames) == stressed and stress.mises.shape == (6, 47, 33)
    assert [len(case.frames) for case in stress.cases] == [6, 6]
    # iteration gives the frames; a result without frames is true
    assert len(stress) == 12 and [f.channel for f in stress] == [f.channel for f in stress.frames] and len(rcg.info(ball)) == 0 and rcg.info(ball)
    # messages name options as keywords; those of other tools stay
    assert str(raised(rcg.Error, rcg.solve, ball, load='1N', estar='1K')).startswith("rc-solve: estar='1K': unknown unit 'K'")
    text = raised(rcg.Error, rcg.solve, ball, load='1N', estar='1GPa', at='1um,0')
    assert '--' not in str(text) and "tilt='free'" in str(text), text
    said = rcg.tools._as_keywords('take --adhesion 50mJ/m2,exponential,0.3nm, --dx and --dy, rc-pick --set load=1', 'rc-solve')
    assert said == "take adhesion='50mJ/m2,exponential,0.3nm', --dx and --dy, rc-pick --set load=1", said
    # units of the maps that a user gives, and of those that tools write
    for channel, unit in (('heat', 'W/m2'), ('wear-coefficient', '1/Pa'), ('traction-x', 'Pa'), ('temperature-1', 'K'), ('contact', '1')):
        assert rcg.frame(channel, [[0.0, 1.0]], '1um').unit == unit, channel
    pressed = rcg.solve(ball, load='0.5N', estar='114GPa', quiet=True)
    for other in (rcg.slip(pressed, mu=0.3, nu=0.3, tangential='0.1N', quiet=True), rcg.solve(ball, load='0.5N', estar='114GPa', adhesion='1J/m2,exponential,1um', output=['adhesion', 'contact'], quiet=True),
                   rcg.leak(rcg.solve(ball, load='0.5N', estar='114GPa', quiet=True), viscosity='1mPas', pressure_drop='1kPa', quiet=True)):
        for f in other:
            assert f.unit == rcg.stream.UNITS.get(f.channel, f.unit), f
    assert rcg.dumps(rcg.synth('sphere', nx=33, ny=47, dx='1.1um', dy='1.29um', radius='2.385mm').frames) == content(name)
    again = rcg.solve(ball.height, dx=(1.1e-6, 1.29e-6), **wanted)
    assert (again.pressure == result.pressure).all() and again.pressure.shape == (2, 47, 33)
    assert numpy.allclose(result.report['load'], [0.5, 1.25], rtol=1e-12) and result.converged
    assert [case.report['asked_load'] for case in result.cases] == [0.5, 1.25] and result.contact_area[1] > result.contact_area[0]
    assert result.frame('gap', case=2).keys['load'] == '1.25'
    result.save('saved.rcg')
    assert content('saved.rcg') == solved
    assert rcg.info(ball).report['maximum'] == ball.height.max()
    assert (rcg.add(ball, ball, subtract=True).height == 0).all()


def files(name, scan):
    """A list of files gives a case for each file, whether it is a stream or a file of an instrument."""
    two = rcg.open([name, name])
    assert [f.keys['case'] for f in two.frames] == ['1', '2'] and two.height.shape[0] == 2
    assert (two.height[0] == two.height[1]).all() and (two.height[0] == rcg.open(name).height).all()
    read = rcg.open([scan, scan], dx='1um', z_unit='um')
    assert rcg.dumps(read.frames) == tool('rc-import', '--dx', '1um', '--z-unit', 'um', scan, scan)[1]
    solved = rcg.solve(name, load=[0.5, 1], estar='114GPa', quiet=True)
    solved.save('three.rcg')
    mixed = rcg.open(('three.rcg', pathlib.Path(name)))
    assert [case.channels[0] for case in mixed.cases] == ['pressure', 'pressure', 'height']
    assert solved.units['pressure'] == 'Pa' and solved.units['contact_area'] == 'm2'
    assert 'empty' in str(raised(ValueError, rcg.open, []))
    # maps of several sizes
    sizes = [(9, 7), (8, 6), (9, 7), (5, 5), (4, 4)]
    for k, (nx, ny) in enumerate(sizes):
        rcg.write('size-%d.rcg' % k, rcg.frame('height', numpy.full((ny, nx), float(k)), 1e-6))
    scans = ['size-%d.rcg' % k for k in range(5)]
    two, all_ = rcg.open(scans[:2]), rcg.open(scans)
    assert '  2 of the sizes 9 x 7, 8 x 6, 0 to 1 m>' in repr(two), two
    assert '  5 of the sizes 9 x 7, 8 x 6, 5 x 5, ..., 0 to 4 m>' in repr(all_), all_
    error = raised(rcg.Error, lambda: two.height)
    assert str(error) == 'cases differ in size (9 x 7, 8 x 6): use result.cases', error
    assert [case.height.shape[::-1] for case in all_.cases] == sizes and '2 of 9 x 7, ' in repr(rcg.open(scans[:3:2]))


def named_materials():
    """materials() has every row of rc-solve --materials, and its values go into the options."""
    known = rcg.materials()
    rows = [line.split(b'\t') for line in tool('rc-solve', '--materials')[1].splitlines()[1:]]
    assert {name.decode() for row in rows for name in row[0].strip().split(b'|')} == set(known) and len(rows) >= 20
    assert known['52100'] == known['100Cr6'] and known['steel']['nu'] == 0.291 and 'hardness' not in known['copper']
    assert all(row['source'] for row in known.values())
    ball = rcg.synth('sphere', nx=33, dx='1.1um', radius='2.385mm')
    bodies = dict(E1=known['copper']['E'], nu1=known['copper']['nu'], E2=known['steel']['E'], nu2=known['steel']['nu'])
    by_name = rcg.solve(ball, load=0.5, body1='copper', body2='steel', quiet=True)
    assert (rcg.solve(ball, load=0.5, quiet=True, **bodies).pressure == by_name.pressure).all()


def steps(name):
    """Options that a tool applies in order keep the order of the keywords; options may repeat."""
    ball = rcg.open(name)
    words = ['--set', 'a=1', '--set', 'b=2', '--crop', '0,0,9,9']
    assert rcg.pick(ball, set=['a=1', 'b=2'], crop='0,0,9,9').command[1:] == words
    assert rcg.detrend(ball, plane=True, mirror=True).command[1:] == ['--plane', '--mirror']
    assert rcg.detrend(ball, mirror=True, plane=True).command[1:] == ['--mirror', '--plane']


def layers(name):
    coated = rcg.solve(rcg.open(name), load=1, E1='210GPa', nu1=0.3, E2='rigid', quiet=True,
                       layer=[('2um', '400GPa', 0.2), (1e-6, 100e9, 0.3)])
    assert coated.command.count('--layer') == 2 and '2um,400GPa,0.2' in coated.command


def mistakes(name):
    """A wrong keyword, word or value is refused before the tool runs, with the nearest name."""
    ball = rcg.open(name)
    assert "did you mean 'load'" in str(raised(TypeError, rcg.solve, ball, lod='60N'))
    assert "did you mean 'fft'" in str(raised(ValueError, rcg.solve, ball, load=1, kernel='ftt'))
    assert 'needs a value' in str(raised(TypeError, rcg.solve, ball, load=1, estar=True))
    assert 'True or False' in str(raised(TypeError, rcg.solve, ball, load=1, history=3))
    assert 'one of' in str(raised(ValueError, rcg.solve, ball, load=1, periodic='z'))
    assert 'dx=' in str(raised(TypeError, rcg.solve, ball.height, load=1))
    assert "did you mean 'height'" in str(raised(AttributeError, lambda: ball.heigt))
    error = raised(rcg.Error, rcg.solve, ball, load='1K', estar='114GPa')
    assert error.status == 2 and 'unknown unit' in str(error)
    assert not hasattr(rcg, 'nothing') and set(rcg.tools.FUNCTIONS) <= set(dir(rcg))


def unfinished():
    rough = rcg.synth('selfaffine', nx=64, dx='1um', hurst=0.8, rms_height='100nm', seed=5)
    error = raised(rcg.NotConverged, rcg.solve, rough, periodic=True, load='0.1N', estar='100GPa', tol=1e-17)
    assert error.status == 3 and not error.result.converged and error.result.pressure.shape == (64, 64)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter('always')
        wave = rcg.synth('wave', nx=32, dx='1um', amplitude='1um', wavelength='32um')
        result = rcg.solve(wave, load=0.01, estar='1GPa')
    assert caught and all(w.category is rcg.ToolWarning and w.filename == __file__ for w in caught)
    assert result.warnings == [str(w.message) for w in caught] and caught[0].message.tool == 'rc-solve'


def pictures(name):
    result = rcg.solve(name, load=[0.5, 1, 2], estar='114GPa', quiet=True)
    assert rcg.render(result, channel='pressure')._repr_png_()[1:4] == b'PNG'
    rcg.render(result, 'curve.svg', curve='load:contact_area')
    assert b'<svg' in content('curve.svg')
    with warnings.catch_warnings():
        warnings.simplefilter('error')  # the page of a notebook, which shows the first case and says so
        shown = result._repr_html_()
        assert 'case' not in result.cases[0]._repr_html_().split('<table>')[0].split('</b>')[1]
        assert '<p>case 2 of 2, 3</p>' in rcg.Result('rc-solve', [], frames=[f for f in result if f.keys.get('case') in '23'])._repr_html_()
    picture = bytes(rcg.render(result.cases[0], width=480))
    assert '<p>case 1 of 3</p>' in shown and base64.b64encode(picture).decode() in shown and 'contact_area' in repr(result.cases[0])
    rcg.export(result, 'pressure.npy', channel='pressure', case=1)
    assert (numpy.load('pressure.npy') == result.cases[0].pressure).all()


def summaries(name):
    ball = rcg.open(name)
    assert numpy.array_equal(numpy.asarray(ball), ball.height)
    pressed = rcg.solve(ball, load='1N,3N', estar='114GPa', output='pressure', quiet=True)
    largest = max(case.pressure.max() for case in pressed.cases)
    assert '2 of ' in repr(pressed) and 'to %.4g Pa' % largest in repr(pressed)
    assert largest > pressed.cases[0].pressure.max()
    raised(TypeError, numpy.asarray, pressed)


def page(name):
    """The page of rc-report: of a file, of arrays; the older call with the name of a tool; a solution that stopped short."""
    wanted = dict(load='0.5N', estar='114GPa', quiet=True)
    made = rcg.report(name, 'page.html', **wanted)
    assert content('page.html') == made.encode() == tool('rc-report', '--load', '0.5N', '--estar', '114GPa', '--quiet', name)[1]
    assert made._repr_html_().startswith('<iframe srcdoc="&lt;!DOCTYPE html') and made.startswith('<!DOCTYPE html')
    ball = rcg.open(name)
    for surface in (ball, ball.frames[0]):
        again = rcg.report(surface, **wanted)
        assert '<title>sphere</title>' in again and again.count('<img') == made.count('<img') == 5
    assert '<title>surface</title>' in rcg.report(ball.height, dx=(1.1e-6, 1.29e-6), **wanted)
    frames, lines = rcg.report('rc-solve', ball, **wanted)
    assert len(lines) == 1 and frames[0].channel == 'pressure'
    try:
        rcg.report('nosuch.x3p')
        assert False
    except rcg.Error as e:
        assert e.status == 1 and 'nosuch.x3p' in str(e)
    os.environ['RC_BIN'] = 'short'
    try:
        rcg.report(name, 'short.html', **wanted)
        assert False
    except rcg.NotConverged as e:
        assert e.result.page == made == content('short.html').decode()


def built():
    """{function: tool} of the tools of this build, which may be without rc-leak."""
    leak = not tool('which', 'rc-leak')[0]
    return {name: command for name, command in rcg.tools.FUNCTIONS.items() if leak or command != 'rc-leak'}


def documented():
    """Every option of --help is in the documentation and in the signature, and no other; with its rules."""
    import inspect
    for name, command in built().items():
        help_ = tool(command, '--help')[1].decode()
        shown = {w.strip(' ,')[2:] for line in help_.splitlines() if line.startswith('  -')
                 for w in line.split()[:2] if w.startswith('--')}
        rows = rcg.tools.options_of(command)
        there = {row['name'] for row in rows.values()} | {row['alias'] for row in rows.values() if row['alias']}
        assert there == shown - rcg.tools.HIDDEN, (command, there ^ (shown - rcg.tools.HIDDEN))
        function = getattr(rcg, name)
        assert set(rows) <= set(inspect.signature(function).parameters)
        for python in rows:
            assert '\n%s' % python in function.__doc__, (name, python)
        for row in rows.values():
            assert row['rules'] in function.__doc__, (name, row['rules'])


def exemplified(name):
    """help() of a function is short and begins with an example, which works."""
    import pydoc
    surface = rcg.pick(rcg.sample('rough-steel.x3p'), crop='0,0,32,32')
    surface = rcg.detrend(surface, plane=True, fill=True)
    roughness = surface
    result = rcg.solve(surface, radius='1mm', load='0.5N', estar='114GPa', hardness='6GPa', quiet=True)
    here = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for function in built():
                page = pydoc.plain(pydoc.render_doc(getattr(rcg, function))).split('\n')
                example = page[3].strip()
                assert len(page[2]) < 100 and example.startswith('Example: '), page[:4]
                example = example.replace('Example: ', '').replace("'rough-steel.x3p'", "rcg.sample('rough-steel.x3p')")
                with warnings.catch_warnings():
                    warnings.simplefilter('ignore')
                    exec(example.replace('0,0,128,128', '0,0,16,16'), dict(rcg=rcg, surface=surface, roughness=roughness, result=result))
        finally:
            os.chdir(here)


def mutated(folder):
    """A change in the option table of a tool changes the documentation."""
    os.environ['RC_BIN'] = folder
    assert 'hardened' in rcg.solve.__doc__ and 'hardness' not in rcg.tools.options_of('rc-solve')


def keywords(stub):
    """{function: names of its keywords} of the functions in a stub that take a surface or files."""
    import ast
    return {node.name: [a.arg for a in node.args.kwonlyargs] for node in ast.parse(stub).body
            if isinstance(node, ast.FunctionDef)}


def hints(stub, tables):
    """The stub has every function with the options of its tool, which come from the tables and nothing else."""
    text, rows = content(stub).decode(), content(tables).decode()
    there = keywords(text)
    assert set(there) == set(built())
    assert {json.loads(row)['tool'] for row in rows.splitlines()} == set(built().values()), 'a tool without a function'
    for name, command in built().items():
        assert set(there[name]) - {'dx', 'timeout', 'progress'} == set(rcg.tools.options_of(command)) - {'dx'}, name
    assert "kernel: Literal['auto', 'fft'," in text
    with open('tables.json', 'w') as file:
        file.write(rows.replace('"name": "hardness"', '"name": "hardened"'))
    changed = subprocess.run([sys.executable, '-m', 'rcg.stubs', 'tables.json'], stdout=subprocess.PIPE, check=True).stdout
    assert 'hardened' in keywords(changed)['solve'] and 'hardness' not in keywords(changed)['solve']


def progress():
    """The tool's lines for programs, which rise to 1 and are not warnings; a function gets them, a terminal sees one line."""
    rough = rcg.synth('selfaffine', nx=256, dx='1um', hurst=0.8, rms_slope=0.05, seed=3)
    wanted = dict(periodic=True, mean_pressure='100MPa', estar='100GPa', output='pressure', quiet=False)
    said = []
    result = rcg.solve(rough, progress=said.append, tol=1e-10, **wanted)
    assert said and not result.warnings and all(s['tool'] == 'rc-solve' and s['text'].startswith('case 1, ') for s in said)
    shares = [s['progress'] for s in said if s['progress'] is not None]
    assert shares == sorted(shares) and all(0 <= s <= 1 for s in shares), shares
    done = subprocess.run(['rc-solve', '--progress', '--periodic', '--mean-pressure', '100MPa', '--estar', '100GPa'],
                          input=rcg.dumps(rough.frames), stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True)
    assert done.stderr.startswith(b'rc-solve: case 1, ')
    assert tool('rc-solve', '--progress=bar')[0] == 2
    rcg.tools.PROGRESS_AFTER, sys.stderr = 0, io.StringIO()
    rcg.solve(rough, tol=1e-10, **wanted)
    silent = sys.stderr.getvalue()
    rcg.solve(rough, tol=1e-10, progress=True, **wanted)
    lines, sys.stderr = sys.stderr.getvalue().split('\r'), sys.__stderr__
    assert silent == '' and lines[1].startswith('rc-solve: ') and lines[-1] == '' and not lines[-2].strip(), lines


def table_of(height):
    """The values as a DataFrame."""
    import pandas
    return pandas.DataFrame(height.values)


def data_sets(name):
    """to_xarray and to_pandas: the values, names, units and places of the frames."""
    ball = rcg.open(name)
    solved = rcg.solve(ball, load=[0.5, 1], estar='114GPa', quiet=True)
    cube = solved.to_xarray()
    assert cube.pressure.dims == ('case', 'y', 'x') and cube.pressure.attrs['units'] == 'Pa'
    assert cube.pressure.attrs['long_name'] == 'pressure' and cube.x.attrs['units'] == 'm'
    assert (cube.pressure.values == solved.pressure).all() and list(cube.case) == [1, 2]
    assert abs(float(cube.x[1] - cube.x[0]) / ball.dx - 1) < 1e-9 and abs(float(cube.y[1] - cube.y[0]) / ball.dy - 1) < 1e-9
    stress = rcg.stress(solved, nu=0.3, depths='1um,3um', components=['mises', 'szz'])
    deep = stress.to_xarray()
    assert deep.mises.dims == ('case', 'depth', 'y', 'x') and numpy.allclose(deep.depth, [1e-6, 3e-6])
    assert (deep.szz.sel(case=2, depth=3e-6, method='nearest').values == stress.cases[1].szz[1]).all()
    one = solved.cases[0].to_xarray()
    assert one.pressure.dims == ('y', 'x') and one.attrs['load'] == solved.cases[0].load
    back = rcg.solve(ball.to_xarray().height, load=[0.5, 1], estar='114GPa', quiet=True)
    assert numpy.allclose(back.pressure, solved.pressure, rtol=1e-6, atol=1e3)
    height = ball.to_xarray().height
    assert rcg.dumps(rcg.tools.frames_from(height.transpose('x', 'y'))) == rcg.dumps(rcg.tools.frames_from(height))
    bare = height.drop_vars(['x', 'y'])
    assert rcg.tools.frames_from(bare, (1e-6, 2e-6))[0].dy == 2e-6
    uneven, micrometres = height.copy(), height.copy()
    uneven['x'] = uneven.x.values ** 2
    micrometres['x'] = micrometres.x.copy()
    micrometres.x.attrs['units'] = 'um'
    nanometres = height.copy()
    nanometres.attrs = {'units': 'nm'}
    for kind, words, surface, dx in ((TypeError, 'dx=', bare, None), (TypeError, 'has the coordinates', height, 1e-6),
                                     (ValueError, 'even', uneven, None), (ValueError, 'even', height[:, ::-1], None), (ValueError, 'coordinate x in um', micrometres, None),
                                     (ValueError, 'height in nm', nanometres, None), (TypeError, "dataset['height']", ball.to_xarray(), None),
                                     (ValueError, 'shape', cube.pressure.assign_attrs(units='Pa'), None), (TypeError, 'dx=', table_of(height), None)):
        assert words in str(raised(kind, rcg.solve, surface, dx=dx, load=1e-6, estar=1e9)), words
    assert (rcg.pick(table_of(height), dx=1e-6, crop='0,0,33,47').height == ball.height).all()
    assert abs(float(cube.x.mean())) < 1e-12 and abs(float(cube.y[0]) + (ball.height.shape[0] - 1) / 2 * ball.dy) < 1e-12
    assert numpy.allclose(cube['load'], [0.5, 1], rtol=1e-9) and cube['load'].attrs['units'] == 'N' and 'mean_pressure' in cube.coords
    listed = [0.3, 0.7, 1, 2]  # whose computed loads differ by rounding
    several = rcg.solve(ball, load=listed, estar='114GPa', quiet=True)
    assert list(several.to_xarray()['load']) == listed != list(several.load)
    for load, case in zip(listed, several.cases):
        assert (several.to_xarray().swap_dims(case='load').pressure.sel(load=load).values == case.pressure).all()
    assert 'load' not in one.coords
    for other, words in ((rcg.pick(ball, crop='0,0,30,47'), 'size (33 x 47, 30 x 47)'),
                         (rcg.frame('height', ball.height, '1um'), 'spacing (1.1e-06 x 1.29e-06 m, 1e-06 x 1e-06 m)')):
        rcg.write('other.rcg', other)
        error = raised(rcg.Error, rcg.open([name, 'other.rcg']).to_xarray)
        assert str(error) == 'cases differ in %s: use result.cases' % words, error
    for dx in ('1.1um', (1.1, 'um'), 1.1e-6, ('1.1um', '0.0011mm'), '1.1e-6'):
        assert rcg.stream.steps(dx) == (1.1e-6, 1.1e-6), dx
    for dx in ('1.1', (1.1, 'um', 3), '1.1ium', 'um', ''):
        assert dx == '1.1' or 'metres' in str(raised(TypeError, rcg.stream.steps, dx)), dx
    table = solved.to_pandas()
    assert not table.isna().all().any() and table.attrs['units']['max_pressure'] == 'Pa' and 'converged' not in table.attrs['units']
    assert list(table.load) == list(solved.load) and len(table) == 2 and table.converged.all()
    assert list(table['contact_area']) == [case.contact_area for case in solved.cases]


def drawn(script):
    """The script of the page and its lists: areas are proportional to the load to the power 2/3."""
    names = {}
    os.environ['MPLBACKEND'] = 'Agg'
    exec(compile(content(script), script, 'exec'), names)
    radius, estar = names['radius'], names['estar']
    cell = names['dx']
    assert len(names['lines']) >= 5
    for line in names['lines']:
        a = (3 * line['load'] * radius / (4 * estar)) ** (1 / 3)
        crossed = 2 * math.pi * a * math.sqrt(2) * cell
        assert abs(line['contact_area'] - math.pi * a ** 2) < crossed, line


# ---- what hangs ----

class Late(BaseException):
    """A call that has not returned in time."""


def timed(seconds, call):
    """The exception that the call raises, or None, if it returns in time."""
    def late(*_):
        raise Late('no end after %g s' % seconds)

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        call()
    except Exception as error:
        return error
    except KeyboardInterrupt as error:
        return error
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def children():
    """The processes that this one started, zombies included."""
    done = subprocess.run(['ps', '-o', 'ppid=,args='], stdout=subprocess.PIPE, universal_newlines=True).stdout
    return [line for line in done.splitlines() if line.split()[0] == str(os.getpid()) and ' ps ' not in line]


def interrupts():
    """Ctrl-C ends a call while the tool computes, writes more than a pipe holds, does not read, or ignores signals."""
    def stop(said):
        if 'iteration' in said['text']:
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    def writing(*_):
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, signal.default_int_handler)
    rough = rcg.synth('selfaffine', nx=512, dx='1um', hurst=0.8, rms_slope=0.1)
    wanted = dict(load='1N:60N:300', estar='100GPa', tol=1e-9, periodic=True)

    def soon(call):
        threading.Timer(0.5, stop, [{'text': 'iteration'}]).start()
        call()

    def filled(call):
        fill, rcg.stream._fill = rcg.stream._fill, writing
        try:
            call()
        finally:
            rcg.stream._fill = fill

    for name, call in (('computes', lambda: rcg.solve(rough, progress=stop, **wanted)),
                       ('writes', lambda: filled(lambda: rcg.solve(rough, load='1N', estar='100GPa', quiet=True))),
                       ('does not read', lambda: soon(lambda: rcg.run('sleep', rough.frames, '60'))),
                       ('ignores signals', lambda: soon(lambda: rcg.run('sh', rough.frames, '-c', 'trap "" TERM INT; while :; do sleep 1; done')))):
        began = time.monotonic()
        error = timed(20, call)
        assert isinstance(error, KeyboardInterrupt), (name, error)
        print('%s: ended after %.1f s' % (name, time.monotonic() - began))
        assert not children(), (name, children())


def timeouts():
    """A tool that its time stops is said to have stopped for it; one that fails before keeps its own message."""
    rough = rcg.synth('selfaffine', nx=512, dx='1um', hurst=0.8, rms_slope=0.1)
    wanted = dict(load='1N:60N:300', estar='100GPa', tol=1e-9, timeout=0.5)
    error = timed(20, lambda: rcg.solve(rough, **wanted))
    assert type(error) is rcg.Error and str(error) == 'rc-solve: stopped after timeout=0.5 s' and error.status == -15, repr(error)
    assert not children(), children()
    error = raised(rcg.Error, rcg.solve, rough, **dict(wanted, estar='1K', timeout=60))
    assert 'unknown unit' in str(error) and error.status == 2, error


def hostile():
    """What cannot be sent to a tool raises an exception with a reason before the tool runs, and what can arrives unchanged."""
    a = numpy.arange(12.0).reshape(3, 4) * 1e-9

    def bad(**changes):
        made = rcg.frame('height', a, 1e-6)
        for name, value in changes.items():
            setattr(made, name, value)
        return made

    class Quantity(numpy.ndarray):  # as in astropy
        unit, si = 'um', None

    class Measured:  # as in pint
        magnitude = 60.0

        def to(self, unit):
            if unit != 'N':
                raise TypeError('newton is no ' + unit)
            return self

        to_base_units = to

    assert rcg.tools.arguments('rc-solve', {'load': [Measured(), 1]}) == ['--load', '60,1']

    def broken():
        yield rcg.frame('height', a, 1e-6)
        raise KeyError('my own')

    keys = rcg.frame('height', a, 1e-6).keys
    masked = numpy.ma.masked_greater
    for kind, words, surface, dx in (
            (TypeError, 'dx=', [[0.0, 1e-7], [0.0, 1e-7]], None), (TypeError, 'dx=', a, None), (TypeError, 'is None', None, None),
            (ValueError, 'shape', numpy.zeros((0, 3)), 1e-6), (ValueError, 'shape', numpy.zeros((2, 2, 2)), 1e-6), (ValueError, 'shape', [], 1e-6),
            (TypeError, 'not a map', 3.0, 1e-6), (TypeError, 'not a map', numpy.float64(3), 1e-6), (TypeError, 'not a map', None, 1e-6),
            (TypeError, 'dict', {'z': a}, 1e-6), (TypeError, 'not a map', b'RCG1', 1e-6), (TypeError, 'complex', a * 1j, 1e-6),
            (TypeError, 'complex', masked(a, 1) * 1j, 1e-6), (TypeError, 'object', [[1.0, None]], 1e-6), (TypeError, 'object', a.astype(object), 1e-6),
            (TypeError, 'not real numbers', masked(numpy.array([['1', '2']]), 'z'), 1e-6), (TypeError, 'object', [[2**70]], 1e-6),
            ((TypeError, ValueError), '', [[1.0], [1.0, 2.0]], 1e-6), (TypeError, 'datetime64', a.astype('M8[s]'), 1e-6),
            (TypeError, 'um', a.view(Quantity), 1e-6), (TypeError, 'um', [a.view(Quantity)], 1e-6),
            (ValueError, 'do not fit', numpy.array([[2**53 + 1, 0]]), 1e-6), (ValueError, 'do not fit', numpy.array([[2**64 - 1]], 'u8'), 1e-6),
            (ValueError, 'dx=', a, -1e-6), (ValueError, 'dx=', a, math.nan), (TypeError, 'neither', a, 1e-6j), (TypeError, '(dx, dy)', a, (1e-6, 1e-6, 'um')),
            (TypeError, 'own', bad(), 1e-6), (TypeError, 'own', [bad()], 1e-6), (TypeError, 'number 2', [bad(), a], None),
            (TypeError, 'number 1', iter([a]), None), (KeyError, 'my own', broken(), None),
            (TypeError, 'not a map', bad(values=None), None), (TypeError, 'complex', bad(values=a * 1j), None), (ValueError, 'shape', bad(values=a[:0]), None),
            (ValueError, 'key b', bad(keys={**keys, b'note': 'x'}), None), (ValueError, 'key None', bad(keys={**keys, None: 'x'}), None),
            (ValueError, 'key', bad(keys={**keys, 'no\nte': 'x'}), None), (ValueError, 'must be a text', bad(keys={**keys, 'load': 1.0}), None),
            (ValueError, 'must be a text', bad(keys={**keys, 'load': b'1'}), None), (ValueError, 'bytes', bad(keys={**keys, 'note': 'x' * 70000}), None),
            (ValueError, '', bad(keys={**keys, 'note': '\ud800'}), None), (ValueError, 'without the key', bad(keys={'channel': 'height'}), None),
            (ValueError, 'case', bad(keys={**keys, 'case': '0'}), None)):
        error = timed(20, lambda: rcg.solve(surface, dx=dx, load=1e-6, estar=1e9, quiet=True))
        assert isinstance(error, kind) and words in str(error), (surface, dx, error)
        assert not isinstance(error, rcg.Error), 'the tool ran: %s' % error
        assert not children(), children()
    if numpy.finfo(numpy.longdouble).max > numpy.finfo(float).max:
        assert 'do not fit' in str(timed(20, lambda: rcg.frame('height', numpy.array([[numpy.longdouble('1e400')]]), 1e-6)))
    # rows with masks; views; other types, as heights: each arrives unchanged
    wide = numpy.zeros((6, 8))
    wide[::2, ::2] = a
    hidden = numpy.ma.masked_equal(a, a[1, 1])
    for values in (a, a.tolist(), tuple(map(tuple, a)), wide[::2, ::2], a[::-1].copy()[::-1], a.T.copy().T, a.astype('>f8'), a.astype('f4'), a.astype('>f4'),
                   a[0], a[0].tolist(), numpy.matrix(a), list(hidden), hidden, (a * 1e9).astype('i8'), (a * 1e9).astype('u1'), a > 0):
        sent = []
        error = timed(20, lambda: sent.append(rcg.pick(values, dx=1e-6, crop='0,0,4,%d' % numpy.atleast_2d(numpy.ma.array(values)).shape[0]).height))
        expected = numpy.atleast_2d(numpy.ma.array(values).astype(float).filled(numpy.nan))
        assert error is None and numpy.array_equal(sent[0], expected, equal_nan=True), (values, error)
    assert numpy.array_equal(rcg.pick((f for f in [bad()]), crop='0,0,4,3').height, a)
    # what the tool is told, and what watches it
    wanted = dict(load=1e-6, estar=1e9, quiet=True)
    rough = rcg.synth('selfaffine', nx=128, dx='1um', hurst=0.8, rms_slope=0.1)
    for kind, words, more in ((ValueError, 'timeout', {'timeout': -1}), (ValueError, 'timeout', {'timeout': math.nan}), (TypeError, '', {'timeout': '5'}),
                              (TypeError, 'neither', {'load': 1j}), (TypeError, 'neither', {'load': b'1N'}), (TypeError, 'neither', {'load': [[1, 2]]}),
                              (ValueError, 'null', {'load': '1\0'}), (TypeError, 'newton is no Pa', {'estar': Measured()}),
                              (ZeroDivisionError, '', {'progress': lambda said: 1 / 0, 'load': '1N:60N:300', 'quiet': False})):
        error = timed(20, lambda: rcg.solve(rough, **{**wanted, **more}))
        assert isinstance(error, kind) and words in str(error) and not children(), (more, error)


def scenes(name):
    """A hardness below the largest pressure of rcg.solve() is called for, one above it is negligible."""
    bodies = {'load': '0.5N', 'E1': '210GPa', 'nu1': 0.3, 'E2': 'rigid', 'quiet': True}
    most = rcg.solve(name, **bodies).pressure.max()
    for hardness, verdict in ((1.1 * most, 'negligible'), (0.8 * most, 'calls for it')):
        effects = rcg.scene(name, hardness=hardness, **bodies)[0]['scene']
        assert [e['verdict'] for e in effects if e['effect'] == 'hardness'] == [verdict], effects
    table = rcg.scene(name, hardness=hardness, **bodies)
    row = next(e['sentence'] for e in table[0]['scene'] if e['effect'] == 'hardness')
    assert row.startswith('calls for it: ') and ['hardness', row] in [line.split(None, 1) for line in repr(table).splitlines()], repr(table)
    assert '<td>hardness</td><td>%s</td>' % row in table._repr_html_() and 'load 0.5 N' in table._repr_html_()
    assert 'data missing: mu=, speed=, conductivity=, diffusivity=' in repr(table) and isinstance(table, list)


def messages(name):
    """Messages quote values whole, and name no temporary file; nor do pictures."""
    for given, words in (({'load': '5 Newton', 'estar': '1GPa'}, "rc-solve: load='5 Newton': unknown unit 'Newton'"),
                         ({'load': '1N', 'body1': 'my steel', 'body2': 'rigid'}, "rc-solve: body1='my steel': it is in no table")):
        assert str(raised(rcg.Error, rcg.solve, name, **given)).startswith(words)
    surfaces = [rcg.synth('sphere', radius='1mm', nx=32, dx=dx) for dx in ('1um', '2um')]
    said = str(raised(rcg.Error, rcg.add, *surfaces))
    assert tempfile.gettempdir() not in said and 'in the second surface of 2e-06' in said, said
    solved = rcg.solve(surfaces[0], load=['0.1N', '0.2N', '0.3N'], estar='1GPa', quiet=True)
    said = str(raised(rcg.Error, rcg.render, solved, curve='load:nosuch'))
    assert said.startswith('rc-render: the report: there is no column nosuch'), said
    with tempfile.TemporaryDirectory() as folder:
        picture = rcg.render(solved, os.path.join(folder, 'curve.svg'), curve='load:contact_area')
    assert b'>sphere<' in picture and b'report.json' not in picture


def costs(name):
    """The table of rcg.cost() has the errors of the pressures of rcg.solve()."""
    contact = {'load': '0.5N', 'estar': '114GPa', 'quiet': True}
    rows = rcg.cost(name, 'rc-solve --load 0.5N --estar 114GPa', tol=[1e-2, 1e-4], quiet=True)
    assert [row['what'] for row in rows] == ['reference', 'trial', 'trial'] and [row['tol'] for row in rows] == [1e-6, 1e-2, 1e-4], rows
    best = rcg.solve(name, tol=1e-6, **contact).pressure
    for row in rows[1:]:
        off = numpy.abs(rcg.solve(name, tol=row['tol'], **contact).pressure - best).sum() / best.sum()
        assert abs(row['error'] - off) <= 1e-9 * off and row['bound'] >= off and row['memory'] > 0, (row, off)
    words = ['rc-solve', '--load', '0.5N', '--estar', '114GPa', '|', 'rc-stress', '--nu', '0.3', '--depths', '1um,2um']
    assert len(rcg.cost(name, words, vary=['1.tol=1e-2,1e-3', '2.kernel=fft,mlms'], quiet=True)) == 5
    assert 'no shell' in str(raised(rcg.Error, rcg.cost, name, 'sh -c true'))
    fast = rcg.cost(name, 'rc-solve --load 0.5N --estar 114GPa', tol=[1e-2, 1e-4], error='1%', quiet=True)
    near = [row for row in fast if row['what'] == 'trial' and row['bound'] <= 0.01]
    assert fast.proposal == min(near, key=lambda row: row['seconds'])['command'], (fast.proposal, near)
    assert repr(fast).endswith('proposal: ' + fast.proposal) and '<code>%s</code>' % fast.proposal in fast._repr_html_(), fast
    assert rows.proposal is None and 'proposal' not in repr(rows) and repr(rows).count('\n') == 3, rows


def bars(name):
    """The table of rcg.cost(noise=...) has the figures of rcg.solve() with their bars, and then the maps."""
    report = rcg.solve(name, load='0.5N', estar='114GPa', quiet=True).report
    rows = rcg.cost(name, 'rc-solve --load 0.5N --estar 114GPa', noise='5nm', resolution=True, quiet=True)
    figures = {row['name']: row for row in rows if row['what'] == 'figure'}
    for figure in ('contact_area', 'elastic_energy', 'approach'):
        row = figures[figure]
        assert abs(row['value'] / report[figure] - 1) < 1e-9 and (row['bar'] is None or row['bar'] > 0), row
    assert [row['name'] for row in rows if row['what'] == 'run'] == ['noise 1', 'noise 2', 'noise 3', 'noise 4', 'grid 1/2', 'grid 1/4'], rows


# ---- several processes ----

def same(a, b):
    return rcg.dumps(a.frames) == rcg.dumps(b.frames) and repr(a) == repr(b) and (a.report, a.warnings, a.command) == (b.report, b.warnings, b.command)


def pickles(name):
    """Results, frames, errors and warnings can be pickled and copied."""
    whole = rcg.read(name)[0]
    solved = rcg.solve(name, load='0.5N', estar='114GPa', quiet=True)
    short = raised(rcg.NotConverged, rcg.solve, rcg.synth('selfaffine', nx=64, dx='1um', hurst=0.8, rms_height='100nm', seed=5),
                   periodic=True, load='0.1N', estar='100GPa', tol=1e-17)
    wrong = raised(rcg.Error, rcg.solve, name, load='1K', estar='1GPa')
    warned = rcg.ToolWarning('loud', 'rc-solve')
    for copied in [copy.copy, copy.deepcopy] + [lambda thing, p=p: pickle.loads(pickle.dumps(thing, p)) for p in range(pickle.HIGHEST_PROTOCOL + 1)]:
        again = copied(solved)
        assert same(again, solved) and type(again) is rcg.Result and rcg.dumps(again.frames) == b''.join(again.stream())
        assert same(copied(solved.cases[0]), solved.cases[0])
        other = copied(whole)
        assert rcg.dumps(other) == rcg.dumps(whole) and type(other) is rcg.Frame
        other = copied(short)
        assert type(other) is rcg.NotConverged and str(other) == str(short) and other.status == 3 and same(other.result, short.result)
        assert rcg.dumps(other.frames) == rcg.dumps(short.frames) and other.lines == short.lines
        other = copied(wrong)
        assert type(other) is rcg.Error and (str(other), other.status, other.frames, other.lines) == (str(wrong), 2, [], [])
        other = copied(warned)
        assert (type(other), str(other), other.tool) == (rcg.ToolWarning, 'loud', 'rc-solve')
        assert type(copied(rcg.tools.Picture(b'x'))) is rcg.Picture and type(copied(rcg.tools.Page('x'))) is rcg.Page
    deep = copy.deepcopy(solved)
    deep.pressure[:] = 0
    assert solved.pressure.max() > 0


def pool(count):
    """A pool of four processes solves the maps that one process solves, and raises what the tools raise."""
    maps = [rcg.synth('selfaffine', nx=32, dx='1um', hurst=0.8, rms_height='50nm', seed=seed) for seed in range(1, int(count) + 1)]
    solve = functools.partial(rcg.solve, periodic=True, mean_pressure='100MPa', estar='100GPa', quiet=True)
    alone = [solve(surface) for surface in maps]
    for method in ('fork', 'spawn'):
        with concurrent.futures.ProcessPoolExecutor(4, mp_context=multiprocessing.get_context(method)) as workers:
            for one, other in zip(workers.map(solve, maps), alone):
                assert rcg.dumps(one.frames) == rcg.dumps(other.frames) and one.load == other.load
            error = workers.submit(solve, maps[0], tol=1e-17).exception(60)
            assert isinstance(error, rcg.NotConverged) and error.result.pressure.shape == (32, 32), error
            error = workers.submit(solve, maps[0], estar='1K').exception(60)
            assert type(error) is rcg.Error and 'unknown unit' in str(error), error
    with multiprocessing.Pool(4) as workers:
        assert [rcg.dumps(one.frames) for one in workers.map(solve, maps)] == [rcg.dumps(one.frames) for one in alone]


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell ignores it in the background
    for _ in sys.stdin:
        child = os.fork()
        if child == 0:
            for number, name, mode in ((0, os.devnull, 'r'), (1, 'said.out', 'w'), (2, 'said.err', 'w')):
                with open(name, mode) as file:
                    os.dup2(file.fileno(), number)
            name, *arguments = content('asked').decode().split('\0')[:-1]
            globals()[name](*arguments)
            sys.exit()
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        print(status if status >= 0 else 128 - status, flush=True)


if __name__ == '__main__':  # not in the processes of a pool
    main()
