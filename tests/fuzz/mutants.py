# SPDX-License-Identifier: GPL-3.0-or-later
"""mutants.py [OPTIONS] [SUBJECT...]: checkpoints and tables with false contents, each given to its tool.

    mutants.py --count 4000                      4000 mutants of every kind of file, with the tools on PATH
    mutants.py --bin build-sanitize/tools ...    with the sanitizers
    mutants.py --list                            the subjects
    mutants.py --only 17 checkpoint-wear         mutant 17 again; with --keep it is written to a folder

A kind is a table, or the checkpoint of a tool; a subject is a kind in one mode of the tool. The subjects of a
kind share its mutants. The seeds are files that the tools write, or small tables. A mutant of a checkpoint has right checksums: its frames, headers, numbers and maps change. A state on
the way (--interval) is as good a seed as one at the end of a case.

The tool must read the file or refuse it: exit status 0, 3 (not converged), or 1 and 2 with a message. Findings
are signals, reports of a sanitizer, other statuses, refusals without a message, and more than --limit seconds
of the processor. Prints a line for each subject and exits with 1 if there is a finding.
"""
import argparse
import os
import random
import resource
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

# ---- streams ----


class Frame:
    def __init__(self, keys, values):
        self.keys, self.values = keys, values  # [[name, text]], bytes

    def get(self, name):
        return next((text for key, text in self.keys if key == name), None)

    def put(self, name, text):
        self.keys = [k for k in self.keys if k[0] != name] + [[name, text]]

    def copy(self):
        return Frame([list(k) for k in self.keys], self.values)

    def bytes(self):
        head = 'RCG1\n' + ''.join('%s=%s\n' % tuple(k) for k in self.keys) + '\n'
        whole = head.encode('utf-8', 'surrogateescape') + self.values
        return whole + b'crc32 %08x\nRCGEND 1\n' % zlib.crc32(whole)


def frames_of(data):
    frames, at = [], 0
    while data[at:at + 5] == b'RCG1\n':
        end = data.index(b'\n\n', at)
        lines = data[at + 5:end].decode().split('\n')
        frame = Frame([list(line.partition('=')[::2]) for line in lines], b'')
        size = 8 * int(frame.get('nx')) * int(frame.get('ny'))
        frame.values = data[end + 2:end + 2 + size]
        at = data.index(b'\n', end + 2 + size) + 1
        at += 9 * (data[at:at + 9] == b'RCGEND 1\n')
        frames.append(frame)
    return frames


def states_of(frames):
    """Each state of a checkpoint as the list of the frames that a run would resume from."""
    done, state, states = {}, [], []
    for frame in frames:
        state.append(frame)
        if frame.get('checkpoint.numbers') is None:
            continue
        case = frame.get('checkpoint.case')
        done.pop(case, None)
        states.append([f for earlier in done.values() for f in earlier] + state)
        done[case], state = state, []
    return states


# ---- mutations ----

NUMBERS = ['0', '1', '-1', '2', '3', '0.5', 'nan', '-nan', 'inf', '-inf', '1e308', '-1e308', '1e-308', '5e-324', '1e999', '1e30', '-1e30',
           '1e15', '9007199254740993', '18446744073709551615', '18446744073709551616', '4503599627370496', '2147483647', '2147483648',
           '-2147483649', '255', '256', '1024', '4096', '65536', '1e9', '1e-30', '-0', '0x10', '1.5', '100', '7']


def changed_number(draw, text):
    try:
        value = float(text)
    except ValueError:
        value = 1.0
    kind = draw.randrange(6)
    if kind < 3:
        return draw.choice(NUMBERS)
    if kind == 3:
        return repr(value + draw.choice([-2, -1, 1, 2]))
    if kind == 4:
        return repr(value * draw.choice([-1, 2, 0.5, 1e3, 1e-3, 1e20, 1 + 1e-9]))
    return text + draw.choice(['1', '.', 'e', ' ', 'x', '\t1', '0' * 300])


