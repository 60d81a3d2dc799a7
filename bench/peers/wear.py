#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A rough surface that wears: rc-solve and rc-wear beside a loop of explicit steps around Tamaas' PolonskyKeerRey.

    peers-venv/bin/python bench/peers/wear.py --tools build/tools [--cases 128:100,256:1000] [--repeat 3] [--wide-step]

Periodic, self-affine (H 0.8, slope 0.1, waves from 8 nodes up, flat above a quarter of the side), mean pressure E*/200, Archard's law, one
thread. A case is a side in nodes and a distance in dx/(k E*). Each step of the loop solves the contact to 1e-4 from the last pressure
and takes k p ds off the heights; ds is 0.8 dx/(k E*), just below the limit of stability, which is 0.9. --wide-step adds a loop whose step is 1.5.

Errors are relative L1 errors of worn depth and pressure against rc-wear --tol 1e-3, whose contacts have a tolerance of 1e-5. At 128 nodes
a loop of Tamaas with steps of 0.1 and contacts to 1e-8 checks this reference. Seconds are processor seconds (user and system), the least of
the runs in turns: of rc-solve and rc-wear from start to end, files included; of Tamaas without start and files.
"""
import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

from machine import Others, processor  # noqa: E402

MEAN = 0.005  # of E*
STEP, WIDE = 0.8, 1.5  # dx/(k E*)
CHECKED = 128  # nodes: the largest map on which Tamaas checks the reference


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Case:
    """Lengths in dx = 1 um, E* = 1 GPa, k = 1e-15/Pa: a distance of 1 m is one dx/(k E*)."""

    def __init__(self, args, folder, n, distance):
        self.args, self.folder, self.n, self.distance = args, folder, n, distance
        self.tool("rc-synth", "selfaffine", "--nx", n, "--dx", "1um", "--hurst", "0.8", "--rms-slope", "0.1", "--short-cut", "8um",
                  "--rolloff", f"{n // 4}um", "--seed", 1, "-o", folder / "h.rcg")
        self.h = self.values("h", "height") / 1e-6
        self.reference = self.ours(1e-3)

    def tool(self, name, *rest):
        run = subprocess.run([self.args.tools / name, *map(str, rest)], env=dict(os.environ, RC_THREADS="1"))
        if run.returncode not in (0, 3):  # 3: an estimate is above a very small tolerance
            raise SystemExit(f"{name} failed")

    def values(self, name, channel):
        out = self.folder / "v.npy"
        self.tool("rc-export", "--format", "npy", "--channel", channel, "-o", out, self.folder / f"{name}.rcg")
        return np.load(out)

    def ours(self, tol):
        """Worn depth in dx, pressure over E*, processor and wall seconds, contacts."""
        work = self.folder
        used, began = processor_seconds(), time.perf_counter()
        self.tool("rc-solve", "--quiet", "--periodic", "--estar", "1GPa", "--mean-pressure", f"{MEAN}GPa", "-o", work / "p.rcg", work / "h.rcg")
        self.tool("rc-wear", "--quiet", "--coefficient", "1e-6mm3/Nm", "--distance", self.distance, "--tol", tol, "--report", work / "r.json",
                  "-o", work / "w.rcg", work / "p.rcg")
        spent = processor_seconds() - used, time.perf_counter() - began
        contacts = json.loads((work / "r.json").read_text())["contacts"]
        return self.values("w", "wear") / 1e-6, self.values("w", "pressure") / 1e9, *spent, contacts

    def theirs(self, step, tol):
        """The same of a loop, in a process of its own."""
        np.save(self.folder / "h.npy", self.h)
        subprocess.run([sys.executable, __file__, "--loop", self.folder, str(self.distance), str(step), str(tol)], check=True)
        r = np.load(self.folder / "loop.npz")
        return r["wear"], r["p"], float(r["cpu"]), float(r["wall"]), int(r["steps"])


def loop(folder, distance, step, tol):
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    h = np.load(folder / "h.npy").astype(float)
    n = h.shape[0]
    steps = int(np.ceil(distance / step - 1e-9))
    each = distance / steps / n  # lengths over the side of the map, for which its tolerances are made
    worn = np.zeros_like(h)
    cpu, wall = time.process_time(), time.perf_counter()
    model = tm.Model(tm.model_type.basic_2d, [1., 1.], [n, n])
    model.E, model.nu = 1., 0.
    surface = h / n
    solver = tm.PolonskyKeerRey(model, surface, tol)
    solver.max_iter = 20000
    for _ in range(steps):
        solver.solve(MEAN)
        less = each * np.asarray(model.traction)
        worn += less
        surface -= less  # the solver sees it: it keeps no copy
    solver.solve(MEAN)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    np.savez(folder / "loop.npz", wear=worn * n, p=np.array(model.traction), cpu=cpu, wall=wall, steps=steps)


def differ(a, b):
    return np.abs(a - b).sum() / np.abs(b).sum()


def row(case, name, run, ratio=None):
    wear, p, cpu, wall, steps = run
    ref = case.reference
    print(f"| {case.n}, {case.distance:g} | {name} | {steps} | {cpu:.3g} | {wall:.3g} | {differ(wear, ref[0]):.1e} | {differ(p, ref[1]):.1e} | "
          f"{p.max() / ref[1].max() - 1:+.1%} | {'' if ratio is None else f'{ratio:.0f}'} |", flush=True)


def compare(case, repeat, wide):
    ours = theirs = None
    for _ in range(repeat):
        a = case.ours(0.1)
        b = case.theirs(STEP, 1e-4)
        ours = a if ours is None or a[2] < ours[2] else ours
        theirs = b if theirs is None or b[2] < theirs[2] else theirs
    row(case, "rc-solve and rc-wear", ours)
    row(case, f"Tamaas, steps of {STEP}", theirs, theirs[2] / ours[2])
    if wide:
        row(case, f"Tamaas, steps of {WIDE}", case.theirs(WIDE, 1e-4))
    if case.n <= CHECKED:
        row(case, "Tamaas, steps of 0.1, contacts to 1e-8", case.theirs(0.1, 1e-8))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tools", type=Path, required=True)
    parser.add_argument("--cases", default="128:100,256:1000", help="SIDE:DISTANCE")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--wide-step", action="store_true")
    args = parser.parse_args()
    args.tools = args.tools.resolve()
    others = Others()
    print("| nodes, distance | | contacts or steps | processor s | wall s | error of wear | of p | max p | ratio |")
    print("|" + " --- |" * 9)
    for what in args.cases.split(","):
        n, distance = what.split(":")
        with tempfile.TemporaryDirectory() as folder:
            compare(Case(args, Path(folder), int(n), float(distance)), args.repeat, args.wide_step)
    print(f"\n{time.strftime('%Y-%m-%d')}; {processor()}; other programs used {others.share():.0%} of {os.cpu_count()} cores")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--loop"]:
        loop(Path(sys.argv[2]), *map(float, sys.argv[3:6]))
    else:
        main()
