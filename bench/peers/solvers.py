# SPDX-License-Identifier: GPL-3.0-or-later
"""The peers: their calls, and the settings that are tried.

Each `solve` returns pressure over E*, seconds and iterations. They get lengths over the side of the map and pressures over E*, which suits absolute tolerances.
"""
import importlib.metadata
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import cases
from machine import Others


def aspher(h, p, boundary, s):
    import aspher as package
    gap = np.ascontiguousarray(-h.ravel())
    options = dict(grid_size=h.shape[0], gap=gap, p_nominal=p, light_result=True, **s)
    began = time.perf_counter()
    r = package.solve_nested(**options)
    return r.pressure, time.perf_counter() - began, r.iterations


def tamaas(h, p, boundary, s):
    import tamaas as tm
    tm.set_log_level(tm.LogLevel.error)
    primal = getattr(tm.PolonskyKeerRey, s["primal"])
    began = time.perf_counter()
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1., 1.], list(h.shape))
    model.E, model.nu = 1., 0.  # before registerNonPeriodic, which takes them
    if boundary == "free":
        tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(model, h, s["tol"], primal, tm.PolonskyKeerRey.pressure)
    if boundary == "free":
        solver.setIntegralOperator("dcfft")
    solver.max_iter = s.get("max_iter", 20000)
    solver.solve(p)
    return np.array(model.traction), time.perf_counter() - began, 0


def contactmechanics(h, p, boundary, s):
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


TOLERANCES = [float(f"{t:.1e}") for t in 10.**-np.arange(2, 13.1, 0.5)]  # loose to tight


def aspher_ladders(boundary):
    kinds = ([dict(backend="periodic")] if boundary == "periodic" else
             [dict(backend="h2", active_set=True), dict(backend="fft")])
    # precision: coarse tolerances, tolerances. If the tolerance for single precision (default 2e-6) is below
    # 1e-7 the iteration does not end; above it double precision follows at once.
    precisions = {"double": ([1e-4], TOLERANCES),
                  "float": ([1e-4, 1e-2], [tol for tol in TOLERANCES if tol > 5e-8]),
                  "float_then_double": ([1e-4, 1e-2], [tol for tol in TOLERANCES if tol < 5e-6])}

    def floor(precision, tol):
        return dict(float_floor=min(2e-6, tol)) if precision == "float" else {}

    return [[dict(kind, precision=precision, coarse_tol=coarse, tol=tol, **floor(precision, tol)) for tol in tols]
            for kind in kinds for precision, (coarses, tols) in precisions.items() for coarse in coarses
            if not (precision == "float_then_double" and kind["backend"] == "h2")]  # refused by it


def tamaas_ladders(boundary):
    primals = ["pressure", "gap"] if boundary == "periodic" else ["pressure"]
    return [[dict(primal=primal, tol=tol) for tol in TOLERANCES] for primal in primals]


def contactmechanics_ladders(boundary):
    return [[dict(tol=tol) for tol in TOLERANCES if tol <= 1e-3]]  # a length, over the side of the map


def pk99_ladders(boundary):
    return [[dict(method="pk99", tol=10 * tol) for tol in TOLERANCES if tol > 1e-8]]


# name: package (None: ours), one solve, ladders of settings, the tightest settings
PEERS = {
    "aspher": ("aspher", aspher, aspher_ladders,
               lambda boundary: dict(backend="periodic" if boundary == "periodic" else "fft", precision="double",
                                     tol=1e-12, max_iter=3000)),
    "Tamaas": ("tamaas", tamaas, tamaas_ladders,
               lambda boundary: dict(primal="pressure", tol=1e-13, max_iter=1000)),
    "ContactMechanics": ("ContactMechanics", contactmechanics, contactmechanics_ladders,
                         lambda boundary: dict(tol=1e-14)),
    "pk99": (None, None, pk99_ladders, lambda boundary: dict(method="pk99", tol=1e-8)),
}


def version(peer):
    """None if it is not installed."""
    package = PEERS[peer][0]
    if package is None:
        return "of rc-solve"
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def ladders(peer, boundary):
    return PEERS[peer][2](boundary)


def tightest(peer, boundary):
    return PEERS[peer][3](boundary)


def run(opts, peer, case, settings, limit=None):
    """Pressure, seconds, iterations, share of other programs; None if it failed or took longer than the limit."""
    limit = limit or opts.limit
    if PEERS[peer][0] is None:
        r = cases.rc_solve(opts, case, settings["tol"], settings["method"], limit)
        return r and r[:4]
    out = opts.work / "theirs.npy"
    env = dict(os.environ)
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        env[name] = str(opts.threads)
    args = [sys.executable, str(Path(__file__).parent), "--child", peer, str(cases.surface(opts, case)), str(opts.n),
            repr(cases.mean_pressure(case, opts.n) / cases.ESTAR), cases.boundary(case), json.dumps(settings), str(out)]
    try:
        done = subprocess.run(args, env=env, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        print(f"# {peer} {case} {settings}: {(done.stderr.strip() or 'died').splitlines()[-1]}", file=sys.stderr)
        return None
    r = json.loads(done.stdout.splitlines()[-1])
    return np.load(out).reshape(opts.n, opts.n) * cases.ESTAR, r["seconds"], r["iterations"], r["others"]


def child(peer, heights, n, p, boundary, settings, out):
    """One solve in this process: writes the pressure, prints seconds and iterations."""
    h = cases.read_stream(Path(heights), "height") / cases.side(int(n))
    others = Others()
    q, seconds, iterations = PEERS[peer][1](h, float(p), boundary, json.loads(settings))
    share = others.share()
    np.save(out, q)
    print(json.dumps(dict(seconds=seconds, iterations=iterations, others=share)))
