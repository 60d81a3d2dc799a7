#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""One load of a rough surface on a body that yields inside: this library beside Tamaas' EPICSolver.

    cmake --build build --target bench-plastic
    peers-venv/bin/python bench/peers/plastic.py --build build

The same 64 x 64 heights, 12 layers of one node, one increment, one thread. Tamaas has linear elements between 13 planes of nodes,
the library 12 slabs, so each is measured against its own solution, iterated until the pressure moves by less than 1e-7 (Tamaas) or 1e-9.
Evaluations: of the residual there, of the volume's operator here. Seconds are those of the processor. Tamaas is run at several
tolerances of its inner solver and relaxations of its fixed point of contact and plasticity; at 0.3 it goes round, at 0.1 and 0.2 it converges.
"""
import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

N, LAYERS, YIELD, HARDENING, MEAN = 64, 12, 0.04, 0.01, 0.02
ERRORS = 1e-2, 1e-3
WAYS = (0.1, 1e-6), (0.2, 1e-6), (0.2, 1e-4)  # relaxation, tolerance of the strain


def tool(args, name, *rest):
    return subprocess.run([args.build / name, *rest], check=True, stdout=subprocess.PIPE,
                          env=dict(os.environ, RC_THREADS="1")).stdout


def tamaas(h, relaxation, strain):
    """Evaluations, seconds and pressure before each plastic solve, and at the end."""
    import tamaas as tm
    from tamaas.nonlinear_solvers import DFSANESolver

    passed, count, began = [], 0, time.process_time()

    def note():
        passed.append((count, time.process_time() - began, np.array(model.traction)[..., 2].copy()))

    class Counting(DFSANESolver):
        def _scipy_solve(self, residual):
            def counted(x):
                nonlocal count
                count += 1
                return residual(x)
            note()
            return super()._scipy_solve(counted)

    tm.set_log_level(tm.LogLevel.warning)
    model = tm.Model(tm.model_type.volume_2d, [LAYERS, N, N], [LAYERS + 1, N, N])
    model.E, model.nu = 1, 0.3
    plastic = Counting(tm.Residual(model, tm.materials.IsotropicHardening(model, YIELD, HARDENING)))
    plastic.tolerance = strain
    tm.EPICSolver(tm.PolonskyKeerRey(model, h.copy(), 1e-10), plastic, 1e-6, relaxation).solve(MEAN)
    note()
    return passed


def first(passed, error):
    return next((n, s) for n, s, e in passed if e <= error)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=Path("build"))
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tool(args, "tools/rc-synth", "selfaffine", "--nx", str(N), "--dx", "1", "--hurst", "0.8", "--rms-slope", "0.25",
             "--rolloff", "16", "--short-cut", "6.4", "--seed", "2", "-o", folder / "h.rcg")
        tool(args, "tools/rc-export", "--format", "npy", "-o", folder / "h.npy", folder / "h.rcg")
        h = np.load(folder / "h.npy").astype(float)
    rows = [line.split() for line in tool(args, "bench/bench-plastic", "increment").decode().splitlines()[1:]]
    ours = [(int(n), float(s), float(e)) for n, s, e in (row for row in rows if len(row) == 3)]
    runs = [tamaas(h, *way) for way in WAYS]
    limit = runs[1][-1][2]
    print(f"{'':34s} {'error':>7s} {'evaluations':>12s} {'cpu, s':>8s}")
    for error in ERRORS:
        print(f"{'libcontact':34s} {error:7.0e} {first(ours, error)[0]:12d} {first(ours, error)[1]:8.3f}")
        for (relaxation, strain), run in zip(WAYS, runs):
            off = [(n, s, np.abs(p - limit).sum() / limit.sum()) for n, s, p in run]
            print(f"{f'Tamaas, relaxation {relaxation}, strain {strain:.0e}':34s} {error:7.0e} {first(off, error)[0]:12d} "
                  f"{first(off, error)[1]:8.3f}")


if __name__ == "__main__":
    main()
