# SPDX-License-Identifier: GPL-3.0-or-later
"""rc-app: a page in the browser that runs the rc-* tools on this machine.

The page is served on 127.0.0.1 alone, below a path with a secret token. A run is a list of commands. It has a
folder of its own, where the tools run with the arguments that the page shows. rc-app(1) describes the limits.
"""
import argparse
import contextlib
import filecmp
import functools
import hmac
import http.server
import json
import mimetypes
import os
import pathlib
import re
import secrets
import select
import shlex
import shutil
import signal
import sys
import tempfile
import threading
import time
import urllib.parse
import webbrowser

import numpy

from . import __version__, stream, tools

UPLOAD_MAX = 2 << 30  # bytes of a file
PAGES_MAX = 4         # open pages: each holds a connection, and browsers allow six
TOGETHER = 2          # runs at the same time
GRACE = 3             # seconds without a page and its requests, as while it reloads, after which its tools end
IDLE = 600            # seconds without them, after which the program ends
LOOK = 0.5            # seconds from one look for pages to the next
PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'page')
ASSETS = ('', 'page.css', 'page.js', 'map.js')
HEADERS = {'Cache-Control': 'no-store', 'X-Content-Type-Options': 'nosniff', 'Referrer-Policy': 'no-referrer',
           'Cross-Origin-Resource-Policy': 'same-origin', 'Content-Security-Policy':
           "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
           "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"}
# Options that the page sets itself, that write further files, or whose files a later run would continue.
HIDDEN = tools.HIDDEN | {'checkpoint', 'resume', 'interval', 'keep-going', 'psd-map', 'plot'}
STEPS = ('rc-import', 'rc-add')  # beside the tools that read and write streams
SECOND = {'name': 'second', 'argument': 'FILE', 'result': True,
          'help': 'the scan to compare with, a file on this page, read with the options of the first step'}
SPIKES = {'name': 'spikes', 'argument': 'T', 'result': True,
          'help': 'first drop spikes of both scans that stand alone by T deviations, with rc-detrend --spikes'}
WHEN = {'name': 'measured', 'argument': 'WHEN', 'result': True, 'type': 'choice', 'only_words': True,
        'words': ['after', 'before'],
        'help': 'whether the second scan is from after or before the first one; the change is the later one less the '
                'earlier one'}
MAKERS = ('rc-render', 'rc-info', 'rc-export', 'rc-report', 'rc-scene', 'rc-cost')
OF_SURFACE = ('rc-report', 'rc-scene', 'rc-cost')  # about the surface that is pressed
REPORTS = ('rc-scene', 'rc-cost')  # their report is the result
ACTIVE, ENDED_WELL = ('waiting', 'running'), ('done', 'short')


class Refused(Exception):
    """A request that is refused: one sentence and the HTTP status."""

    def __init__(self, text, status=400):
        super().__init__(text)
        self.status = status


# ---- command lines ----

@functools.lru_cache()
def tables():
    """The tools that the page runs, with the options that it may set; an installation may lack rc-leak."""
    found = {}
    for name in sorted(tools.FUNCTIONS.values()):
        try:
            row = tools.table(name)
        except stream.Error:
            continue
        step = name in STEPS or (row['reads'] == 'stream' and row['writes'] == 'stream')
        if step or name in MAKERS:
            options = [o for o in row['options'] if o['name'] not in HIDDEN and o['type'] != 'report']
            report = any(o['name'] == 'report' for o in row['options'])
            if name == 'rc-add':  # its operand B
                plain = {key: type(value)() for key, value in options[0].items()}
                options[:0] = [dict(plain, **row) for row in (SECOND, WHEN, SPIKES)]
            found[name] = dict(row, options=options, step=step, report=step and report)
    return found


def file_called(option, text, files):
    """The file of this name, or None; files of one name must be equal."""
    called = [file for file in files if file['name'] == text]
    if not all(filecmp.cmp(called[0]['path'], file['path'], shallow=False) for file in called[1:]):
        raise Refused('--%s %s: %d files on this page have this name: give the right one another name, and drop it again'
                      % (option, text, len(called)))
    return called[0] if called else None