def changed_map(draw, values):
    n = len(values) // 8
    v = list(struct.unpack('<%dd' % n, values[:8 * n]))
    some = range(n) if draw.random() < 0.3 else [draw.randrange(n) if draw.random() < 0.5 else draw.randrange(min(n, 64))
                                                 for _ in range(draw.choice([1, 1, 2, 5]))] if n else []
    kind, factor, number = draw.randrange(3), draw.choice([-1, 0, 2, 1e6, 1e-6, 1e200]), float(draw.choice(NUMBERS[:33]))
    for k in some:
        v[k] = (number, v[k] * factor, v[k] + draw.choice([-1, 1]))[kind]
    return struct.pack('<%dd' % n, *v)


def fitted(draw, frame):
    """The values fit the size in the header, as long as it is small."""
    try:
        size = 8 * int(frame.get('nx')) * int(frame.get('ny'))
    except (TypeError, ValueError):
        return
    if 0 <= size < 1 << 20 and draw.random() < 0.9:
        frame.values = (frame.values + bytes(size))[:size]


def mutate_frames(draw, frames):
    frames = [f.copy() for f in frames]
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        if not frames:
            break
        k = len(frames) - 1 if draw.random() < 0.5 else draw.randrange(len(frames))
        frame, kind = frames[k], draw.randrange(100)
        numbers = (frame.get('checkpoint.numbers') or '').split(' ')
        if kind < 45 and len(numbers) > 1:
            at = draw.randrange(len(numbers)) if draw.random() < 0.7 else draw.randrange(min(len(numbers), 48))
            action = draw.randrange(10)
            if action == 0:
                del numbers[at]
            elif action == 1:
                numbers.insert(at, draw.choice(NUMBERS))
            elif action == 2:
                del numbers[at:at + draw.randrange(40)]
            else:
                numbers[at] = changed_number(draw, numbers[at])
            frame.put('checkpoint.numbers', ' '.join(numbers))
        elif kind < 75:
            frame.values = changed_map(draw, frame.values)
        elif kind < 82:
            frame.put(draw.choice(['nx', 'ny']), draw.choice(['0', '1', '2', '7', '8', '9', '64', '4096', '1e3', '-1', str(1 << 40)]))
            fitted(draw, frame)
        elif kind < 88:
            name = draw.choice(['checkpoint.map', 'checkpoint.case'])
            frame.put(name, changed_number(draw, frame.get(name) or '0'))
        elif kind < 92:
            key = draw.choice(frame.keys)
            frame.keys.remove(key) if draw.random() < 0.5 else key.__setitem__(1, changed_number(draw, key[1]))
        elif kind < 94:
            del frames[k]
        elif kind < 96:
            frames.insert(draw.randrange(len(frames) + 1), frame.copy())
        elif kind < 98:
            other = draw.randrange(len(frames))
            frames[k], frames[other] = frames[other], frames[k]
        else:
            frame.put('checkpoint.numbers', draw.choice(['values', '', '0 0', '2 1', ' '.join(['1'] * 2000)]))
    data = b''.join(f.bytes() for f in frames)
    return mutate_bytes(draw, data) if draw.random() < 0.02 else data


def mutate_bytes(draw, data):
    data = bytearray(data)
    for _ in range(draw.choice([1, 1, 2, 8])):
        at = draw.randrange(len(data) + 1)
        kind = draw.randrange(4)
        if kind == 0 and data:
            data[min(at, len(data) - 1)] = draw.randrange(256)
        elif kind == 1:
            del data[at:at + draw.choice([1, 2, 16, 300])]
        elif kind == 2:
            data[at:at] = bytes(draw.randrange(256) for _ in range(draw.choice([1, 4, 100])))
        else:
            data[at:at] = data[at:at + draw.choice([1, 16, 300])]
    return bytes(data)


WORDS = ['', 'x', '-', 'MPa', '/', '//', '/MPa', '1MPa', '1 MPa', '1mm', "'", '"', '""', '"a\tb"', '{', '}', '[', ']', ':', ',', ';', '#', '\0',
         '\x1b[31m', '\u00b5m', '\xff', '%n%s%n', '1,2', '1e', '+', '..', 'E' * 70, 'x/' + 'A' * 200, 'x' * 600, '9' * 400, '0.' + '3' * 600,
         'null', 'true', '{"a": 1}', '[1, 2]', 'tau', 'E', 'frequency/Hz', 'storage', 'loss/MPa', 'tandelta/1', 'inf', 'load/N', 'case']


