#!/usr/bin/env python3
"""Wall time of rc-solve against other contact solvers, on the same heights, to the same true error.

    peers.py [-n SIZE] [--case NAME,...] [--peer NAME,...] [--tools DIR] [--work DIR]
             [--threads N] [--repeat N] [--tol T] [--ladder | --time | --pk99 | --agree]

Peers are Python packages: aspher, tamaas, ContactMechanics; one that is not installed is reported as
not measured. See README.md beside this file for how to install them.

Surfaces come from rc-synth, the same file for all. The reference is rc-solve at 1e-9; --agree solves
the case with the peer at its tightest tolerance and prints how far apart the two are. The error of a
run is sum |p - p_ref| / sum p_ref over the nodes.

--ladder finds, for each peer, the settings that reach the tolerance (default 1e-4), and keeps them in
--work; --time runs each of them once, then the quickest two in turns with rc-solve, and prints the table;
neither of the two options does both. Every run is a process of its own. What is timed is the call that solves, from heights
in memory to a pressure in memory, plans and all set-up included, for both sides; importing a module,
reading and writing are not. Before each timed run it waits, up to 20 s, for other processes to rest; of
--repeat runs the least counts, and the share of the machine that others took during it is printed.
"""
import argparse
import importlib.metadata
import json
import os
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np

ESTAR, SLOPE, SPACING = 1e9, 0.1, 1e-6
# name: boundary, load. Periodic: mean pressure over E* and RMS slope; free: load as a part of that which
# makes a Hertz circle as wide as the map. The same ten as in solve.c, those without hardness.
CASES = {
    "periodic-1": ("periodic", 0.004),
    "periodic-10": ("periodic", 0.04),
    "periodic-37": ("periodic", 0.18),
    "periodic-50": ("periodic", 0.28),
    "periodic-97": ("periodic", 1.05),
    "sphere-2": ("free", 0.004),
    "sphere-19": ("free", 0.1),
}
DEFAULT = [c for c in CASES if c != "periodic-50"]  # that one is for --pk99


# ---- streams and our tools ----

def read_stream(path, channel):
    data, at = path.read_bytes(), 0
    while data[at:at + 5] == b"RCG1\n":
        end = data.index(b"\n\n", at)
        keys = dict(line.split("=", 1) for line in data[at:end].decode().split("\n")[1:])
        shape = int(keys["ny"]), int(keys["nx"])
        kind = np.dtype("<f8" if keys["type"] == "f64" else "<f4")
        first, size = end + 2, shape[0] * shape[1] * kind.itemsize
        if keys["channel"] == channel:
            return np.frombuffer(data, kind, shape[0] * shape[1], first).reshape(shape).astype(float)
        at = first + size + len("crc32 00000000\n")
    sys.exit(f"peers.py: {path}: no frame '{channel}'")


def write_heights(path, h):
    head = (f"RCG1\nchannel=height\nnx={h.shape[1]}\nny={h.shape[0]}\ndx={SPACING!r}\ndy={SPACING!r}\n"
            "unit=m\ntype=f64\n\n").encode()
    frame = head + np.ascontiguousarray(h, "<f8").tobytes()
    path.write_bytes(frame + f"crc32 {zlib.crc32(frame):08x}\nRCGEND 1\n".encode())


def tool(opts, name, *args):
    env = dict(os.environ, RC_THREADS=str(opts.threads))
    subprocess.run([str(opts.tools / name), *map(str, args)], check=True, env=env)


def side(n):
    return n * SPACING


def mean_pressure(case, n):
    boundary, load = CASES[case]
    if boundary == "periodic":
        return load * ESTAR * SLOPE
    radius = 20 * side(n)
    return load * 4 * ESTAR * (side(n) / 2)**3 / (3 * radius) / side(n)**2


