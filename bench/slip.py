#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Convolutions of rc-slip to estimated errors of 1e-2 and 1e-4 on maps, profiles and long cells.

    bench/slip.py BUILD [SIDE,SIDE...]      BUILD holds the tools; sides of the square maps, 128 without

The maps are self-affine, mu is 0.3, and the force is 0.1, 0.5 and 0.95 of the limit in one increment. Counts
of dissimilar bodies are those of one pass, with its contact, for the leg that takes most."""
import json
import os
import subprocess
import sys
import tempfile

SIMILAR = (["--nu", "0.3"], ["--estar", "100GPa"])  # options of rc-slip, of rc-solve
DISSIMILAR = ([], "--E1 100GPa --nu1 0.3 --E2 rigid".split())


def run(*args):
    done = subprocess.run(args, capture_output=True, text=True)
    if done.returncode not in (0, 3):  # 3: not converged
        sys.exit(done.stderr)


def report(name):
    with open(name) as f:
        return [json.loads(line) for line in f]


def contact(nx, ny, dy, boundary, pressure, pair):
    """Writes p.rcg, a contact under this mean pressure. Returns its figures."""
    run("rc-synth", "selfaffine", "--nx", str(nx), "--ny", str(ny), "--dx", "1um", "--dy", f"{dy}um",
        "--hurst", "0.8", "--rms-slope", "0.05", "--rolloff", f"{max(nx, ny * dy) / 4}um",
        "--short-cut", f"{4 * dy}um", "--seed", "5", "-o", "s.rcg")
    run("rc-solve", "--quiet", "s.rcg", "-o", "p.rcg", "--tol", "1e-6", "--report", "p.json",
        "--mean-pressure", pressure, *pair, *boundary)
    return report("p.json")[0]


def count(title, nx, ny, dy, boundaries, pressures, bodies=SIMILAR):
    most = {"1e-2": 0, "1e-4": 0}
    for boundary in boundaries:
        for pressure in pressures:
            load = contact(nx, ny, dy, boundary, pressure, bodies[1])["load"]
            for part in (0.1, 0.5, 0.95):
                for tol in most:
                    run("rc-slip", "--quiet", "p.rcg", "-o", "q.rcg", "--mu", "0.3", "--tangential",
                        f"{part * 0.3 * load:.9g}N", *bodies[0], "--tol", tol, "--increments", "1",
                        "--report", "q.json")
                    legs = report("q.json")
                    if not all(leg["converged"] for leg in legs):
                        sys.exit(f"{title}, {pressure}, {part}: not converged to {tol}")
                    passes = [leg["passes"] if bodies is DISSIMILAR else 1 for leg in legs]
                    most[tol] = max(most[tol], *(leg["convolutions"] / n for leg, n in zip(legs, passes)))
    print(f"{title:28} {most['1e-2']:6.1f} {most['1e-4']:6.1f}", flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    os.environ["PATH"] = os.path.join(os.path.abspath(sys.argv[1]), "tools") + ":" + os.environ["PATH"]
    sides = sys.argv[2] if len(sys.argv) > 2 else "128"
    periodic, free, usual = ["--periodic"], [], ["0.6GPa"]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for n in map(int, sides.split(",")):
            count(f"{n} x {n}", n, n, 1, (periodic, free), ("0.15GPa", "0.6GPa", "1.8GPa"))
        for n in (1024, 16384):
            count(f"profile {n}", n, 1, 1, (periodic,), usual)
            count(f"dissimilar profile {n}", n, 1, 1, (periodic,), usual, DISSIMILAR)
        count("cells 1:100, periodic", 128, 128, 100, (periodic,), usual)
        count("cells 1:100, free", 128, 128, 100, (free,), usual)
