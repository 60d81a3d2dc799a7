# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements: the settings that reach an error, their time in turns with rc-solve, the agreement of references."""
import json
import sys

import numpy as np

import cases
import solvers
from machine import wait_for_quiet


def distance(p, q):
    return float(np.abs(p - q).sum() / np.abs(q).sum())


def words(settings):
    return ", ".join(f"{k} {v:.1e}" if isinstance(v, float) else f"{k} {v}" for k, v in settings.items())


def kept(opts, what, peer, case):
    return opts.work / f"{what}-{peer}-{case}-{opts.n}.json"


def load(path, default):
    return json.loads(path.read_text()) if path.exists() else default


def own_reference(opts, peer, case):
    """The converged pressure of the peer; None if it has none."""
    path = opts.work / f"own-{peer}-{case}-{opts.n}.npy"
    if not path.exists():
        r = solvers.run(opts, peer, case, solvers.tightest(peer, cases.boundary(case)), 10 * opts.limit)
        np.save(path, np.zeros(0) if r is None else r[0])
    p = np.load(path)
    return p if p.size > 0 else None


class Sweep:
    """Runs of a peer on a case: settings, seconds, true error against both references. The results are kept, so that no run is repeated for its error."""

    def __init__(self, opts, peer, case):
        self.opts, self.peer, self.case = opts, peer, case
        self.path = kept(opts, "sweep", peer, case)
        self.runs = load(self.path, [])

    def __call__(self, settings):
        for r in self.runs:
            if r["settings"] == settings:
                return r
        got = solvers.run(self.opts, self.peer, self.case, settings)
        r = dict(settings=settings, seconds=None, error=np.inf, own=None, iterations=0)
        if got is not None:
            own = own_reference(self.opts, self.peer, self.case)
            ours = cases.reference(self.opts, self.case)[0]
            r.update(seconds=got[1], iterations=got[2], error=distance(got[0], ours),
                     own=None if own is None else distance(got[0], own))
        self.runs.append(r)
        self.path.write_text(json.dumps(self.runs))
        took = "failed, or over the limit" if got is None else f"{r['seconds']:.3f} s, error {r['error']:.1e}"
        print(f"# {self.case} {self.peer} {words(settings)}: {took}", file=sys.stderr, flush=True)
        return r


def climb(sweep, rungs, least):
    """Goes from loose to tight tolerances until `least` is reached, or until three tolerances with more steps have not reduced the error."""
    best, steps, idle = np.inf, -1, 0
    for settings in rungs:
        r = sweep(settings)
        if r["seconds"] is None:
            return
        if r["iterations"] != steps or r["iterations"] == 0:
            idle = 0 if r["error"] < 0.9 * best else idle + 1
        best, steps = min(best, r["error"]), r["iterations"]
        if best <= least or idle == 3:
            return


def candidates(opts, peer, case, error):
    """The loosest sufficient settings of each ladder, and of these the fastest two."""
    sweep, found = Sweep(opts, peer, case), []
    for rungs in solvers.ladders(peer, cases.boundary(case)):
        ours = sorted((r for r in sweep.runs if same(r["settings"], rungs[0])), key=lambda r: -r["settings"]["tol"])
        good = [r for r in ours if r["error"] <= error]
        if good:
            above = [r for r in ours if r["settings"]["tol"] > good[0]["settings"]["tol"]]
            found.append((good[0], above[-1] if above else None))
    found.sort(key=lambda pair: pair[0]["seconds"])
    return found[:2]


def same(a, b):
    """Settings of one ladder: all except the tolerance."""
    vary = ("tol", "float_floor")
    return {k: v for k, v in a.items() if k not in vary} == {k: v for k, v in b.items() if k not in vary}


def sweep(opts, peer, case):
    run = Sweep(opts, peer, case)
    for rungs in solvers.ladders(peer, cases.boundary(case)):
        climb(run, rungs, min(opts.errors))
    for error in opts.errors:  # between two tolerances, halved twice
        for good, above in candidates(opts, peer, case, error):
            for _ in range(2 if above is not None else 0):
                tol = float(f"{(good['settings']['tol'] * above['settings']['tol'])**0.5:.1e}")
                between = dict(good["settings"], tol=tol)
                if "float_floor" in between:
                    between["float_floor"] = min(2e-6, tol)
                r = run(between)
                good, above = (r, above) if r["error"] <= error else (good, r)


QUIET = 0.1  # the share of the machine that other programs may use during a valid run


def timed(opts, peer, case, error):
    """A row of the table: rc-solve and the peer's two fastest settings in turns; the shortest time of each among the undisturbed runs, of at most three times --repeat runs."""
    p, fraction = cases.reference(opts, case)
    own = own_reference(opts, peer, case)
    settings = [good["settings"] for good, _ in candidates(opts, peer, case, error)]
    row = dict(case=case, n=opts.n, contact=fraction, asked=error, peer=peer, reached=settings != [], ours=None,
               theirs=None)
    counted = 0

    def take(side, pressure, seconds, its, others, **more):
        if others > QUIET or distance(pressure, p) > error:
            return False
        if row[side] is None or seconds < row[side]["seconds"]:
            row[side] = dict(seconds=seconds, error=distance(pressure, p), iterations=its, others=others, **more)
        return True

    for _ in range(3 * opts.repeat):
        wait_for_quiet(opts.wait)
        r = cases.rc_solve(opts, case, error)
        quiet = take("ours", *r[:4], convolutions=r[4]["convolutions"])
        for s in settings:
            wait_for_quiet(opts.wait)
            r = solvers.run(opts, peer, case, s)
            quiet = r is not None and take("theirs", *r, settings=s,
                                           own=None if own is None else distance(r[0], own)) and quiet
        counted += quiet
        if counted == opts.repeat:
            break
    rows = [r for r in load(kept(opts, "timed", peer, case), []) if r["asked"] != error]
    kept(opts, "timed", peer, case).write_text(json.dumps(rows + [row]))


def agree(opts, peer, case):
    """The difference between the converged pressures of the peer and of rc-solve: dict or None."""
    own, (p, _) = own_reference(opts, peer, case), cases.reference(opts, case)
    if own is None:
        return None
    return dict(apart=distance(own, p), scaled=distance(own / own.mean() * p.mean(), p),
                load=float(own.mean() / p.mean() - 1))