def mutate_table(draw, data):
    """Lines of words, split at tabs, blanks, commas or semicolons."""
    if draw.random() < 0.15:
        return mutate_bytes(draw, data)
    text = data.decode('utf-8', 'surrogateescape')
    split = next((c for c in '\t,; ' if c in text), ' ')
    lines = [line.split(split) for line in text.split('\n')]
    for _ in range(draw.choice([1, 1, 1, 2, 4])):
        k = draw.randrange(len(lines))
        line, kind = lines[k], draw.randrange(14)
        at = draw.randrange(len(line)) if line else 0
        if kind < 4 and line:
            line[at] = changed_number(draw, line[at])
        elif kind == 4 and line:
            line[at] = draw.choice(WORDS)
        elif kind == 5:
            line.insert(at, draw.choice(WORDS + NUMBERS))
        elif kind == 6 and line:
            del line[at]
        elif kind == 7:
            for each in lines:  # a further column
                each.insert(min(at, len(each)), draw.choice(['1', each[0] if each else '', draw.choice(WORDS)]))
        elif kind == 8:
            for each in lines:
                del each[at:at + 1]
        elif kind == 9:
            lines.insert(draw.randrange(len(lines) + 1), list(line))
        elif kind == 10:
            del lines[k]
        elif kind == 11:
            lines[k:k] = [list(line)] * draw.choice([2, 100, 5000])
        elif kind == 12:
            line[at:at] = [draw.choice(['1', draw.choice(WORDS)])] * draw.choice([2, 10, 3000])
        else:
            other = draw.randrange(len(lines))
            lines[k], lines[other] = lines[other], lines[k]
        if not lines:
            lines = [['']]
    text = '\n'.join(draw.choice([split] * 50 + [' ', '\t', ',', ';']).join(line) for line in lines)
    text = text.replace('\n', draw.choice(['\n'] * 12 + ['\r\n', '\r', '\n\n']))
    if draw.random() < 0.1:
        text = text.rstrip('\n')
    return (b'\xef\xbb\xbf' if draw.random() < 0.02 else b'') + text.encode('utf-8', 'surrogateescape')


# ---- subjects ----

BALL = 'rc-synth sphere --nx 12 --ny 10 --dx 1um --dy 1.1um --radius 100um -o ball.rcg'
TRACK = 'rc-synth selfaffine --nx 24 --ny 6 --dx 1um --hurst 0.8 --rms-height 2nm --seed 3 -o track.rcg'
STEEL = '--E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.2'
PRESSED = [BALL, 'rc-solve %s --load 1mN -o pressed.rcg ball.rcg' % STEEL]
ROLLED = [TRACK, 'rc-solve %s --radius 100um --load 0.02mN --travel=-2um:0um:3 --window 12x6 -o rolled.rcg track.rcg' % STEEL]
COMMON = ' --quiet --threads 1 --memory 512M '