def words_of(tool, options, files):
    """The arguments of [[name, value], ...]; the name of a file stays in the folder of the run, and only one has it."""
    rows, words = {row['name']: row for row in tables()[tool]['options']}, []
    for name, value in options:
        text = value if isinstance(value, str) else ''
        if name not in rows or not (text or value is True):
            raise Refused('%s has no option --%s on this page' % (tool, name))
        if re.search('[\0-\x1f]', text) or ('/' in text and 'FILE' in (rows[name]['argument'] or '')):
            raise Refused('--%s %s: give the name of a file on this page, without a folder' % (name, text))
        file_called(name, text, files)
        try:
            words += tools._arguments(rows[name], '--' + name, value)
        except (TypeError, ValueError) as e:
            raise Refused('%s: %s' % (tool, e))
    return words


def safe_name(name):
    """The base name of a file that the browser names: no folders, control characters or names of steps."""
    name = re.sub('[\0-\x1f\x7f-\x9f\ud800-\udfff]', '_', re.split(r'[/\\]', name)[-1])
    name = name.encode()[-200:].decode(errors='ignore')
    return '_' + name if name in ('', '.', '..') or re.match(r'\d+-[a-z]+\.(rcg|tsv)$', name) else name


def sample():
    """The sample surface of the package; None where it is not installed."""
    with contextlib.suppress(FileNotFoundError):
        return os.path.realpath(tools.sample())


class Step:
    """A command of a run; it is waiting, running, done, short (of the accuracy), failed or stopped."""

    def __init__(self, tool, options, number, source, files, reading=()):
        """`reading`: the options with which the first file is read, which holds for a second one too."""
        if not tables()[tool]['step']:
            raise Refused('%s is not a step of this page' % tool)
        stem = '%d-%s' % (number, tool[3:])
        self.tool, self.output = tool, stem + '.rcg'
        sources, self.before = [source], []  # before: the commands that prepare the scans of a comparison
        self.later = None  # the scan from which the other one is subtracted, 'first' or 'second'
        if tool == 'rc-add':
            second, spikes = self.second(options, files), [option for option in options if option[0] == 'spikes']
            words_of(tool, [option for option in options if option[0] == 'measured'], files)
            if ['subtract', True] in options:
                self.later = 'first' if ['measured', 'before'] in options else 'second'
            options = [option for option in options if option[0] not in ('second', 'measured', 'spikes')]
            read = '%d-second.rcg' % number
            sources.append(second['shown'] if second['stream'] else read)
            if not second['stream']:
                self.before.append(['rc-import'] + words_of('rc-import', reading, files) + ['-o', read, second['shown']])
            for k, name in enumerate(('first', 'second') if spikes else ()):
                clean = '%d-%s-clean.rcg' % (number, name)
                self.before.append(['rc-detrend'] + words_of('rc-detrend', spikes, files) + ['-o', clean, sources[k]])
                sources[k] = clean
            if self.later == 'second':
                sources.reverse()
        reports = tables()[tool]['report'] and (tool != 'rc-add' or any(name == 'align' for name, _ in options))
        self.report = stem + '.tsv' if reports else None
        report = ['--report', self.report] if self.report else []
        self.own = [tool] + words_of(tool, options, files)
        self.command = self.own + report + ['-o', self.output] + sources
        self.state, self.words, self.progress, self.doing, self.seconds = 'waiting', '', None, '', None


    @staticmethod
    def second(options, files):
        """The second scan of rc-add."""
        name = next((value for name, value in options if name == 'second'), None)
        file = file_called('second', name, files)
        if file is None:
            raise Refused('choose the second scan' if name is None else '--second %s: this file is not on this page' % name)
        return file

    def text(self):
        return ' && '.join(shlex.join(words) for words in self.before + [self.command])


def steps_of(file, asked, files):
    """The steps [{tool, options, from}, ...] on one of the files; `from` is the number of the step that is read."""
    made, reading = [], asked[0]['options'] if asked and asked[0]['tool'] == 'rc-import' else ()
    for number, step in enumerate(asked, 1):
        source = file['shown'] if number == 1 else made[step['from'] - 1].output
        made.append(Step(step['tool'], step['options'], number, source, files, reading))
    return made


