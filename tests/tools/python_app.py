# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of rc-app for pipe_app.sh: python_app.py ADDRESS CHECK [ARGUMENT...]. A page is a client of HTTP like this one."""
import http.client
import json
import os
import re
import subprocess
import sys
import threading
import time
import urllib.parse
import urllib.request
import zlib

ADDRESS = urllib.parse.urlsplit(sys.argv[1])
TOKEN = ADDRESS.path.strip('/')
SOLVE = [['load', '20N,60N'], ['radius', '3.75mm'], ['estar', '114GPa'], ['hardness', '6GPa']]
LEVEL = [['poly', '2'], ['spikes', '5'], ['fill', True]]
LONG = [['load', '1N:60N:4000'], ['radius', '3.75mm'], ['estar', '114GPa'], ['tol', '1e-8']]
SAMPLE = 0  # the number of the sample among the files


def ask(at, query=None, body=None, path=None, **headers):
    """Status, headers and body of the answer; a body is posted."""
    link = http.client.HTTPConnection(ADDRESS.hostname, ADDRESS.port, timeout=60)
    path = '/%s/%s?%s' % (TOKEN, at, urllib.parse.urlencode(query or {})) if path is None else path
    link.request('GET' if body is None else 'POST', path, body, {k.replace('_', '-'): v for k, v in headers.items()})
    answer = link.getresponse()
    return answer.status, answer.headers, answer.read()


def found(at, query=None, body=None):
    status, _, text = ask(at, query, body if body is None or isinstance(body, bytes) else json.dumps(body))
    assert status == 200, (at, status, text)
    return json.loads(text)


def refused(status, words, *given, **more):
    got, _, text = ask(*given, **more)
    assert got == status and words in text.decode(), (got, text)


def steps(*given):
    """Steps that read each other's output."""
    return [{'tool': tool, 'options': options, 'from': k} for k, (tool, options) in enumerate(given)]


def start(file, *given):
    return found('steps', body={'file': file, 'steps': steps(*given), 'start': True})['run']


def added_steps():
    """Each step, as the page adds it after the first contact, runs; stresses and friction take the bodies from the contact."""
    with open(os.path.join(os.environ['RC_SOURCE'], 'python', 'rcg', 'page', 'page.js'), encoding='utf-8') as file:
        rows = re.search(r'const STEPS = \{\n(.*?)\n\};', file.read(), re.S).group(1)
    begin = {}
    for name, options in re.findall(r"^  (\w+): \['[^']*'(?:, \{(.*)\})?\],$", rows, re.M):
        pairs = re.findall(r"'?([\w-]+)'?: (?:'([^']*)'|(true))", options)
        begin['rc-' + name] = [[key, True if flag else text] for key, text, flag in pairs]
    assert len(begin) >= 10 and ['load', '1N'] in begin['rc-solve'], begin
    first = [{'tool': tool, 'options': begin[tool], 'from': k} for k, tool in enumerate(('rc-import', 'rc-detrend', 'rc-solve'))]
    for tool in set(begin) - {'rc-import', 'rc-pick', 'rc-detrend', 'rc-solve', 'rc-deflect', 'rc-add'}:
        assert all(text != '' for _, text in begin[tool]), begin[tool]
        number = found('steps', body={'file': SAMPLE, 'steps': first + [{'tool': tool, 'options': begin[tool], 'from': 3}], 'start': True})['run']
        last = ended(number)
        assert last['state'] == 'done', (tool, last)
        assert not last['steps'][2]['words'], 'the contact that the page begins with has a warning: ' + last['steps'][2]['words']


STATE = []


def runs():
    """The state of all runs, as the page gets it."""
    def listen():
        link = http.client.HTTPConnection(ADDRESS.hostname, ADDRESS.port)
        link.request('GET', '/%s/events' % TOKEN)
        answer = link.getresponse()
        for line in answer.fp:
            if line.startswith(b'data: '):
                STATE[:] = [{run['number']: run for run in json.loads(line[len('data: '):])}]

    if not STATE:
        threading.Thread(target=listen, daemon=True).start()
    while not STATE:
        time.sleep(0.01)
    return STATE[0]


def comes(true):
    """The value of the function `true` as soon as it is true, which may take a while on busy cores."""
    for _ in range(3000):
        value = true()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(runs())