# name, commands that make its input, the command without the file of a mutant
CHECKPOINTS = [
    ('solve', [BALL], 'rc-solve --E1 210GPa --nu1 0.3 --E2 rigid --hardness 4GPa --load 0.1mN,1mN,0.5mN --history --output pressure ball.rcg'),
    ('solve-pk99', [BALL], 'rc-solve --estar 100GPa --method pk99 --tol 1e-12 --approach 10nm,30nm --output pressure ball.rcg'),
    ('solve-tilt', [BALL], 'rc-solve --estar 100GPa --tilt free --at 1um,0 --load 0.1mN,1mN --output pressure ball.rcg'),
    ('solve-yield', [BALL], 'rc-solve --E1 210GPa --nu1 0.3 --E2 rigid --yield 1GPa,10GPa --slabs 3 --increments 16,half --load 1mN,0,2mN '
     '--history --output pressure ball.rcg'),
    ('solve-adhesion', [BALL], 'rc-solve --estar 1GPa --adhesion 50mJ/m2,exponential,100nm --approach=-50nm,10nm,-20nm --pull-off '
     '--output pressure ball.rcg'),
    ('solve-dents', [BALL], 'rc-solve --estar 1GPa --hardness 30MPa --adhesion 50mJ/m2,exponential,100nm --load 1uN,10uN,1uN '
     '--output pressure ball.rcg'),
    ('solve-relaxation', [BALL], 'rc-solve --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --load 1uN --time 0,1ms,3ms --output pressure ball.rcg'),
    ('solve-speed', [BALL], 'rc-solve --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --periodic --load 1uN --speed 1mm/s,10mm/s '
     '--output pressure ball.rcg'),
    ('solve-travel', [TRACK], 'rc-solve --estar 100GPa --radius 100um --load 0.2mN --travel=-4um:4um:3 --window 8x6 --output pressure track.rcg'),
    ('solve-passes', [TRACK], 'rc-solve --E1 210GPa --nu1 0.3 --E2 rigid --radius 100um --yield 500MPa --slabs 2 --increments 2 --load 0.5mN '
     '--travel=-2um:2um:2 --passes 2 --output pressure track.rcg'),
    ('slip', PRESSED, "rc-slip --mu 0.3 --path '1mN,0,0;1mN,0.1mN,0;0.5mN,0.05mN,0.02mN' --output slip-x,dissipation pressed.rcg"),
    ('slip-few', PRESSED, 'rc-slip --mu 0.3 --displacement 5nm,1nm --coupling goodman --increments 4 --output slip-x pressed.rcg'),
    ('slip-steady', PRESSED, 'rc-slip --mu 0.3 --creep 1e-4,0,10 --steady --output slip-x pressed.rcg'),
    ('slip-force', PRESSED, 'rc-slip --mu 0.3 --creep-force 0.1mN --steady --output slip-x pressed.rcg'),
    ('slip-rolling', ROLLED, 'rc-slip --mu 0.3 --creep 1e-4,0 --output slip-x rolled.rcg'),
    ('wear', [BALL, 'rc-solve --load 1mN --E1 210GPa --nu1 0.3 --E2 rigid -o pressed.rcg ball.rcg'],
     'rc-wear --coefficient 1e-6mm3/Nm --distance 1m,100m --output wear pressed.rcg'),
    ('wear-track', [BALL, 'rc-solve --load 1mN --E1 210GPa --nu1 0.3 --E2 rigid -o pressed.rcg ball.rcg'],
     'rc-wear --coefficient 1e-6mm3/Nm,1e-7mm3/Nm --motion track:20um --distance 1m,100m --output wear pressed.rcg'),
    ('wear-sliding', ['rc-synth wave --nx 8 --ny 6 --dx 1um --amplitude 1nm --wavelength 8um -o wave.rcg',
                      'rc-solve --periodic --mean-pressure 100MPa --E1 210GPa --nu1 0.3 --E2 rigid -o pressed.rcg wave.rcg'],
     'rc-wear --coefficient 1e-6mm3/Nm,1e-6mm3/Nm --motion sliding --counter wave.rcg --distance 1m,10m --output wear pressed.rcg'),
]