def frames_of(path):
    """The headers of a stream that a tool wrote, each with the place and the size of its values."""
    found = []
    with open(path, 'rb') as file:
        while file.readline() == b'RCG1\n':
            keys, _ = stream._head(file)
            size = int(keys['nx']) * int(keys['ny']) * stream.TYPES[keys['type']].itemsize
            found.append((keys, file.tell(), size))
            file.seek(size + len('crc32 01234567\n'), os.SEEK_CUR)
    return found


# ---- runs ----

class Run:
    """Commands on one file, one after another, in a folder."""

    def __init__(self, desk, number, file, steps):
        self.desk, self.number, self.file, self.steps = desk, number, file, steps
        self.folder, self.state, self.child = tempfile.mkdtemp(dir=desk.folder), 'waiting', None
        self.cancelled = threading.Event()
        for name, path in {other['name']: other['path'] for other in desk.files + [file]}.items():  # its own comes last
            os.symlink(path, os.path.join(self.folder, name))
        threading.Thread(target=self.work, daemon=True).start()

    def work(self):
        """Runs the steps when there is room for them."""
        while not self.desk.room.acquire(timeout=0.2):
            if self.cancelled.is_set():
                self.state = 'stopped'
                return
        self.state = 'running'
        try:
            for at, step in enumerate(self.steps):
                if not self.reuse(at):
                    self.execute(step)
                if step.state not in ENDED_WELL:
                    break
        finally:
            self.desk.room.release()
            self.state = step.state

    def reuse(self, at):
        """Takes the files of an earlier run of the same commands on the same file."""
        commands = [step.text() for step in self.steps[:at + 1]]
        for old in list(self.desk.runs.values()):
            same = old.file is self.file and [step.text() for step in old.steps[:at + 1]] == commands
            if same and old.steps[at].state in ENDED_WELL:
                vars(self.steps[at]).update(vars(old.steps[at]))
                for name in filter(None, (old.steps[at].output, old.steps[at].report)):
                    os.link(os.path.join(old.folder, name), os.path.join(self.folder, name))
                return True
        return False

    def execute(self, step):
        def started(child):
            self.child = child
            if self.cancelled.is_set():  # before the line above
                child.terminate()

        def progress(said):
            step.progress, step.doing = said['progress'], said['text']

        began, step.state, status, step.words = time.monotonic(), 'running', 0, ''
        for command in step.before + [step.command]:
            status, words = self.desk.execute(command, self.folder, started, progress)
            step.words += words
            if status not in (0, 3):
                break
        step.seconds = time.monotonic() - began
        stopped = self.cancelled.is_set() and status != 0
        step.state = 'stopped' if stopped else {0: 'done', 3: 'short'}.get(status, 'failed')

    def cancel(self):
        self.cancelled.set()
        if self.child is not None:
            self.child.terminate()  # the tool removes its files

    def shown(self):
        steps = [dict(vars(step), command=step.text()) for step in self.steps]
        return {'number': self.number, 'file': self.file['id'], 'state': self.state, 'steps': steps}


