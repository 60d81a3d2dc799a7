#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Partial slip under a tangential force: rc-slip beside aspher's FrictionSolver and Tamaas' PolonskyKeerTan.

    peers-venv/bin/python bench/peers/friction.py --tools build/tools [--sides 64,128] [--alone]

Self-affine (H 0.8, slope 0.1, waves from 4 nodes up, flat above a quarter of the side), mu 0.3, half of the force that friction carries, in
one increment under the pressure that is there, one thread. Errors are relative L1 of both tractions, against rc-slip's at --tol 1e-10.

free       nu 0.3, aspher's boundary; a sphere is added, so that the contact stays inside
periodic   nu 0.5, the only one at which Tamaas' solver knows no other coupling; it finds the pressure too

Work in equivalents of a convolution of one map there and back: rc-slip's own; two for each iteration of aspher's tangential problem; three
for each of Tamaas'. Seconds are those of the solution, without start and files. A dash: not reached.
"""
import argparse
import contextlib
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

LEVELS = 1e-2, 1e-4, 1e-6
MU = 0.3


def tool(args, name, *rest, ok=(0,)):
    run = subprocess.run([args.tools / name, *map(str, rest)], stdout=subprocess.PIPE, env=dict(os.environ, RC_THREADS="1"))
    if run.returncode not in ok:
        raise SystemExit(f"{name} failed")
    return run.stdout


class Case:
    def __init__(self, args, folder, n, periodic):
        self.args, self.folder, self.n, self.periodic = args, folder, n, periodic
        self.nu = 0.5 if periodic else 0.3
        tool(args, "rc-synth", "selfaffine", "--nx", n, "--dx", "1", "--hurst", "0.8", "--rms-slope", "0.1", "--short-cut", "4",
             "--rolloff", n / 4, "--seed", 7, "-o", folder / "h.rcg")
        self.mean = 0.016 if periodic else 0.004
        how = ["--periodic"] if periodic else ["--radius", repr(10. * n)]
        tool(args, "rc-solve", "--quiet", *how, "--estar", "1", "--mean-pressure", self.mean, "--tol", "1e-9", "-o", folder / "p.rcg",
             folder / "h.rcg")
        self.h = self.values("p", "height")
        self.p = self.values("p", "pressure")
        self.force = MU * self.p.sum() / 2
        self.q, _ = self.ours(1e-10)

    def values(self, name, channel):
        tool(self.args, "rc-export", "--format", "npy", "--channel", channel, "-o", self.folder / "v.npy", self.folder / f"{name}.rcg")
        return np.load(self.folder / "v.npy")

    def ours(self, tol):
        tool(self.args, "rc-slip", "--quiet", "--mu", MU, "--nu", self.nu, "--tangential", repr(float(self.force)), "--increments", 1, "--tol", tol,
             "--report", self.folder / "r.json", "-o", self.folder / "q.rcg", self.folder / "p.rcg", ok=(0, 3))
        report = json.loads((self.folder / "r.json").read_text())
        q = np.stack([self.values("q", f"traction-{c}") for c in "xy"])
        return q, (report["convolutions"], report["seconds"]["total"])

    def error(self, q):
        return np.hypot(*(q - self.q)).sum() / np.hypot(*self.q).sum()


def first(found):
    """Returns, from (error, cost) in order of cost, the cost from which on the error stays below each level."""
    at = [None] * len(LEVELS)
    for error, cost in found:
        for k, level in enumerate(LEVELS):
            at[k] = None if error >= level else at[k] or cost
    return at


def ours(case):
    found = []
    for tol in 10 ** -np.arange(1, 7.6, 0.5):
        q, cost = case.ours(tol)
        found.append((case.error(q), cost))
    return first(found), found[-1][0]


def aspher(case):
    import aspher

    found = []
    for tol in 10 ** -np.arange(2, 7.1, 1.):
        solver = aspher.FrictionSolver(case.n, domain_size=1., E_star=1., nu=case.nu, model=aspher.CoulombFriction(MU))
        solver.set_gap((case.h.max() - case.h) / case.n)  # lengths over the side of the map, for which its tolerances are made
        area = case.n**2
        solver.step(p_bar=case.p.sum() / area, tol_normal=1e-9)
        began = time.perf_counter()
        r = solver.step(q_bar=(case.force / area, 0.), tol_tangential=tol)
        seconds = time.perf_counter() - began
        if not r.converged and r.status_reason:
            print(f"    aspher, tolerance {tol:.0e}: {r.status_reason}", flush=True)
            break
        q = np.stack([np.asarray(r.qx).reshape(case.n, case.n), np.asarray(r.qy).reshape(case.n, case.n)])
        error = min(case.error(q), case.error(-q))  # its tractions may act on either body
        found.append((error, (2 * r.tangential_iters, seconds)))
    return first(found), min((e for e, _ in found), default=None)


@contextlib.contextmanager
def silence():
    """What a library prints is nobody's business."""
    keep, null = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    try:
        yield
    finally:
        os.dup2(keep, 1)
        os.close(keep)
        os.close(null)


def tamaas(case):
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    n, found = case.n, []
    for most in 10, 20, 30, 50, 100, 200, 300, 500, 1000:
        model = tm.Model(tm.model_type.surface_2d, [float(n), float(n)], [n, n])
        model.E, model.nu = 1 - case.nu**2, case.nu
        solver = tm.PolonskyKeerTan(model, np.ascontiguousarray(case.h.T), 1e-14, MU)  # its x is along the first index
        solver.max_iter = most
        solver.dump_freq = most + 1
        began = time.perf_counter()
        with silence():
            solver.solve([case.force / n**2, 0., case.p.mean()])
        seconds = time.perf_counter() - began
        t = np.asarray(model.traction)
        found.append((case.error(np.stack([t[..., 0].T, t[..., 1].T])), (3 * most, seconds)))
    return first(found), min(e for e, _ in found)


def row(name, result):
    at, best = result
    cells = ["-" if c is None else f"{c[0]:.0f} ({c[1]:.2g} s)" for c in at]
    print(f"  {name:10s} " + "  ".join(f"{c:>16s}" for c in cells) + ("" if best is None else f"   best {best:.1e}"), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tools", type=Path, required=True)
    parser.add_argument("--sides", default="64,128", help="up to 1024")
    parser.add_argument("--alone", action="store_true", help="rc-slip only")
    args = parser.parse_args()
    args.tools = args.tools.resolve()
    for n in map(int, args.sides.split(",")):
        for periodic in False, True:
            with tempfile.TemporaryDirectory() as folder:
                case = Case(args, Path(folder), n, periodic)
                print(f"{n} x {n}, {'periodic' if periodic else 'free'}, {100 * (case.p > 0).mean():.0f} % in contact, to "
                      + ", ".join(f"{e:.0e}" for e in LEVELS))
                row("rc-slip", ours(case))
                if args.alone:
                    continue
                peer = tamaas if periodic else aspher
                try:
                    row(peer.__name__, peer(case))
                except ImportError:
                    print(f"  {peer.__name__}: not installed")


if __name__ == "__main__":
    main()