LIMITS = '# depth bending torsion yield\n0 600MPa 400MPa 1GPa\n0.1mm 500MPa 350MPa\n1mm 400MPa 300MPa 700MPa\n'
FATIGUE = [TRACK, 'rc-solve --E1 210GPa --nu1 0.3 --E2 rigid --radius 100um --load 0.2mN -o pressed.rcg track.rcg']
CURVE = 'rc-render --curve %s -o curve.svg MUTANT'
# name, commands that make its input, the texts or files of its seeds, the command
TABLES = [
    ('relaxation', [BALL], ['tau E\ninf 1MPa\n1ms 9MPa\n', 'tau/s,E/MPa\ninf,1\n1e-3,9\n1,2\n',
                            'Frequency,Storage,Loss\nHz,MPa,MPa\n' + ''.join('%g,%g,%g\n' % (10.0 ** k, 1 + 0.5 * k * k, 1 + k) for k in range(6)),
                            'omega/rad/s storage/MPa loss/MPa\n1 1 .1\n10 2 1\n100 9 .5\n'],
     'rc-solve --relaxation MUTANT --nu1 0.5 --E2 rigid --load 1uN --time 0,1ms --tol 1e-2 --output pressure -o out ball.rcg'),
    ('yield', [BALL], ['0 1GPa\n0.01 1.2GPa\n0.1 1.5GPa\n', 'strain\tstress\n0\t1e9\n1e-3\t1.1e9\n# end\n'],
     'rc-solve --yield MUTANT --E1 210GPa --nu1 0.3 --E2 rigid --slabs 2 --increments 2 --load 1mN --output pressure -o out ball.rcg'),
    ('limits', FATIGUE, [LIMITS, LIMITS.replace(' ', ', ')], 'rc-fatigue --limits MUTANT --pass x --depths 0.5um,1um -o out pressed.rcg'),
    ('history', PRESSED, ['load,fx,fy\n1mN,0,0\n1mN,0.1mN,0\n1mN,-0.1mN,0\n', '1e-3 0 0\n1e-3 1e-4 1e-5\n'],
     'rc-slip --history MUTANT --mu 0.3 --increments 2 --output slip-x -o out pressed.rcg'),
    ('report', [BALL, 'rc-solve --estar 100GPa --load 0.1mN:1mN:4 --report seed.tsv -o /dev/null ball.rcg',
                'rc-solve --estar 100GPa --load 0.1mN:1mN:4 --report seed.csv -o /dev/null ball.rcg',
                'rc-solve --estar 100GPa --load 0.1mN:1mN:4 --report seed.json -o /dev/null ball.rcg'], ['seed.tsv', 'seed.csv', 'seed.json'],
     CURVE % 'load:max_pressure'),
    ('steps', [BALL, 'rc-solve --load 1mN --E1 210GPa --nu1 0.3 --E2 rigid -o pressed.rcg ball.rcg',
               'rc-wear --coefficient 1e-6mm3/Nm --distance 100m --steps seed.tsv -o /dev/null pressed.rcg'], ['seed.tsv'],
     CURVE % 'distance:contact_fraction'),
]


class Subject:
    def __init__(self, kind, name, make, seeds, command):
        self.kind, self.name, self.make, self.seeds, self.command = kind, kind + '-' + name, make, seeds, command
        self.of = kind + '-' + name.partition('-')[0]  # the kind of file

    def prepare(self):
        """Makes the seeds in the present folder, which becomes the one of the runs."""
        for line in self.make:
            subprocess.run(shlex.split(line) + ['--quiet'], check=True)
        if self.kind == 'checkpoint':
            words = shlex.split(self.command + COMMON) + ['-o', '/dev/null']
            done = subprocess.run(words + ['--checkpoint', 'seed.ck', '--interval', '1e-9'])
            if done.returncode not in (0, 3):
                sys.exit('%s: the seed cannot be made' % self.name)
            with open('seed.ck', 'rb') as file:
                states = states_of(frames_of(file.read()))
            step = max(1, len(states) // 32)
            self.seed = states[::-step]
            os.remove('seed.ck')
            self.words = words + ['--checkpoint', 'MUTANT', '--resume']
            return
        self.words = shlex.split(self.command + COMMON)
        self.seed = []
        for text in self.seeds:
            if text.startswith('seed.'):
                with open(text, 'rb') as file:
                    self.seed.append((text[4:], file.read()))
            else:
                self.seed.append(('.tsv', text.encode()))

    def mutant(self, draw):
        seed = draw.choice(self.seed)
        if self.kind == 'checkpoint':
            return '.ck', mutate_frames(draw, seed)
        return seed[0], mutate_table(draw, seed[1])


# ---- runs ----

def run(words, limit):
    """Exit status and seconds of the processor; messages."""
    def limited():
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 28, 1 << 28))

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, preexec_fn=limited,
                              timeout=20 * limit)
        status, said = done.returncode, done.stderr.decode('utf-8', 'replace')
    except subprocess.TimeoutExpired:
        status, said = -99, 'it waits'
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return status, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, said


def finding_of(status, seconds, said, limit):
    """What is wrong with such an end; None: nothing."""
    for line in said.split('\n'):
        if 'runtime error:' in line or 'Sanitizer' in line:
            return line.strip()[:160]
    if status in (-24, -9, -99) and seconds > limit / 2 or status == -99:
        return 'more than %g s of the processor' % limit
    if status < 0:
        return 'signal %d' % -status
    if status not in (0, 1, 2, 3):
        return 'exit status %d' % status
    if status in (1, 2) and not said.startswith('rc-'):
        return 'refused without a message: ' + said[:80]
    return None