class Desk(http.server.ThreadingHTTPServer):
    """The server, and what all of its pages share: files, runs, and the tools that run."""
    daemon_threads = True

    def __init__(self, port, folder, file):
        super().__init__(('127.0.0.1', port), Request)
        self.folder, self.files, self.runs, self.children = folder, [], {}, set()
        self.room = threading.BoundedSemaphore(TOGETHER)
        self.token, self.opener = secrets.token_urlsafe(24), os.path.join(folder, 'open.html')
        self.ended, self.counting = threading.Event(), threading.Lock()
        self.pages, self.away = 0, 0.0  # away: seconds without a page and its requests
        self.first = [path and self.add_file(path, path)['id'] for path in (sample(), file)]

    def address(self):
        return 'http://127.0.0.1:%d/%s/' % (self.server_port, self.token)

    def open_browser(self):
        """Starts the browser with a private file that leads to the page: other users see the arguments of processes."""
        with open(os.open(self.opener, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), 'w') as file:
            file.write('<!DOCTYPE html><meta charset="utf-8"><title>rc-app</title><meta http-equiv="refresh" content="0; url=%s">\n'
                       % self.address())
        threading.Thread(target=webbrowser.open, args=(pathlib.Path(self.opener).as_uri(),), daemon=True).start()

    def handle_error(self, request, client_address):
        pass  # a browser that has gone

    def add_file(self, path, shown):
        """A file that steps can read: `shown` is its name in commands."""
        with open(path, 'rb') as file:
            is_stream = file.read(4) == b'RCG1'
        shown = './' + shown if shown.startswith('-') else shown
        self.files.append({'name': safe_name(os.path.basename(path)), 'path': path, 'shown': shown, 'stream': is_stream,
                           'size': os.path.getsize(path), 'id': len(self.files)})
        return self.files[-1]

    def execute(self, command, folder, started=lambda child: None, progress=lambda said: None):
        """Runs a command in a folder: its exit status and its messages."""
        def known(child):
            self.children.add(child)
            started(child)

        status, _, words = tools.execute(command, progress=progress, folder=folder, started=known)
        self.children = {child for child in self.children if child.poll() is None}
        return status, words

    def end_tools(self):
        for run in list(self.runs.values()):
            run.cancel()
        for child in list(self.children):
            child.terminate()

    def watch(self):
        """A look for pages: ends the tools when no page is open; False when none has been open for long.

        A look counts as LOOK seconds, however long it took: a machine that is too busy for this program, or
        suspended, is so for the page too, which then needs longer to connect.
        """
        with self.counting:
            self.away = 0 if self.pages > 0 else self.away + LOOK
        if self.away > GRACE:
            self.end_tools()
        return self.away < IDLE

    def seen(self, pages=0):
        """A page has sent a request, or this many more are open; a page sends some before its connection counts."""
        with self.counting:
            self.pages, self.away = self.pages + pages, 0


# ---- requests ----