def until(number, *states):
    """The run, when it has one of these states."""
    return comes(lambda: runs().get(number, {'state': None})['state'] in states and runs()[number])


def ended(number):
    return until(number, 'done', 'short', 'failed', 'stopped')


def tools_running():
    """The rc-solve processes that rc-app started."""
    text = subprocess.run(['ps', '-e', '-o', 'ppid=,args='], stdout=subprocess.PIPE, universal_newlines=True).stdout
    return [line for line in text.splitlines() if line.split()[0] == os.environ['APP'] and 'rc-solve' in line]


def uploaded(name):
    with open(name, 'rb') as file:
        return found('upload', {'name': name}, file.read())['id']


# ---- checks ----

def page():
    """The page and its parts are served, and may load nothing else."""
    for at, kind, words in (('', 'text/html', '<title>'), ('page.css', 'text/css', 'body'), ('page.js', 'javascript', 'use strict'), ('map.js', 'javascript', 'class')):
        status, headers, text = ask(at)
        assert status == 200 and kind in headers['Content-Type'] and words in text.decode(), (at, status)
        assert "default-src 'none'" in headers['Content-Security-Policy'] and 'unsafe' not in headers['Content-Security-Policy']
        assert headers['Referrer-Policy'] == 'no-referrer' and headers['Cache-Control'] == 'no-store'
    refused(404, 'does not exist', 'app.py')
    refused(404, 'does not exist', '../app.py')


def token():
    for path in ('/', '/desk', '/page.js', '/%s/desk' % ('x' * len(TOKEN)), '/%s/desk' % TOKEN[:-1], '/?token=' + TOKEN, '//'):
        refused(403, 'token of this session', None, path=path)
        refused(403, 'token of this session', None, path=path, body='{}')


def host():
    for name in ('evil.example', 'evil.example:%d' % ADDRESS.port, '127.0.0.1', '127.0.0.1:1', '127.0.0.1.evil.example:%d' % ADDRESS.port, ''):
        refused(403, 'token of this session', 'desk', Host=name)
    assert ask('desk', Host='localhost:%d' % ADDRESS.port)[0] == 200


def origin():
    for name in ('http://evil.example', 'null', 'http://127.0.0.1:1', 'https://127.0.0.1:%d' % ADDRESS.port):
        refused(403, 'token of this session', 'quit', body='{}', Origin=name)
        refused(403, 'token of this session', 'desk', Origin=name)
    assert ask('desk', Origin='http://127.0.0.1:%d' % ADDRESS.port)[0] == 200


def loopback():
    """The port is open on 127.0.0.1 alone."""
    with open('/proc/net/tcp') as file:
        places = [line.split()[1] for line in file if line.split()[1].endswith(':%04X' % ADDRESS.port) and line.split()[3] == '0A']
    assert places == ['0100007F:%04X' % ADDRESS.port], places


def names():
    """Names from the browser are not paths, options or names of steps."""
    for name, kept in (('../../../etc/passwd', 'passwd'), ('..', '_..'), ('C:\\scans\\a.x3p', 'a.x3p'), ('a\n$(touch x);b.txt', 'a_$(touch x);b.txt'),
                       ('-o.txt', '-o.txt'), ('1-import.rcg', '_1-import.rcg'), ('', '_'), ('ä' * 200, 'ä' * 100)):
        file = found('upload', {'name': name}, b'1 2\n3 4\n')
        assert file['name'] == kept and os.path.dirname(os.path.dirname(file['path'])) == os.environ['FOLDER'], file
    for name in ('-o.txt', 'a\n$(touch x);b.txt'):
        run = ended(start(found('upload', {'name': name}, b'1 2\n3 4\n')['id'], ('rc-import', [['dx', '1um'], ['z-unit', 'nm']])))
        assert run['state'] == 'done', run
    assert run['steps'][0]['command'].endswith("'a_$(touch x);b.txt'") and not os.path.exists('x')


def limit():
    link = http.client.HTTPConnection(ADDRESS.hostname, ADDRESS.port, timeout=10)
    link.putrequest('POST', '/%s/upload?name=big.x3p' % TOKEN)
    link.putheader('Content-Length', str(3 << 30))
    link.endheaders()
    answer = link.getresponse()
    text = answer.read().decode()
    assert answer.status == 413 and '3.0 GB, the page takes at most 2 GB' in text, (answer.status, text)
    refused(411, 'no length', 'upload', {'name': 'a'}, b'', Content_Length='many')