def try_subject(subject, count, args):
    """Runs this subject's mutants in a folder of its own, some in each of several processes."""
    folder = tempfile.mkdtemp(prefix='mutants-')
    os.chdir(folder)
    subject.prepare()
    ends, findings, slowest, children = {}, [], (0, 0), []
    for job in range(args.jobs):
        read, write = os.pipe()
        if os.fork() == 0:
            os.close(read)
            with os.fdopen(write, 'w') as out:
                for k in [args.only] if args.only is not None else range(job, count, args.jobs):
                    draw = random.Random('%d %s %d' % (args.seed, subject.name, k))
                    ending, data = subject.mutant(draw)
                    name = 'mutant-%d%s' % (job, ending)
                    with open(name, 'wb') as file:
                        file.write(data)
                    words = [name if w == 'MUTANT' else w for w in subject.words]
                    status, seconds, said = run(words, args.limit)
                    finding = finding_of(status, seconds, said, args.limit)
                    if args.only is not None:
                        sys.stderr.write(said)
                    if args.keep and (finding or args.only is not None):
                        os.makedirs(args.keep, exist_ok=True)
                        with open(name, 'wb') as file:
                            file.write(data)
                        base = os.path.join(args.keep, '%s-%d' % (subject.name, k))
                        shutil.copy(name, base + ending)
                        with open(base + '.txt', 'w') as file:
                            file.write(' '.join(shlex.quote(w) for w in words) + '\n' + said)
                    out.write('%d\t%d\t%g\t%s\n' % (k, status, seconds, finding or ''))
            os._exit(0)
        os.close(write)
        children.append(read)
        if args.only is not None:
            break
    for read in children:
        with os.fdopen(read) as results:
            for line in results:
                k, status, seconds, finding = line.rstrip('\n').split('\t', 3)
                ends[int(status)] = ends.get(int(status), 0) + 1
                slowest = max(slowest, (float(seconds), int(k)))
                if finding:
                    findings.append((int(k), finding))
        os.wait()
    os.chdir('/')
    shutil.rmtree(folder)
    print('%s: %d mutants of %d seeds, %d read, %d refused, %d not converged, slowest %.1f s (%d): %s' % (
        subject.name, sum(ends.values()), len(subject.seed), ends.get(0, 0), ends.get(1, 0) + ends.get(2, 0), ends.get(3, 0), *slowest,
        '%d findings' % len(findings) if findings else 'no finding'), flush=True)
    for k, finding in sorted(findings)[:args.show]:
        print('    %d: %s' % (k, finding), flush=True)
    return len(findings)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--bin', help='folder of the tools')
    parser.add_argument('--count', type=int, default=100, help='mutants of each kind of file')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--limit', type=int, default=20, help='seconds of the processor')
    parser.add_argument('--jobs', type=int, default=1)
    parser.add_argument('--keep', help='folder for the findings')
    parser.add_argument('--show', type=int, default=10)
    parser.add_argument('--only', type=int)
    parser.add_argument('--list', action='store_true')
    parser.add_argument('subject', nargs='*', help='name, or the beginning of names')
    args = parser.parse_args()
    subjects = [Subject('checkpoint', name, make, None, command) for name, make, command in CHECKPOINTS]
    subjects += [Subject('table', *row) for row in TABLES]
    several = {s.of: sum(other.of == s.of for other in subjects) for s in subjects}
    if args.subject:
        subjects = [s for s in subjects if any(s.name.startswith(word) for word in args.subject)]
    if args.list or not subjects:
        print('\n'.join(s.name for s in subjects))
        return 0 if subjects else 2
    if args.bin:
        os.environ['PATH'] = os.path.abspath(args.bin) + os.pathsep + os.environ['PATH']
    args.keep = args.keep and os.path.abspath(args.keep)
    os.environ['OMP_NUM_THREADS'] = '1'
    os.environ['ASAN_OPTIONS'] = 'allocator_may_return_null=1:max_allocation_size_mb=2048:detect_leaks=0:quarantine_size_mb=16'
    os.environ['UBSAN_OPTIONS'] = 'print_stacktrace=1'
    return min(1, sum(try_subject(s, -(-args.count // several[s.of]), args) for s in subjects))


sys.exit(main())
