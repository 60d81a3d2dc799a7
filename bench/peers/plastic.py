#!/usr/bin/env python3
"""One load of a rough surface on a body that yields inside: rc-solve --yield beside Tamaas' EPICSolver.

    peers-venv/bin/python bench/peers/plastic.py --tools build/tools

The same 64 x 64 heights, 12 layers of one node, one increment, one thread. Tamaas has linear elements between 13
planes of nodes, rc-solve 12 slabs, so their solutions differ by what either makes of the depth. Evaluations: of the
residual there, of the volume's operator here. Its fixed point of contact and plasticity goes round at the relaxations of 0.3 and
more that were tried; 0.1 converges.
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

N, LAYERS, YIELD, HARDENING, MEAN = 64, 12, 0.04, 0.01, 0.02


def tool(args, name, *rest):
    return subprocess.run([args.tools / name, *rest], check=True, stdout=subprocess.PIPE,
                          env=dict(os.environ, RC_THREADS="1")).stdout


def ours(args, folder):
    began = time.perf_counter()
    tool(args, "rc-solve", "--quiet", "--periodic", "--mean-pressure", str(MEAN), "--E1", "1", "--nu1", "0.3", "--E2", "rigid",
         "--yield", f"{YIELD},{HARDENING}", "--increments", "1", "--slabs", ",".join(["1m"] * LAYERS),
         "--output", "pressure", "--report", folder / "r.json", "-o", folder / "p.rcg", folder / "h.rcg")
    seconds = time.perf_counter() - began
    report = json.loads((folder / "r.json").read_text())
    tool(args, "rc-export", "--format", "npy", "-o", folder / "p.npy", folder / "p.rcg")
    return np.load(folder / "p.npy"), seconds, report["applications"]


def tamaas(h, relaxation, cost, strain):
    import tamaas as tm
    from tamaas.nonlinear_solvers import DFSANESolver

    class Counting(DFSANESolver):
        count = 0

        def _scipy_solve(self, residual):
            def counted(x):
                Counting.count += 1
                return residual(x)
            return super()._scipy_solve(counted)

    tm.set_log_level(tm.LogLevel.warning)
    model = tm.Model(tm.model_type.volume_2d, [LAYERS, N, N], [LAYERS + 1, N, N])
    model.E, model.nu = 1, 0.3
    plastic = Counting(tm.Residual(model, tm.materials.IsotropicHardening(model, YIELD, HARDENING)))
    plastic.tolerance = strain
    began = time.perf_counter()
    tm.EPICSolver(tm.PolonskyKeerRey(model, h, 1e-8), plastic, cost, relaxation).solve(MEAN)
    return np.array(model.traction)[..., 2], time.perf_counter() - began, Counting.count


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tools", type=Path, default=Path("build/tools"))
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tool(args, "rc-synth", "selfaffine", "--nx", str(N), "--dx", "1", "--hurst", "0.8", "--rms-slope", "0.25",
             "--rolloff", "16", "--short-cut", "6.4", "--seed", "2", "-o", folder / "h.rcg")
        tool(args, "rc-export", "--format", "npy", "-o", folder / "h.npy", folder / "h.rcg")
        p, seconds, count = ours(args, folder)
        q, their_seconds, their_count = tamaas(np.load(folder / "h.npy").astype(float), 0.1, 1e-2, 1e-5)
    print(f"rc-solve  {count:5d} evaluations  {seconds:8.3f} s  contact {np.mean(p > 0):.3f}")
    print(f"Tamaas    {their_count:5d} evaluations  {their_seconds:8.3f} s  contact {np.mean(q > 0):.3f}")
    print(f"their pressures are {np.abs(p - q).sum() / p.sum():.1e} apart (L1)")


if __name__ == "__main__":
    main()
