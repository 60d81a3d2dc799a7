# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces and loads, the grid stream, and the tools."""
import json
import os
import subprocess
import sys
import zlib

import numpy as np

from machine import Others

ESTAR, SLOPE, SPACING = 1e9, 0.1, 1e-6
# name: boundary, load. Periodic: mean pressure over E* and RMS slope; free: load as a part of that which
# makes a Hertz circle as wide as the map. Those of bench/solve.c without hardness.
CASES = {
    "periodic-1": ("periodic", 0.004),
    "periodic-10": ("periodic", 0.04),
    "periodic-37": ("periodic", 0.18),
    "periodic-50": ("periodic", 0.28),
    "periodic-97": ("periodic", 1.05),
    "sphere-2": ("free", 0.004),
    "sphere-19": ("free", 0.1),
}


def boundary(case):
    return CASES[case][0]


def side(n):
    return n * SPACING


def mean_pressure(case, n):
    where, load = CASES[case]
    if where == "periodic":
        return load * ESTAR * SLOPE
    radius = 20 * side(n)
    return load * 4 * ESTAR * (side(n) / 2)**3 / (3 * radius) / side(n)**2


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
    sys.exit(f"peers: {path}: no frame '{channel}'")


def write_heights(path, h):
    head = (f"RCG1\nchannel=height\nnx={h.shape[1]}\nny={h.shape[0]}\ndx={SPACING!r}\ndy={SPACING!r}\n"
            "unit=m\ntype=f64\n\n").encode()
    frame = head + np.ascontiguousarray(h, "<f8").tobytes()
    path.write_bytes(frame + f"crc32 {zlib.crc32(frame):08x}\nRCGEND 1\n".encode())


def tool(opts, name, *args, limit=None):
    env = dict(os.environ, RC_THREADS=str(opts.threads))
    return subprocess.run([str(opts.tools / name), *map(str, args)], env=env, timeout=limit).returncode


def made(opts, name, *args):
    if tool(opts, name, *args) != 0:
        sys.exit(f"peers: {name} failed")


def surface(opts, case):
    path = opts.work / f"{boundary(case)}-{opts.n}.rcg"
    if path.exists():
        return path
    part = opts.work / "part.rcg"
    grid = ["--nx", opts.n, "--dx", f"{SPACING!r}"]
    made(opts, "rc-synth", "selfaffine", "--hurst", 0.8, "--rms-slope", SLOPE, "--short-cut", repr(8 * SPACING),
         "--rolloff", repr(side(opts.n) / 8), "--seed", 5, *grid, "-o", part)
    h = read_stream(part, "height")
    if boundary(case) == "free":
        made(opts, "rc-synth", "sphere", "--radius", repr(20 * side(opts.n)), *grid, "-o", part)
        h = 0.05 * h + read_stream(part, "height")
    part.unlink()
    write_heights(path, h)
    return path


def rc_solve(opts, case, tol, method="pcg", limit=None):
    """Pressure, seconds, iterations, the processor share of other programs, the report; None if it took too long."""
    out, report = opts.work / "ours.rcg", opts.work / "ours.json"
    args = ["--estar", ESTAR, "--mean-pressure", repr(mean_pressure(case, opts.n)), "--tol", repr(tol),
            "--method", method, "--kernel", "fft", "--output", "pressure", "--report", report, "-o", out,
            "--threads", opts.threads, "--quiet"]
    if boundary(case) == "periodic":
        args.append("--periodic")
    heights, others = surface(opts, case), Others()
    try:
        if tool(opts, "rc-solve", *args, heights, limit=limit) not in (0, 3):
            return None
    except subprocess.TimeoutExpired:
        return None
    share = others.share()
    r = json.loads(report.read_text().splitlines()[0])
    seconds = r["seconds"]["setup"] + r["seconds"]["iterate"]
    return read_stream(out, "pressure"), seconds, r["iterations"], share, r


def reference(opts, case):
    """The pressure by rc-solve to 1e-9, and its contact fraction."""
    kept = opts.work / f"reference-{case}-{opts.n}.npy"
    if not kept.exists():
        np.save(kept, rc_solve(opts, case, 1e-9)[0])
    p = np.load(kept)
    return p, float((p > 0).mean())