def large():
    """A file of 200 MB is stored; it is not a surface, as rc-import says."""
    def zeros():
        for _ in range(200):
            yield bytes(1000000)

    status, _, text = ask('upload', {'name': 'large.bin'}, zeros(), Content_Length='200000000')
    file = json.loads(text)
    assert status == 200 and file['size'] == os.path.getsize(file['path']) == 200000000
    run = ended(start(file['id'], ('rc-import', [])))
    assert run['state'] == 'failed' and 'not recognised' in run['steps'][0]['words'], run


def broken(name, words):
    """A file that rc-import refuses: its message, and no further step."""
    run = ended(start(uploaded(name), ('rc-import', []), ('rc-detrend', LEVEL)))
    assert run['state'] == 'failed' and words in run['steps'][0]['words'], run
    assert run['steps'][1]['state'] == 'waiting', run


def wrong_unit():
    run = ended(start(SAMPLE, ('rc-import', []), ('rc-solve', [['load', '60K'], ['estar', '1GPa']])))
    assert run['state'] == 'failed' and "unknown unit 'K'" in run['steps'][1]['words'], run


def boundaries():
    """All four boundaries can be chosen; the frames have their names."""
    for axes, word in ((None, 'free'), ('xy', 'periodic'), ('x', 'periodic-x'), ('y', 'periodic-y')):
        more = [] if axes is None else [['periodic', axes]]
        run = ended(start(SAMPLE, ('rc-import', []), ('rc-detrend', LEVEL), ('rc-solve', [['load', '1N'], ['estar', '114GPa']] + more)))
        heads = found('frames', {'run': run['number'], 'step': 2})
        assert heads[0]['boundary'] == word, heads[0]


def options():
    """Only options of the tables, and no file outside of the folder of the run."""
    for tool, option, words in (('rc-solve', ['o', 'x'], 'no option --o'), ('rc-pick', ['psd-map', 'x'], 'no option'), ('rc-solve', ['report', 'x'], 'no option'), ('rc-solve', ['checkpoint', 'x'], 'no option'),
                                ('rc-solve', ['load', '1N\n'], 'without a folder'), ('rc-solve', ['counter', '/etc/passwd'], 'without a folder'),
                                ('rc-solve', ['yield', '../a.tsv'], 'without a folder'), ('rc-solve', ['kernel', 'ftt'], 'did you mean'),
                                ('rc-solve', ['load', ['1N']], 'no option'), ('rc-solve', ['load', True], 'needs a value'),
                                ('rc-cost', [], 'not a step'), ('sh', [], 'not understood'), ('rc-render', [], 'not a step')):
        body = json.dumps({'file': SAMPLE, 'start': False, 'steps': [{'tool': tool, 'options': [option] if option else [], 'from': 0}]})
        refused(400, words, 'steps', body=body)
    refused(400, 'not understood', 'steps', body='{')
    refused(400, 'not understood', 'steps', body=json.dumps({'file': 99, 'steps': [], 'start': False}))


def pipeline():
    """From a scan to stresses; the commands that are shown go to a file, to be pasted into a shell."""
    number = start(uploaded('rough-steel.x3p'), ('rc-import', []), ('rc-pick', [['crop', '20,10,130,121']]), ('rc-detrend', LEVEL), ('rc-solve', SOLVE),
                   ('rc-stress', [['nu', '0.28'], ['depths', '0:20um:3'], ['components', 'mises']]))
    run = ended(number)
    assert run['state'] == 'done' and [s['state'] for s in run['steps']] == ['done'] * 5, run
    with open('commands', 'w') as file:
        file.writelines(step['command'] + '\n' for step in run['steps'])
        os.makedirs('shown', exist_ok=True)
        for k, step in enumerate(run['steps']):
            for of in ['output'] + ['report'] * (step['report'] is not None):
                status, _, text = ask('file', {'run': number, 'step': k, 'of': of})
                assert status == 200
                with open(os.path.join('shown', step[of]), 'wb') as out:
                    out.write(text)
        for tool, name, made in (('rc-render', 'pressure.svg', [['channel', 'pressure'], ['case', '2'], ['border', True]]), ('rc-render', 'relief.png', [['channel', 'height'], ['view', '30,40']]),
                                 ('rc-render', 'area.pdf', [['curve', 'load:contact_area']]), ('rc-info', 'numbers.txt', []), ('rc-export', 'p.npy', [['channel', 'pressure'], ['case', '1']]),
                                 ('rc-report', 'report.html', SOLVE)):
            status, headers, text = ask('made', {'run': number, 'step': 3, 'tool': tool, 'options': json.dumps(made), 'name': name})
            assert status == 200, text
            file.write(urllib.parse.unquote(headers['X-Command']) + '\n')
            with open(os.path.join('shown', name), 'wb') as out:
                out.write(text)