def surface(opts, case):
    boundary = CASES[case][0]
    path = opts.work / f"{boundary}-{opts.n}.rcg"
    if path.exists():
        return path
    part = opts.work / "part.rcg"
    grid = ["--nx", opts.n, "--dx", f"{SPACING!r}"]
    tool(opts, "rc-synth", "selfaffine", "--hurst", 0.8, "--rms-slope", SLOPE, "--short-cut", repr(8 * SPACING),
         "--rolloff", repr(side(opts.n) / 8), "--seed", 5, *grid, "-o", part)
    h = read_stream(part, "height")
    if boundary == "free":
        tool(opts, "rc-synth", "sphere", "--radius", repr(20 * side(opts.n)), *grid, "-o", part)
        h = 0.05 * h + read_stream(part, "height")
    part.unlink()
    write_heights(path, h)
    return path


def ours(opts, case, tol, method="pcg", keep=None):
    """Pressure and what rc-solve reports."""
    out, report = opts.work / "ours.rcg", opts.work / "ours.json"
    args = ["--estar", ESTAR, "--mean-pressure", repr(mean_pressure(case, opts.n)), "--tol", repr(tol),
            "--method", method, "--output", "pressure", "--report", report, "-o", keep or out,
            "--threads", opts.threads, "--quiet"]
    if CASES[case][0] == "periodic":
        args.append("--periodic")
    heights, others = surface(opts, case), Others()
    tool(opts, "rc-solve", *args, heights)
    share = others.share()
    r = json.loads(report.read_text().splitlines()[0])
    r["others"] = share
    r["solve"] = r["seconds"]["setup"] + r["seconds"]["iterate"]
    return read_stream(keep or out, "pressure"), r


def reference(opts, case):
    path = opts.work / f"reference-{case}-{opts.n}.rcg"
    if path.exists():
        return read_stream(path, "pressure")
    part = opts.work / "reference.part"
    p, _ = ours(opts, case, 1e-9, keep=part)
    part.rename(path)
    return p


class Others:
    """Share of the machine that other processes took meanwhile."""

    def __init__(self):
        self.began = self.now()

    @staticmethod
    def now():
        ticks = [int(w) for w in open("/proc/stat").readline().split()[1:9]]
        t = os.times()
        return (sum(ticks) - ticks[3] - ticks[4]) / os.sysconf("SC_CLK_TCK"), sum(t[:4]), time.perf_counter()

    def share(self):
        busy, mine, wall = (b - a for a, b in zip(self.began, self.now()))
        return max(0., busy - mine) / (wall * os.cpu_count())


