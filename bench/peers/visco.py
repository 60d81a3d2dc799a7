#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Creep of a rough contact: rc-solve --relaxation beside Tamaas' MaxwellViscoelastic.

    peers-venv/bin/python bench/peers/visco.py --tools build/tools [--nodes 256] [--steps 10,50]

Periodic, self-affine (H 0.8, slope 0.1, waves from 8 nodes up, flat above a quarter of the side), mean pressure E(0)/200, suddenly at 0 s,
one thread. E(t) is 0.2 + 0.8 exp(-t/s) of E(0), nu is 0, and the results are those at 1 s. The exact contact area is that of the elastic
contact under the load times J(1 s)/J(0), because the load only rises. Seconds are processor seconds, of rc-solve with its files.
"""
import argparse
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

MEAN, RELAXED = 0.005, 0.2  # of E(0)


def run(tools, name, *rest):
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([tools / name, *map(str, rest)], env=dict(os.environ, RC_THREADS="1"), check=True)
    now = resource.getrusage(resource.RUSAGE_CHILDREN)
    return now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime


def theirs(h, steps):
    """Contact fraction after the steps, and processor seconds."""
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    n = h.shape[0]
    model = tm.Model(tm.model_type.basic_2d, [1., 1.], [n, n])
    model.E, model.nu = RELAXED, 0.
    surface = np.ascontiguousarray(h / n)
    used = time.process_time()
    solver = tm.MaxwellViscoelastic(model, surface, 1e-6 * MEAN, 1 / steps, [(1 - RELAXED) / 2], [1.])
    for _ in range(steps):
        solver.solve(MEAN)
    return float((np.asarray(model.traction) > 0).mean()), time.process_time() - used


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--tools", type=Path, required=True)
    p.add_argument("--nodes", type=int, default=256)
    p.add_argument("--steps", default="10,50")
    args = p.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(args.tools, "rc-synth", "selfaffine", "--nx", args.nodes, "--dx", "1um", "--hurst", "0.8", "--rms-slope", "0.1", "--short-cut", "8um",
            "--rolloff", f"{args.nodes // 4}um", "--seed", 1, "-o", folder / "h.rcg")
        run(args.tools, "rc-export", "--format", "npy", "--channel", "height", "-o", folder / "h.npy", folder / "h.rcg")
        grown = 5 - 4 * math.exp(-RELAXED)  # J(1 s)/J(0)
        run(args.tools, "rc-solve", "--quiet", "--periodic", "--estar", "1GPa", "--mean-pressure", MEAN * grown * 1e9, "--tol", "1e-6", "--report",
            folder / "exact.json", "-o", folder / "p.rcg", folder / "h.rcg")
        exact = json.loads((folder / "exact.json").read_text())["contact_fraction"]
        print(f"{args.nodes} x {args.nodes} nodes; exact contact fraction at 1 s: {exact:.5f}")
        used = run(args.tools, "rc-solve", "--quiet", "--periodic", "--relaxation", "0.2GPa,0.8GPa:1s", "--nu1", "0", "--E2", "rigid", "--mean-pressure",
                   MEAN * 1e9, "--time", "1s", "--report", folder / "r.json", "-o", folder / "p.rcg", folder / "h.rcg")
        r = json.loads((folder / "r.json").read_text())
        print(f"rc-solve, {r['increments']} steps: {r['contact_fraction']:.5f}, {used:.2f} s, estimated error of the pressure "
              f"{r['pressure_error_estimate']:.1e}, {r['convolutions']:.0f} equivalents")
        h = np.load(folder / "h.npy").astype(float) / 1e-6
        for steps in map(int, args.steps.split(",")):
            area, spent = theirs(h, steps)
            print(f"Tamaas, {steps} steps: {area:.5f}, {spent:.2f} s")


if __name__ == "__main__":
    sys.exit(main())