def effects():
    """rc-scene judges the effects of the contact that was pressed; its report has sentences and commands."""
    number, known = max(runs()), SOLVE[2:] + [['load', '20N'], ['radius', '3.75mm'], ['mu', '0.3']]
    status, headers, text = ask('made', {'run': number, 'step': 3, 'tool': 'rc-scene', 'options': json.dumps(known), 'name': 'scene.json'})
    assert status == 200, text
    scene = {e['effect']: e for e in json.loads(text)['scene']}
    assert scene['hardness']['sentence'].startswith('calls for it: changes the largest pressure by '), scene['hardness']
    assert scene['hardness']['command'][0] == 'rc-solve' and '--hardness' in scene['hardness']['command']
    assert scene['wear']['sentence'] is None and scene['wear']['missing'] == 'coefficient distance', scene['wear']
    assert urllib.parse.unquote(headers['X-Command']).startswith('rc-scene '), headers['X-Command']


def accuracy():
    """rc-cost gives the bars of the contact that was pressed; the command that is shown makes them again."""
    number = max(runs())
    status, headers, text = ask('made', {'run': number, 'step': 3, 'tool': 'rc-cost', 'options': json.dumps([['noise', '2nm'], ['resolution', True]]), 'name': 'bars.json'})
    assert status == 200, text
    rows = [json.loads(line) for line in text.decode().strip().split('\n')]
    bars = {row['name']: row for row in rows if row['what'] == 'figure' and row['case'] == 1}
    assert bars['contact_area']['bar_relative'] > 0 and bars['contact_area']['unit'] == 'm2', bars
    shown = urllib.parse.unquote(headers['X-Command'])
    assert re.match('rc-cost --noise 2nm --resolution -o /dev/null --report bars.json 3-detrend.rcg -- rc-solve --', shown), shown
    status, _, text = ask('made', {'run': number, 'step': 0, 'tool': 'rc-cost', 'options': json.dumps([['plot', 'a.png']]), 'name': 'a'})
    assert status == 400 and b'no option --plot' in text, text


def frames():
    """The binary values of the frames are those of the stream, and the colours those of rc-render."""
    number = max(runs())
    heads = found('frames', {'run': number, 'step': 3})
    with open('shown/4-solve.rcg', 'rb') as file:
        whole = file.read()
    for k, head in enumerate(heads):
        values = ask('values', {'run': number, 'step': 3, 'frame': k})[2]
        assert len(values) == 8 * int(head['nx']) * int(head['ny']) and values in whole
        assert 'history' not in head and head['unit'] in ('Pa', 'm')
    assert [h['channel'] for h in heads] == 2 * ['pressure', 'gap', 'displacement', 'height']
    picture = ask('colours', {'channel': 'pressure', 'unit': 'Pa', 'low': '0', 'high': '6e9'})[2]
    assert picture[16:24] == b'\0\0\1\1\0\0\0\1', picture[:30]  # 257 x 1 pixels
    first = zlib.decompress(picture[picture.index(b'IDAT') + 4:])[1:4]
    assert first == b'\xea\xea\xea', first  # no contact