def wait_for_quiet(seconds=20.):
    """Until nobody else computes, or not longer than that."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        others = Others()
        time.sleep(0.15)
        if others.share() < 0.05:
            return


def distance(p, q):
    return float(np.abs(p - q).sum() / np.abs(q).sum())


# ---- peers: each returns pressure over E*, seconds, iterations ----
# They get lengths over the side of the map and pressures over E*, which is kind to absolute tolerances.

def solve_aspher(h, p, boundary, s):
    import aspher
    gap = np.ascontiguousarray(-h.ravel())
    options = dict(grid_size=h.shape[0], gap=gap, p_nominal=p, light_result=True, **s)
    began = time.perf_counter()
    r = aspher.solve_nested(**options)
    return r.pressure, time.perf_counter() - began, r.iterations


def solve_tamaas(h, p, boundary, s):
    import tamaas as tm
    tm.set_log_level(tm.LogLevel.error)
    primal = getattr(tm.PolonskyKeerRey, s["primal"])
    began = time.perf_counter()
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1., 1.], list(h.shape))
    model.E, model.nu = 1., 0.
    if boundary == "free":
        tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(model, h, s["tol"], primal, tm.PolonskyKeerRey.pressure)
    if boundary == "free":
        solver.setIntegralOperator("dcfft")
    solver.max_iter = 20000
    solver.solve(p)
    return np.array(model.traction), time.perf_counter() - began, 0


def solve_contactmechanics(h, p, boundary, s):
    import logging
    logging.disable(logging.CRITICAL)
    from ContactMechanics import FreeFFTElasticHalfSpace, PeriodicFFTElasticHalfSpace
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import Topography
    topography = Topography(h, (1., 1.), periodic=boundary == "periodic")
    began = time.perf_counter()
    kind = PeriodicFFTElasticHalfSpace if boundary == "periodic" else FreeFFTElasticHalfSpace
    system = make_system(substrate=kind(h.shape, 1., (1., 1.)), surface=topography)
    r = system.minimize_proxy(external_force=p, pentol=s["tol"], maxiter=20000)
    spent = time.perf_counter() - began
    force = np.asarray(system.substrate.force)[:h.shape[0], :h.shape[1]]
    return force * h.size, spent, int(r.nit)


def aspher_settings(boundary, tol):
    if boundary == "periodic":
        kinds = [dict(backend="periodic")]
    else:
        kinds = [dict(backend="h2", active_set=True), dict(backend="fft")]
    precisions = ["double", "float", "float_then_double"]
    def floor(precision, t):  # else float stops at 2e-6
        return dict(float_floor=min(2e-6, float(t))) if precision == "float" else {}

    return [[dict(kind, precision=precision, coarse_tol=coarse, tol=float(t), **floor(precision, t))
             for t in tol * 10.0**-np.arange(0, 5, 0.5)]
            for kind in kinds for precision in precisions for coarse in (1e-4, 1e-2)
            if not (precision == "double" and coarse == 1e-2)  # float shows what that brings
            and not (precision == "float_then_double" and kind["backend"] == "h2")]  # refused by it


def tamaas_settings(boundary, tol):
    primals = ["pressure", "gap"] if boundary == "periodic" else ["pressure"]
    return [[dict(primal=primal, tol=float(t)) for t in tol * 10.0**-np.arange(0, 9)] for primal in primals]


def contactmechanics_settings(boundary, tol):
    # pentol is a length; here lengths are over the side of the map
    return [[dict(tol=float(t)) for t in tol * 10.0**-np.arange(0, 10)]]


PEERS = {  # name: package, one solve, ladders of settings from loose to tight
    "aspher": ("aspher", solve_aspher, aspher_settings),
    "tamaas": ("tamaas", solve_tamaas, tamaas_settings),
    "ContactMechanics": ("ContactMechanics", solve_contactmechanics, contactmechanics_settings),
}


def version(peer):
    try:
        return importlib.metadata.version(PEERS[peer][0])
    except importlib.metadata.PackageNotFoundError:
        return None


def child(peer, heights, n, p, boundary, settings, out):
    """One solve in this process: writes the pressure, prints seconds and iterations."""
    h = read_stream(Path(heights), "height") / side(int(n))
    others = Others()
    q, seconds, iterations = PEERS[peer][1](h, float(p), boundary, json.loads(settings))
    share = others.share()
    np.save(out, q)
    print(json.dumps(dict(seconds=seconds, iterations=iterations, others=share)))


def theirs(opts, peer, case, settings, limit=None):
    """Pressure, seconds, iterations, share of others; None when it failed or took longer than the limit."""
    out = opts.work / "theirs.npy"
    env = dict(os.environ)
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        env[name] = str(opts.threads)
    args = [sys.executable, __file__, "--child", peer, str(surface(opts, case)), str(opts.n),
            repr(mean_pressure(case, opts.n) / ESTAR), CASES[case][0], json.dumps(settings), str(out)]
    try:
        run = subprocess.run(args, env=env, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if run.returncode != 0:
        print(f"# {peer} {case} {settings}: {(run.stderr.strip() or 'died').splitlines()[-1]}", flush=True)
        return None
    r = json.loads(run.stdout.splitlines()[-1])
    return np.load(out).reshape(opts.n, opts.n) * ESTAR, r["seconds"], r["iterations"], r["others"]


# ---- what is measured ----

def kept(opts, peer, case):
    return opts.work / f"ladder-{peer}-{case}-{opts.n}-{opts.tol:.0e}.json"


def ladder(opts, peer, case):
    """Of each ladder the loosest rung that is good enough, quickest first. Begins some rungs up and goes
    towards loose while that is good enough, else towards tight, until the error stands still."""
    p, good, errors = reference(opts, case), [], []

    def enough(s):
        r = theirs(opts, peer, case, s, opts.limit)
        if r is None:
            return None
        error = distance(r[0], p)
        print(f"# {case} {peer} {words(s)}: {r[1]:.3f} s, {r[2]} iterations, error {error:.1e}", flush=True)
        errors.append(error)
        return r[1] if error <= opts.tol else None

    for rungs in PEERS[peer][2](CASES[case][0], opts.tol):
        k = 2 if CASES[case][0] == "periodic" else 4
        if rungs[0].get("precision") == "float_then_double":
            k -= 2
        seconds = enough(rungs[k])
        if seconds is not None:
            found = seconds, rungs[k]
            while k > 0 and (seconds := enough(rungs[k - 1])) is not None:
                k -= 1
                found = seconds, rungs[k]
            good.append((*found, rungs[k - 1] if k > 0 else None))
            continue
        for above, s in zip(rungs[k:], rungs[k + 1:]):
            if (seconds := enough(s)) is not None:
                good.append((seconds, s, above))
                break
            if rungs[0].get("precision") == "float" and errors[-2:-1] == errors[-1:]:
                break
    good.sort(key=lambda g: g[0])
    for i, (seconds, s, above) in enumerate(good[:2]):  # between the rungs, twice halved
        for _ in range(2 if above is not None else 0):
            between = dict(s, tol=(s["tol"] * above["tol"])**0.5)
            if (quicker := enough(between)) is not None:
                seconds, s = quicker, between
            else:
                above = between
        good[i] = seconds, s, above
    kept(opts, peer, case).write_text(json.dumps([s for _, s, _ in good]))


def words(settings):
    return " ".join(f"{k}={v:.1e}" if isinstance(v, float) else f"{k}={v}" for k, v in settings.items())


def timed(opts, peer, case):
    p, candidates = reference(opts, case), json.loads(kept(opts, peer, case).read_text())
    if not candidates:
        print(f"{case:<12} {opts.n:>5} {peer}: no setting reached {opts.tol:.0e}")
        return
    us, best, mine, spent = None, None, [], {k: [] for k in range(len(candidates))}
    for turn in range(opts.repeat):
        wait_for_quiet()
        q, r = ours(opts, case, opts.tol)
        mine.append(r["solve"])
        if us is None or r["solve"] < us[0]:
            us = r["solve"], distance(q, p), r, r["others"]
        for k in sorted(spent, key=lambda k: min(spent[k], default=0.))[:None if turn == 0 else 2]:
            wait_for_quiet()
            t = theirs(opts, peer, case, candidates[k], opts.limit)
            spent[k].append(np.inf if t is None or distance(t[0], p) > opts.tol else t[1])
            if t is not None and distance(t[0], p) <= opts.tol and (best is None or t[1] < best[0]):
                best = t[1], distance(t[0], p), t[2], candidates[k], t[3]
    if best is None:
        print(f"{case:<12} {opts.n:>5} {peer}: no setting reached {opts.tol:.0e} again")
        return
    print(f"# {case} {opts.n}: rc-solve " + " ".join(f"{m:.3f}" for m in mine) + f"; {peer} " +
          " | ".join(" ".join(f"{t:.3f}" for t in spent[k]) for k in spent) +
          f"; others took {us[3]:.0%} and {best[4]:.0%} of the machine in the runs counted")
    r = us[2]
    print(f"{case:<12} {opts.n:>5} {r['contact_fraction']:8.4f} | {us[0]:8.3f} {us[1]:8.1e} {r['iterations']:4d} "
          f"{r['convolutions']:6.1f} | {peer:<16} {best[0]:8.3f} {best[1]:8.1e} {best[2]:5d} | {best[0] / us[0]:6.2f} "
          f"| {words(best[3])}", flush=True)


def heading(opts, peers):
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line), "?")
    ours_version = subprocess.run([opts.tools / "rc-solve", "--version"], capture_output=True, text=True)
    print(f"# {time.strftime('%Y-%m-%d')}; {model}, {opts.threads} of {os.cpu_count()} threads; "
          f"{ours_version.stdout.splitlines()[0]}; " +
          ", ".join(f"{peer} {version(peer) or 'not installed: not measured'}" for peer in peers))
    print(f"{'case':<12} {'n':>5} {'contact':>8} | {'seconds':>8} {'error':>8} {'its':>4} {'equiv':>6} | "
          f"{'peer':<16} {'seconds':>8} {'error':>8} {'its':>5} | {'ratio':>6} | settings of the peer", flush=True)


def pk99(opts, case):
    """Seconds of pcg and pk99 to the same true error. pk99 looks at its error seldom: it gets
    tighter and tighter tolerances, from ten times the asked one, until the error is met."""
    p, slow = reference(opts, case), None
    for tol in opts.tol * 10.0**-np.arange(-1, 3, 0.5):
        q, r = ours(opts, case, float(tol), "pk99")
        error = distance(q, p)
        print(f"# {case} pk99 --tol {tol:.1e}: {r['solve']:.3f} s, {r['iterations']} iterations, error {error:.1e}",
              flush=True)
        if error <= opts.tol:
            slow = r["solve"], error, r
            break
    fast = min((ours(opts, case, opts.tol) for _ in range(opts.repeat)), key=lambda a: a[1]["solve"])
    print(f"{case} {opts.n}, contact {fast[1]['contact_fraction']:.4f}: pcg {fast[1]['solve']:.3f} s, error "
          f"{distance(fast[0], p):.1e}, {fast[1]['iterations']} iterations, {fast[1]['convolutions']:.1f} convolutions; "
          f"pk99 {slow[0]:.3f} s, error {slow[1]:.1e}, {slow[2]['iterations']} iterations, "
          f"{slow[2]['convolutions']:.1f} convolutions; ratio {slow[0] / fast[1]['solve']:.1f}")


def agree(opts, peer, case):
    tight = {"aspher": dict(backend="periodic" if CASES[case][0] == "periodic" else "fft", tol=1e-12,
                            precision="double", max_iter=3000),
             "tamaas": dict(primal="pressure", tol=1e-14), "ContactMechanics": dict(tol=1e-15)}[peer]
    r = theirs(opts, peer, case, tight, opts.limit)
    if r is None:
        print(f"{case} {opts.n}: {peer} at its tightest: no answer")
        return
    p = reference(opts, case)
    q = r[0] / r[0].mean() * p.mean()
    print(f"{case} {opts.n}: {peer} ({words(tight)}, {r[2]} iterations, {r[1]:.1f} s) is {distance(r[0], p):.2e} "
          f"from the reference ({distance(q, p):.2e} when scaled to the same load), largest difference over the "
          f"mean pressure {np.abs(r[0] - p).max() / p.mean():.1e}, load off by {r[0].mean() / p.mean() - 1:.1e}",
          flush=True)


def main():
    top = Path(__file__).resolve().parent.parent
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("-n", type=int, default=1024)
    a.add_argument("--case", default=",".join(DEFAULT))
    a.add_argument("--peer", default=",".join(PEERS))
    a.add_argument("--tools", type=Path, default=top / "build" / "tools")
    a.add_argument("--work", type=Path, default=Path("peers-work"))
    a.add_argument("--threads", type=int, default=2)
    a.add_argument("--repeat", type=int, default=5)
    a.add_argument("--tol", type=float, default=1e-4)
    a.add_argument("--limit", type=float, default=600., help="seconds for one run of a peer")
    only = a.add_mutually_exclusive_group()
    for what in ("ladder", "time", "pk99", "agree"):
        only.add_argument("--" + what, action="store_true")
    opts = a.parse_args()
    opts.work.mkdir(parents=True, exist_ok=True)
    cases, peers = opts.case.split(","), opts.peer.split(",")
    for name, known in [(c, CASES) for c in cases] + [(p, PEERS) for p in peers]:
        if name not in known:
            sys.exit(f"peers.py: '{name}': there are {', '.join(known)}")
    if opts.pk99:
        for case in cases:
            pk99(opts, case)
        return
    if not opts.ladder and not opts.agree:
        heading(opts, peers)
    for peer in peers:
        if version(peer) is None:
            print(f"{peer}: not installed: not measured")
            continue
        for case in cases:
            if opts.agree:
                agree(opts, peer, case)
                continue
            if not opts.time:
                ladder(opts, peer, case)
            if not opts.ladder:
                timed(opts, peer, case)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        child(*sys.argv[2:])
    else:
        main()