class Request(http.server.BaseHTTPRequestHandler):
    """What get_NAME and post_NAME return is sent as JSON; None: they have sent their answer."""
    protocol_version, server_version, sys_version, timeout = 'HTTP/1.1', 'rc-app', '', 60

    def log_message(self, *words):
        pass

    def answer(self, verb):
        try:
            if not self.allowed():
                raise Refused('open the address that rc-app printed: it holds the token of this session', 403)
            self.server.seen()
            if verb == 'get_' and self.at in ASSETS:
                with contextlib.suppress(FileNotFoundError):
                    os.remove(self.server.opener)  # it has led here
                return self.send_file(os.path.join(PAGE, self.at or 'index.html'))
            act = getattr(self, verb + self.at, None)
            if act is None:
                raise Refused('rc-app: /%s does not exist' % self.at[:80], 404)
            found = act()
            if found is not None:
                self.send(json.dumps(found).encode(), 'application/json')
        except Refused as e:
            self.refuse(e.status, str(e))
        except (ConnectionError, TimeoutError):
            self.close_connection = True
        except OSError as e:
            self.refuse(507, 'rc-app: %s' % e.strerror)
        except Exception as e:  # the request has missing or wrong parts
            self.refuse(400, 'rc-app: this request is not understood: %s %s' % (type(e).__name__, e))

    do_GET = functools.partialmethod(answer, 'get_')
    do_POST = functools.partialmethod(answer, 'post_')

    def allowed(self):
        """True for a request of the page: to a name of this machine, from no other page, with the token."""
        own = ['%s:%d' % (name, self.server.server_port) for name in ('127.0.0.1', 'localhost')]
        url = urllib.parse.urlsplit(self.path)
        first, _, self.at = url.path.lstrip('/').partition('/')
        self.query = dict(urllib.parse.parse_qsl(url.query, keep_blank_values=True))
        origin = self.headers.get('Origin')
        if self.headers.get('Host') not in own or origin not in [None] + ['http://' + name for name in own]:
            return False
        return hmac.compare_digest(first.encode(), self.server.token.encode())

    def head(self, status, kind, size, **more):
        self.send_response(status)
        for name, value in dict(HEADERS, Content_Type=kind, Content_Length=size, **more).items():
            if value is not None:
                self.send_header(name.replace('_', '-'), str(value))
        self.end_headers()

    def send(self, body, kind, status=200, **more):
        self.head(status, kind, len(body), **more)
        self.wfile.write(body)

    def send_file(self, path, at=0, size=None, **more):
        kind = mimetypes.guess_type(path)[0] or 'application/octet-stream'
        with open(path, 'rb') as file:
            size = os.path.getsize(path) if size is None else size
            self.head(200, kind + '; charset=utf-8' * kind.startswith('text/'), size, **more)
            if size > 0:
                self.connection.sendfile(file, at, size)

    def refuse(self, status, text):
        self.close_connection = True  # a body may be left
        self.send(text.encode(), 'text/plain; charset=utf-8', status, Connection='close')

    def length(self, most):
        text = self.headers.get('Content-Length', '')
        if not re.match(r'[0-9]{1,15}\Z', text):
            raise Refused('rc-app: the request has no length', 411)
        if int(text) > most:
            raise Refused('the file has %.1f GB, the page takes at most %g GB: use rc-import in a shell'
                          % (int(text) / 2**30, most / 2**30), 413)
        return int(text)

    def run(self):
        runs, number = self.server.runs, int(self.query['run'])
        if number not in runs:
            raise Refused('run %d was removed' % number, 404)
        return runs[number]

    def output(self):
        """The run and step of a request, and the path of the stream that the step wrote."""
        run = self.run()
        step = run.steps[int(self.query['step'])]
        return run, step, os.path.join(run.folder, step.output)

    # ---- the page ----

    def get_desk(self):
        desk = self.server
        return {'files': desk.files, 'first': desk.first, 'tables': tables(), 'most': UPLOAD_MAX}

    def get_events(self):
        """Sends the runs when they change, until the page is closed."""
        desk, said = self.server, None
        with desk.counting:  # before the answer, or two pages could take the last place
            if desk.pages >= PAGES_MAX:
                raise Refused('%d pages are open: close one of them, then load this page again' % PAGES_MAX, 429)
            desk.pages += 1
        try:
            self.close_connection = True
            self.head(200, 'text/event-stream', None, Connection='close')
            while not desk.ended.is_set() and not select.select([self.connection], [], [], 0.1)[0]:
                state = json.dumps([run.shown() for run in list(desk.runs.values())])
                if state != said:
                    self.wfile.write(b'data: %s\n\n' % state.encode())
                    said = state
        finally:
            desk.seen(-1)

    def post_upload(self):
        desk, size = self.server, self.length(UPLOAD_MAX)
        if size > shutil.disk_usage(desk.folder).free // 2:
            raise Refused('the file needs over half of the free space of %s: set TMPDIR' % desk.folder, 507)
        path = os.path.join(tempfile.mkdtemp(dir=desk.folder), safe_name(self.query['name']))
        with open(path, 'wb') as file:
            while size > 0:
                part = self.rfile.read(min(size, 1 << 20))
                if not part:
                    raise ConnectionError  # the page has gone
                file.write(part)
                size -= len(part)
        return desk.add_file(path, os.path.basename(path))

    def post_steps(self):
        """The commands of steps on a file; with `start` they run."""
        asked, desk = json.loads(self.rfile.read(self.length(1 << 20))), self.server
        file = desk.files[asked['file']]
        made = steps_of(file, asked['steps'], desk.files)
        number = max(desk.runs, default=0) + 1 if asked['start'] and made else None
        if number is not None:
            desk.runs[number] = Run(desk, number, file, made)
        return {'commands': [step.text() for step in made], 'run': number}

    def post_remove(self):
        """Cancels a run, or removes one that has ended."""
        run = self.run()
        if run.state in ACTIVE:
            run.cancel()
        else:
            del self.server.runs[run.number]
            shutil.rmtree(run.folder, ignore_errors=True)
        return {}

    def post_quit(self):
        self.server.ended.set()
        return {}

    # ---- results ----

    def get_frames(self):
        return [{k: v for k, v in keys.items() if k != 'history' and not k.startswith('file.')}
                for keys, _, _ in frames_of(self.output()[2])]

    def get_values(self):
        path = self.output()[2]
        self.send_file(path, *frames_of(path)[int(self.query['frame'])][1:])

    def get_colours(self):
        """A PNG of 257 pixels: the colours in which rc-render shows 256 even values and a missing one."""
        low, high, channel, unit = (self.query[name] for name in ('low', 'high', 'channel', 'unit'))
        values = numpy.append(numpy.linspace(float(low), float(high), 256), numpy.nan)
        ramp = stream.frame(channel, values, dx=1.0, unit=unit)
        self.send(bytes(tools.draw([ramp], raw=True, quiet=True)), 'image/png')

    def get_made(self):
        """What a tool makes of a step, of rc-scene and rc-cost the report; the command is in a header."""
        (run, step, _), tool, options = self.output(), self.query['tool'], json.loads(self.query['options'])
        if tool not in MAKERS:
            raise Refused('%s makes no file here' % tool)
        source = step.report if any(name == 'curve' for name, _ in options) else step.output
        if source is None:
            raise Refused('%s writes no report, so it has no curves: choose another result' % step.tool, 422)
        contact = next((s for s in run.steps if s.tool == 'rc-solve'), None)
        if tool == 'rc-cost' and contact is None:
            raise Refused('rc-cost studies a contact, and this run has none', 422)
        if tool in OF_SURFACE and contact is not None:
            source = contact.command[-1]
        study = ['--'] + contact.own if tool == 'rc-cost' else []
        words, name = [tool] + words_of(tool, options, self.server.files), safe_name(self.query['name'])
        words += ['-o', os.devnull, '--report'] if tool in REPORTS else ['-o']
        with tempfile.TemporaryDirectory(dir=self.server.folder) as folder:
            status, said = self.server.execute(words + [os.path.join(folder, name), source] + study, run.folder)
            if status not in (0, 3):
                raise Refused(said or '%s ended with status %d' % (tool, status), 422)
            command, said = urllib.parse.quote(shlex.join(words + [name, source] + study)), urllib.parse.quote(said)
            self.send_file(os.path.join(folder, name), X_Command=command, X_Words=said,
                           Content_Disposition='attachment')

    def get_file(self):
        run, step, path = self.output()
        path = os.path.join(run.folder, step.report) if self.query['of'] == 'report' else path
        self.send_file(path, Content_Disposition='attachment')