def compare():
    """A second scan is read and subtracted, aligned: the volume of a known wear scar; the same command in a shell."""
    import numpy
    import rcg
    whole = rcg.synth('selfaffine', nx=220, dx='1um', hurst=0.8, rms_height='0.5um', rolloff='60um', short_cut='6um', seed=3).height
    x = numpy.arange(160) - 79.5
    scar = numpy.maximum(1.5e-6 - numpy.hypot(x, x[:, None]) ** 2 * 2e-9, 0)
    os.makedirs('scans')
    for name, values in (('new', whole[30:190, 30:190]), ('worn', whole[33:193, 25:185] - scar + 4e-6)):
        rcg.export(rcg.frame('height', values, '1um'), 'scans/%s.x3p' % name)
    new, worn = uploaded('scans/new.x3p'), uploaded('scans/worn.x3p')
    given = [['second', 'worn.x3p'], ['measured', 'after'], ['subtract', True], ['align', True]]
    contact = [['load', '0.1N'], ['body1', 'steel'], ['body2', 'steel']]
    asked = steps(('rc-import', []), ('rc-detrend', LEVEL), ('rc-solve', contact)) + [{'tool': 'rc-add', 'options': given, 'from': 1}]
    run = ended(found('steps', body={'file': new, 'steps': asked, 'start': True})['run'])
    assert run['state'] == 'done', run
    command = run['steps'][3]['command']
    assert command == ('rc-import -o 4-second.rcg worn.x3p && '
                       'rc-add --subtract --align --report 4-add.tsv -o 4-add.rcg 4-second.rcg 1-import.rcg'), command
    assert run['steps'][3]['later'] == 'second' and run['steps'][1]['later'] is None, run
    place = {'run': run['number'], 'step': 3}
    heads, row = [line.split('\t') for line in ask('file', dict(place, of='report'))[2].decode().splitlines()]
    figures = dict(zip((head.split('/')[0] for head in heads), row))
    volume = -scar.sum() * 1e-12
    assert abs(float(figures['volume']) - volume) <= float(figures['volume_error']) < 0.05 * abs(volume), (figures, volume)
    assert abs(abs(float(figures['shift_x'])) - 5e-6) < 5e-8 and abs(abs(float(figures['shift_y'])) - 3e-6) < 5e-8, figures
    subprocess.run('rc-import -o 1-import.rcg new.x3p && ' + command, shell=True, check=True, cwd='scans')
    with open('scans/4-add.rcg', 'rb') as file:
        assert file.read() == ask('file', dict(place, of='stream'))[2]
    assert [head['channel'] for head in found('frames', place)] == ['height']
    # the same change where the second scan is the earlier one; sums keep the first scan first
    asked[3]['options'] = [['second', 'new.x3p'], ['measured', 'before'], ['subtract', True], ['align', True]]
    again = ended(found('steps', body={'file': worn, 'steps': asked, 'start': True})['run'])
    assert again['steps'][3]['command'].endswith(' 1-import.rcg 4-second.rcg') and again['steps'][3]['later'] == 'first', again
    assert ask('file', {'run': again['number'], 'step': 3, 'of': 'report'})[2].decode().splitlines()[1].split('\t')[2:] == row[2:], row
    asked[3]['options'] = [['second', 'worn.x3p']]
    both = found('steps', body={'file': new, 'steps': asked, 'start': False})['commands'][3]
    assert both.endswith(' && rc-add -o 4-add.rcg 1-import.rcg 4-second.rcg'), both
    # spikes of both scans are dropped before
    spiky = [values.copy() for values in (whole[30:190, 30:190], whole[33:193, 25:185] - scar + 4e-6)]
    spiky[0][20:150:16, 17::23] += 9e-6
    spiky[1][30:150:16, 9::19] -= 9e-6
    for name, values in zip(('new2', 'worn2'), spiky):
        rcg.export(rcg.frame('height', values, '1um'), 'scans/%s.x3p' % name)
    uploaded('scans/worn2.x3p')
    asked[3]['options'] = [['second', 'worn2.x3p'], ['spikes', '5'], ['subtract', True], ['align', True]]
    run = ended(found('steps', body={'file': uploaded('scans/new2.x3p'), 'steps': asked, 'start': True})['run'])
    assert run['state'] == 'done', run
    command = run['steps'][3]['command']
    assert command == ('rc-import -o 4-second.rcg worn2.x3p && rc-detrend --spikes 5 -o 4-first-clean.rcg 1-import.rcg && '
                       'rc-detrend --spikes 5 -o 4-second-clean.rcg 4-second.rcg && rc-add --subtract --align '
                       '--report 4-add.tsv -o 4-add.rcg 4-second-clean.rcg 4-first-clean.rcg'), command
    place = {'run': run['number'], 'step': 3}
    heads, row = [line.split('\t') for line in ask('file', dict(place, of='report'))[2].decode().splitlines()]
    cleaned = dict(zip((head.split('/')[0] for head in heads), row))
    subprocess.run('rc-import -o 1-import.rcg new2.x3p && ' + command, shell=True, check=True, cwd='scans')
    with open('scans/4-add.rcg', 'rb') as file:
        changed = file.read()
        assert changed == ask('file', dict(place, of='stream'))[2]
    change = rcg.read('scans/4-add.rcg')[0].values
    assert numpy.nanmax(abs(change)) < 5e-6, numpy.nanmax(abs(change))  # of spikes of 9e-6 m
    assert numpy.isnan(change).sum() > 100 and float(cleaned['missing']) > 0.001, cleaned  # the nodes of spikes
    assert abs(float(cleaned['volume']) - volume) <= float(cleaned['volume_error']) < 0.05 * abs(volume), (cleaned, volume)
    # without alignment there is no report; a stream is read as it is; a run takes its results again
    with open('scans/1-import.rcg', 'rb') as file:
        stream = found('upload', {'name': 'first.rcg'}, file.read())['name']
    asked[3]['options'] = [['second', stream], ['subtract', True]]
    run = ended(found('steps', body={'file': worn, 'steps': asked, 'start': True})['run'])
    assert run['steps'][3]['command'] == 'rc-add --subtract -o 4-add.rcg first.rcg 1-import.rcg' and run['state'] == 'done', run
    for wrong, words in (([['second', stream], ['measured', 'later']], '--measured'), ([['subtract', True]], 'choose the second scan'), ([['second', 'none.x3p']], '--second none.x3p: this file is not on this page'),
                         ([['second', '../new.x3p']], 'this file is not on this page'), ([['second', True]], 'this file is not on this page')):
        asked[3]['options'] = wrong
        refused(400, words, 'steps', body=json.dumps({'file': worn, 'steps': asked, 'start': False}))
    with open('note.doc', 'rb') as file:
        note = found('upload', {'name': 'note.doc'}, file.read())['name']
    asked[3]['options'] = [['second', note], ['subtract', True]]
    run = ended(found('steps', body={'file': worn, 'steps': asked, 'start': True})['run'])
    assert run['state'] == 'failed' and 'not recognised' in run['steps'][3]['words'], run


