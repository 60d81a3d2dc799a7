"""Random histories with a hardness, and adhesive paths: what is told of the pressure's error against the pressures of the same path solved tightly.
tests/long/estimates.py hist|adhesion SEED COUNT BIN"""
import array, json, os, random, subprocess, sys, tempfile
os.environ['RC_THREADS'] = '1'
table = tempfile.NamedTemporaryFile()
kind, seed0, count, BIN = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]

def frames(data):
    out, at = [], 0
    while data[at:at + 4] == b'RCG1':
        end = data.index(b'\n\n', at)
        keys = dict(l.split('=', 1) for l in data[at:end].decode().split('\n')[1:])
        n = int(keys['nx']) * int(keys['ny']); size = 8 if keys['type'] == 'f64' else 4
        a = array.array('d' if size == 8 else 'f'); a.frombytes(data[end + 2:end + 2 + n * size])
        at = data.index(b'\n', end + 2 + n * size) + 1
        out.append((keys, a))
    return out

def run(args, surface):
    r = subprocess.run([BIN + '/rc-solve', '--quiet', '--output', 'pressure', '--report', table.name, *args], input=surface, capture_output=True)
    if r.returncode not in (0, 3): return None, r.stderr.decode()
    return frames(r.stdout), [json.loads(l) for l in open(table.name)]

def distance(a, b):
    s = sum(abs(x) for x in b)
    return sum(abs(x - y) for x, y in zip(a, b)) / s if s else 0.0

rows, conv, short = [], [0, 0], 0
for c in range(count):
    r = random.Random(seed0 * 100003 + c)
    nx = r.randint(12, 36); ny = r.choice([1, nx, r.randint(8, 36)])
    dx = 1e-6; hm = 10 ** r.uniform(-8, -6.7)
    per = r.random() < 0.5
    surface = subprocess.run([BIN + '/rc-synth', 'selfaffine', '--nx', str(nx), '--ny', str(ny), '--dx', '1um', '--hurst', '0.8', '--rms-height', repr(hm), '--short-cut', '%gum' % r.choice([2, 4, 8]), '--seed', str(r.randrange(10 ** 6))], capture_output=True).stdout
    if not surface: continue
    area = nx * ny * 1e-12; E = 1e9
    slope = hm / (max(nx, ny) * dx / 4)
    args = ['--estar', repr(E)] + (['--periodic'] if per else [])
    if kind == 'hist':
        H = E * slope * 10 ** r.uniform(-1.3, 0.3)
        n = r.randint(2, 5); top = H * area * 10 ** r.uniform(-2, -0.1)
        loads = [top * r.uniform(0.1, 1) for _ in range(n)]
        args += ['--history', '--hardness', repr(H), '--load', ','.join(map(repr, loads))]
        tight = ['--tol', '1e-8']
    else:
        rho = dx * 10 ** r.uniform(-2, -0.7); ell = r.choice([1.5, 2, 4, 8])
        w = E * rho * rho / (ell * dx)
        law = r.choice(['exponential', 'dugdale', 'compact', 'jkr', 'exponential'])
        spec = '%r,%s' % (w, law) + ('' if law == 'jkr' else ',%r' % (rho * (1 if law == 'exponential' else 3)))
        n = r.randint(1, 4)
        a = [hm * r.uniform(-1, 1.2) for _ in range(n)]
        args += ['--adhesion', spec]
        if r.random() < 0.3: args += ['--hardness', repr((w / rho) * 10 ** r.uniform(0.3, 1.3))]
        if r.random() < 0.15: args += ['--layer', '%r,%r,0.3' % (dx * r.uniform(1, 6), E * 10 ** r.uniform(-0.7, 0.7))]; args[0:2] = ['--E1', repr(E), '--nu1', '0.3', '--E2', 'rigid']
        if r.random() < 0.35: args += ['--load=' + ','.join(repr(E * slope * area * 10 ** r.uniform(-2, 0.5)) for _ in range(n))]
        else: args += ['--approach=' + ','.join(map(repr, a))]
        args += ['--tol', r.choice(['1e-3', '1e-4', '3e-4'])]
        tight = ['--tol', '1e-8']
    got, rep = run(args, surface)
    if got is None: continue
    want, wrep = run((args[:-2] if kind != 'hist' else args) + tight, surface)
    if want is None: continue
    for k in range(min(len(got), len(want))):
        if rep[k]['pressure_error_estimate'] is None or not wrep[k]['converged']: continue
        if kind != 'hist' and (rep[k].get('separated') == 'yes' or wrep[k].get('separated') == 'yes'): break
        e = distance(got[k][1], want[k][1]); t = rep[k]['pressure_error_estimate']
        if kind != 'hist' and e > 0.02: break  # another valley, and all after it
        conv[0] += 1; conv[1] += rep[k]['convolutions'] or 0
        short += not rep[k]['converged']
        if not rep[k]['converged']: print('short: case %d state %d told %.2e error %.2e %s mu %s nodes %s iters %s conv %s' % (c, k, t, e, ' '.join(args), rep[k].get('stability'), rep[k]['contact_nodes'], rep[k]['iterations'], rep[k]['convolutions']))
        rows.append((e, t, rep[k]['converged'], c, k))
        if e > 1e-6 and t < 0.99 * e: print('below: case %d state %d told %.2e error %.2e %s mu %s nodes %s iters %s' % (c, k, t, e, ' '.join(args), rep[k].get('stability'), rep[k]['contact_nodes'], rep[k]['iterations']))
for least in (0, 1e-7, 1e-6, 1e-5, 1e-4):
    s = [(t / e) for e, t, *_ in rows if e > least]
    s.sort()
    if s: print('errors above %.0e: %d states, below 0.99: %d, min %.2f, median %.2f, 90 %% %.1f' % (least, len(s), sum(x < 0.99 for x in s), s[0], s[len(s) // 2], s[int(len(s) * 0.9)]))
print('convolutions a state %.2f, not converged %d of %d' % (conv[1] / max(conv[0], 1), short, len(rows)))
