#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rough surfaces that attract each other: rc-solve --adhesion beside Adhesion's bounded L-BFGS-B and Tamaas' PolonskyKeerRey.

    peers-venv/bin/python bench/peers/adhesion.py --tools build/tools [--cases 64,128,256] [--alone]

Periodic, self-affine (H 0.8, slope 0.1, waves from 8 nodes up, flat above a quarter of the side), exponential law, approach
given, from undeformed bodies, one thread. Errors are L1, of the net pressure, against rc-solve's at --tol 1e-10, which both peers
confirm where they get there. Equivalents of a convolution there and back: rc-solve's own, stability and certificate included;
evaluations of L-BFGS-B, one each; iterations of Tamaas, two each. A dash: not reached, in 4000 evaluations or 500 iterations,
or because another minimum was found.

L-BFGS-B needs a stiffness of the mean, which a periodic half-space has not: it is given that of the longest wave, and an
offset with which the same state is the minimum. Seconds are those of the solution, without start and files. Tamaas is solved from the start for each number of iterations.
"""
import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

LEVELS = 1e-2, 1e-4, 1e-6
CASES = [(64, 0.05, 8, 0.5), (64, 0.1, 4, 0.3), (64, 0.1, 1, 0.75), (128, 0.05, 8, 0.45), (128, 0.1, 2, 0.8),
         (256, 0.05, 8, 0.5), (256, 0.1, 4, 0.85), (256, 0.1, 1, 0.75), (512, 0.05, 8, 0.6), (512, 0.1, 4, 0.85),
         (1024, 0.05, 8, 0.6), (1024, 0.1, 4, 0.85)]


def tool(args, name, *rest, ok=(0,)):
    run = subprocess.run([args.tools / name, *map(str, rest)], stdout=subprocess.PIPE, env=dict(os.environ, RC_THREADS="1"))
    if run.returncode not in ok:
        raise SystemExit(f"{name} failed")
    return run.stdout


class Case:
    def __init__(self, args, folder, n, strength, ell, depth):
        self.n, self.strength, self.ell, self.folder, self.args = n, strength, ell, folder, args
        self.work, self.range = ell * strength**2, ell * strength
        tool(args, "rc-synth", "selfaffine", "--nx", n, "--ny", n, "--dx", "1", "--hurst", "0.8", "--rms-slope", "0.1", "--short-cut", "8",
             "--rolloff", n / 4, "--seed", 1, "-o", folder / "h.rcg")
        self.h = self.values("h", "height")
        self.approach = depth * (self.h.max() - self.h.mean())
        self.c = self.approach - self.h.max()
        q = 2 * np.pi * np.fft.fftfreq(n)
        self.A = np.hypot(q[:, None], q[None, :]) / 2
        self.p, _, self.contact = self.ours(1e-10)

    def values(self, name, channel):
        tool(self.args, "rc-export", "--format", "npy", "--channel", channel, "-o", self.folder / "v.npy", self.folder / f"{name}.rcg")
        return np.load(self.folder / "v.npy")

    def ours(self, tol):
        tool(self.args, "rc-solve", "--quiet", "--periodic", "--estar", "1", "--adhesion", f"{self.work},exponential,{self.range}",
             "--approach", repr(float(self.approach)), "--tol", tol, "--output", "pressure", "--report", self.folder / "r.json",
             "-o", self.folder / "p.rcg", self.folder / "h.rcg", ok=(0, 3))
        report = json.loads((self.folder / "r.json").read_text())
        return self.values("p", "pressure"), (report["convolutions"], report["seconds"]["total"]), report["contact_fraction"]

    def pressure(self, gap):
        """Net pressure of a gap: A u, less its mean where the bodies are apart."""
        au = np.fft.ifft2(self.A * np.fft.fft2(gap + self.h)).real
        apart = gap > 0
        return au - (au + self.strength * np.exp(-gap / self.range))[apart].mean()

    def error(self, p):
        return np.abs(p - self.p).sum() / np.abs(self.p).sum()


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
        p, cost, _ = case.ours(tol)
        found.append((case.error(p), cost))
    return first(found)


def lbfgsb(case):
    from Adhesion.Interactions import Exponential
    from Adhesion.System import BoundedSmoothContactSystem
    from ContactMechanics import PeriodicFFTElasticHalfSpace
    from SurfaceTopography import Topography
    from scipy.optimize import minimize

    n = case.n
    stiffness = np.pi / n  # of the longest wave
    body = PeriodicFFTElasticHalfSpace((n, n), 1.0, (float(n), float(n)), stiffness_q0=stiffness)
    system = BoundedSmoothContactSystem(body, Exponential(case.work, case.range), Topography(case.h, (float(n), float(n)), periodic=True))
    offset = case.c + case.p.mean() / stiffness  # its displacement is u + mean(p)/stiffness
    gap = np.maximum(0, -case.h - case.c)
    fun, found, began = system.primal_objective(offset, gradient=True), [], time.perf_counter()
    lost = 0

    def counted(x):
        nonlocal lost
        start = time.perf_counter()
        g = np.maximum(x.reshape(n, n), 0)
        found.append((case.error(case.pressure(g)), (len(found) + 1, start - began - lost)))
        lost += time.perf_counter() - start
        value, slope = fun(x.reshape(n, n))
        return value, np.asarray(slope).ravel()

    minimize(counted, gap.ravel(), jac=True, method="L-BFGS-B", bounds=[(0, None)] * (n * n),
             options=dict(ftol=0, gtol=1e-14, maxcor=3, maxfun=4000, maxiter=4000))
    return first(found)


def tamaas(case):
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    n, found = case.n, []
    mean = -case.h.mean() - case.c
    for most in [*range(20, 200, 20), *range(200, 501, 50)]:
        model = tm.Model(tm.model_type.basic_2d, [float(n), float(n)], [n, n])
        model.E, model.nu = 1.0, 0.0
        kind = tm.PolonskyKeerRey.gap
        solver = tm.PolonskyKeerRey(model, case.h, 1e-14, kind, kind)
        attraction = tm.ExponentialAdhesionFunctional(case.h)
        attraction.parameters = {"rho": case.range, "surface_energy": case.work}
        solver.addFunctionalTerm(attraction)
        solver.max_iter = most
        began = time.perf_counter()
        try:
            solver.solve(mean)
        except Exception:
            pass
        seconds = time.perf_counter() - began
        gap = np.asarray(model['gap']).reshape(n, n)
        found.append((case.error(case.pressure(np.maximum(gap, 0))), (2 * most, seconds)))
    return first(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tools", type=Path, required=True)
    parser.add_argument("--cases", default="64,128,256", help="sides, to 1024")
    parser.add_argument("--alone", action="store_true", help="rc-solve only")
    args = parser.parse_args()
    sides = {int(n) for n in args.cases.split(",")}
    print("| n, sigma0/E*, cohesive length, contact | | 1e-2 | 1e-4 | 1e-6 | s to 1e-4 |\n| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for what in CASES:
            if what[0] not in sides:
                continue
            case = Case(args, Path(folder), *what)
            title = f"{what[0]}, {what[1]}, {what[2]}, {100 * case.contact:.0f} %"
            for name, run in (("rc-solve", ours), ("L-BFGS-B", lbfgsb), ("Tamaas", tamaas))[:1 if args.alone else 3]:
                at = run(case)
                costs = " | ".join("-" if a is None else f"{a[0]:.4g}" for a in at)
                print(f"| {title} | {name} | {costs} | {'-' if at[1] is None else f'{at[1][1]:.3g}'} |", flush=True)
                title = ""


if __name__ == "__main__":
    main()