def again():
    """A run takes the results of an equal beginning; a run that has ended can be removed, the others stay."""
    first = max(runs())
    last = ended(start(runs() and found('desk')['files'][-1]['id'], ('rc-import', []), ('rc-pick', [['crop', '20,10,130,121']]), ('rc-detrend', LEVEL), ('rc-solve', [['load', '1N'], ['estar', '114GPa']])))
    old = runs()[first]['steps']
    assert [s['seconds'] for s in last['steps'][:3]] == [s['seconds'] for s in old[:3]] and last['steps'][3]['command'] != old[3]['command']
    number = ended(start(SAMPLE, ('rc-import', [])))['number']
    found('remove', {'run': number - 1}, b'')
    refused(404, 'was removed', 'frames', {'run': number - 1, 'step': 0})
    curve = {'options': json.dumps([['curve', 'load:contact_area']]), 'tool': 'rc-render', 'name': 'a.png'}
    refused(422, 'writes no report', 'made', dict(curve, run=number, step=0))
    assert found('frames', {'run': first, 'step': 0}) and found('frames', {'run': number, 'step': 0})


def cancel():
    """Two runs at once, a third waits; cancelled, their tools end."""
    three = [start(SAMPLE, ('rc-import', []), ('rc-detrend', LEVEL), ('rc-solve', LONG + [['threads', '1']])) for _ in range(3)]
    for number in three[:2]:
        until(number, 'running')
    comes(lambda: len(tools_running()) == 2 and any(s['doing'] for s in runs()[three[0]]['steps']))
    assert len(tools_running()) == 2 and runs()[three[2]]['state'] == 'waiting', (tools_running(), runs())
    assert runs()[three[0]]['steps'][2]['progress'] is not None or runs()[three[0]]['steps'][2]['doing']
    began = time.monotonic()
    for number in reversed(three):
        found('remove', {'run': number}, b'')
    for number in three:
        run = ended(number)
        assert run['state'] == 'stopped', run
    assert not tools_running() and time.monotonic() - began < 5
    assert ended(start(SAMPLE, ('rc-import', [])))['state'] == 'done'


