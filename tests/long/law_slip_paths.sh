# SPDX-License-Identifier: GPL-3.0-or-later
# rc-slip: its estimated errors, compared with paths of 192 increments, on random maps and paths, on free maps
# and on maps that repeat along one axis or both. The paths have constant, growing and falling loads, and displacements. Their forces turn,
# reverse or grow with the load. It takes about 8 minutes; SECONDS_MOST=60 limits it for a first impression.
. "$(dirname "$0")/../pipe.sh"
command -v python3 >/dev/null || skip "python3 is not here"

cat >paths.py <<'END'
import array, json, math, os, random, subprocess, time

def run(*args, stdin=None):
    done = subprocess.run(args, input=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode not in (0, 3):
        raise RuntimeError(done.stderr.decode())
    return done.stdout

def frames(stream):
    at = 0
    while stream[at:at + 5] == b'RCG1\n':
        end = stream.index(b'\n\n', at)
        keys = dict(line.split('=', 1) for line in stream[at + 5:end].decode().split('\n'))
        size = 8 * int(keys['nx']) * int(keys['ny'])
        yield keys, array.array('d', stream[end + 2:end + 2 + size])
        at = stream.index(b'\n', end + 2 + size) + 1

def contact(draw, n):
    repeats = draw.choice(['', '', '--periodic', '--periodic', '--periodic=x', '--periodic=y'])
    nu, cut = draw.choice([0, .2, .3, .4, .5]), draw.choice([3, 4, 6])
    surface = run('rc-synth', 'selfaffine', '--nx', str(n), '--dx', '1um', '--hurst', '0.8', '--rms-slope', '0.02', '--rolloff',
                  '%gum' % max(n / 4, 1.5 * cut), '--short-cut', '%dum' % cut, '--seed', str(draw.randrange(10 ** 6)))
    load = ([repeats, '--mean-pressure', '%dMPa' % draw.choice([20, 60, 150, 400, 1000])] if repeats else
            ['--radius', '%gmm' % (n * n * 2.5e-4 * draw.choice([1, 2, 4])), '--load', '%gmN' % (n * n * draw.choice([.3, 1, 3]) * .02)])
    return run('rc-solve', '--quiet', '--tol', '1e-8', '--E1', '210GPa', '--nu1', str(nu), '--E2', '210GPa', '--nu2', str(nu), *load,
               stdin=surface)

def path(draw, kind, mu, P):
    corners, angle = [] if kind == 'start' else [(P, 0, 0)], draw.uniform(0, 6.28) if draw.random() < .4 else 0
    for leg in range(draw.choice([1, 2, 3])):
        p = P
        if kind in ('grow', 'start'):
            p = P * draw.uniform(.4, 1) if leg == 0 else min(P, corners[-1][0] * draw.uniform(1, 1.5))
        if kind == 'fall' and leg:
            p = corners[-1][0] * draw.uniform(.4, 1)
        if kind == 'turn' and leg:
            angle += draw.uniform(.3, 2.8)
        elif leg and draw.random() < .6:
            angle += math.pi
        f = draw.uniform(.05, .95) * mu * p
        corners.append((p, f * math.cos(angle), f * math.sin(angle)))
    return '--path', ';'.join('%.12gN,%.12gN,%.12gN' % c for c in corners)

def slide(mu, way, increments, *more):
    if os.path.exists('report.json'):
        os.remove('report.json')
    out = run('rc-slip', '--quiet', '--mu', str(mu), *way, '--increments', str(increments), '--output', 'traction-x,traction-y', '--report',
              'report.json', *more, 'contact.rcg')
    q = {}
    for keys, values in frames(out):
        q.setdefault(int(keys.get('case', 1)), []).append(values)
    return q, [json.loads(line) for line in open('report.json')]

draw, began, ratios = random.Random(7310), time.time(), {n: [] for n in ('auto', 4, 5, 6, 7, 8, 16)}
while time.time() - began < float(os.environ.get('SECONDS_MOST', 480)):
    stream = contact(draw, draw.choice([16, 20, 24, 32]))
    open('contact.rcg', 'wb').write(stream)
    p = next(v for k, v in frames(stream) if k['channel'] == 'pressure')
    mu, kind = draw.choice([.1, .3, .6]), draw.choice(['turn', 'back', 'grow', 'fall', 'start', 'moved'])
    if sum(x > 0 for x in p) < 20:
        continue
    d = [10 ** draw.uniform(-9, -6.7) * draw.uniform(-1, 1) for _ in range(2)]
    way = ('--displacement', '%.9g,%.9g' % tuple(d)) if kind == 'moved' else path(draw, kind, mu, sum(p) * 1e-12)
    truth, _ = slide(mu, way, 192, '--tol', '1e-8')
    for increments in ratios:
        q, report = slide(mu, way, increments)
        for row in report:
            a, b = q[row['case']], truth[row['case']]
            size = sum(map(math.hypot, *b))
            off = size and sum(math.hypot(w - y, x - z) for w, x, y, z in zip(*a, *b)) / size
            if off < 1e-6:
                continue
            ratios[increments].append(row['traction_error_estimate'] / off)
            if ratios[increments][-1] < .99:
                print('below:', kind, way, 'increments', increments, 'case', row['case'], 'off %.2e, told %.2e' % (off, row['traction_error_estimate']))
for increments, r in ratios.items():
    r.sort()
    print(increments, len(r), sum(x < .99 for x in r), r[len(r) // 2], r[len(r) * 9 // 10])
END
env -u SHELLOPTS python3 paths.py >paths.txt
cat paths.txt
for increments in auto 4 5 6 7 8 16; do
    read -r _ states below median most < <(grep "^$increments " paths.txt)
    claim "increments $increments: no error of $states states exceeds its estimate" test "$below" = 0
    between 1 "$median" 7 "  which in the middle is not far from the error"
    case $increments in
    [4-7]) many=40 ;;
    *) many=16 ;;
    esac
    between 1 "$most" $many "  nor in nine of ten"
done