# ---- the program ----

def serve(desk, opens):
    """Serves until Ctrl-C, a signal, Quit on the page, or no page is open."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: desk.ended.set())
    threading.Thread(target=desk.serve_forever, daemon=True).start()
    print(desk.address(), flush=True)
    if opens and (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        desk.open_browser()
    while not desk.ended.wait(LOOK) and desk.watch():
        pass
    desk.ended.set()
    desk.shutdown()
    desk.end_tools()
    for child in list(desk.children):
        child.wait()


def main(arguments=None):
    about = 'Opens a page in the browser that runs the rc-* tools on this machine.'
    parser = argparse.ArgumentParser(prog='rc-app', epilog='The manual is rc-app(1).', description=about)
    add = parser.add_argument
    add('file', metavar='FILE', nargs='?', help='a surface to begin with: a file or a grid stream')
    add('--port', metavar='N', type=int, default=0, help='port on 127.0.0.1 (default: a free one)')
    add('--no-browser', action='store_true', help='only print the address')
    add('--version', action='version', version='rc-app (libcontact) ' + __version__)
    given = parser.parse_args(arguments)
    folder, what = tempfile.mkdtemp(prefix='rc-app-'), given.file
    try:
        tools.table('rc-solve')
        if what is not None:
            open(what, 'rb').close()
        what = '--port %d' % given.port
        serve(Desk(given.port, folder, given.file and os.path.realpath(given.file)), not given.no_browser)
    except stream.Error as e:
        return 'rc-app: %s' % e
    except (OSError, OverflowError) as e:
        return 'rc-app: %s: %s' % (what, getattr(e, 'strerror', None) or e)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == '__main__':
    sys.exit(main())