def closed():
    """Without a page the tools end; the page that watches was closed."""
    number = start(SAMPLE, ('rc-import', []), ('rc-detrend', LEVEL), ('rc-solve', LONG))
    comes(tools_running)
    os.kill(int(os.environ['WATCH']), 15)
    comes(lambda: not tools_running())
    assert runs()[number]['state'] == 'stopped'


def pages():
    """The fifth page is refused: a browser has six connections."""
    links = []
    for _ in range(3):  # and the page that watches
        link = http.client.HTTPConnection(ADDRESS.hostname, ADDRESS.port, timeout=10)
        link.request('GET', '/%s/events' % TOKEN)
        links.append((link, link.getresponse()))
        assert links[-1][1].status == 200
    refused(429, '4 pages are open', 'events')


def watch():
    """An open page."""
    link = http.client.HTTPConnection(ADDRESS.hostname, ADDRESS.port)
    link.request('GET', '/%s/events' % TOKEN)
    answer = link.getresponse()
    print('watches', flush=True)
    while answer.fp.readline():
        pass


def first(opened):
    """The browser gets a private file that leads to the page and is removed then; no command line holds the address."""
    file = urllib.request.url2pathname(urllib.parse.urlsplit(opened).path)
    assert opened.startswith('file:///') and os.path.dirname(os.path.dirname(file)) == os.environ['TMPDIR'], opened
    assert os.stat(file).st_mode & 0o777 == 0o600 and os.stat(os.path.dirname(file)).st_mode & 0o777 == 0o700
    with open(file) as page, open('cmdlines', 'rb') as seen:
        text, lines = page.read(), seen.read()
    assert 'http-equiv="refresh" content="0; url=%s"' % sys.argv[1] in text, text
    assert opened.encode() in lines, 'the list of processes has the browser'
    assert TOKEN.encode() not in lines and b'127.0.0.1:%d/' % ADDRESS.port not in lines, lines
    refused(403, 'token of this session', None, path='/x/')
    assert os.path.exists(file)
    assert ask('')[0] == 200 and not os.path.exists(file)


def same_names():
    """Files of one name are different files, for runs, results and options."""
    def surface(seed, like=None):
        subprocess.run(['rc-synth', 'selfaffine', '--nx', '16', '--dx', '1um', '--rms-height', '1um', '--hurst', '0.8', '--seed', seed, '-o', 'same.rcg'], check=True)
        with open('same.rcg', 'rb') as file:
            whole = file.read()
        return uploaded('same.rcg'), whole

    (one, first_), (two, second), (three, third) = surface('1'), surface('2'), surface('1')
    assert first_ == third != second
    turned = []
    for file, whole in ((one, first_), (two, second), (one, first_)):
        run = ended(start(file, ('rc-pick', [['mirror', 'x']])))
        assert run['state'] == 'done' and run['file'] == file, run
        turned.append(ask('file', {'run': run['number'], 'step': 0, 'of': 'stream'})[2])
        assert turned[-1] == subprocess.run(['rc-pick', '--mirror', 'x', '-'], input=whole, stdout=subprocess.PIPE, check=True).stdout
    assert turned[0] == turned[2] != turned[1]
    wear = [['coefficient', '1e-6mm3/Nm'], ['distance', '1m'], ['motion', 'sliding'], ['counter', 'same.rcg']]
    for start_it in (False, True):
        body = json.dumps({'file': two, 'start': start_it, 'steps': steps(('rc-wear', wear))})
        refused(400, '--counter same.rcg: 3 files on this page have this name', 'steps', body=body)


def kept(name, text):
    """A run does not write to a file of the command line, whatever its name is."""
    file = found('desk')['files'][-1]
    assert file['shown'] == os.path.realpath(name) and file['name'] == '_' + name, file
    run = ended(start(file['id'], ('rc-pick', [['crop', '0,0,9,9']])))
    assert run['state'] == 'done', run
    with open(name, 'rb') as now, open(text, 'rb') as before:
        assert now.read() == before.read()


def has(name):
    assert found('desk')['files'][-1]['shown'] == os.path.realpath(name)


def quit():
    assert found('quit', body=b'') == {}


globals()[sys.argv[2]](*sys.argv[3:])
