# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares areal parameters and spectra of rc-info with those of other programs, on the same heights.

    python bench/areal [--tools DIR] [--gwyddion LIBRARY] FILE...

FILEs are any files that rc-import reads. rc-import reads each once; the other programs get its heights as an array, so that readers are not compared. The other programs are the Python packages surfalize and SurfaceTopography, and libgwyprocess2 of Gwyddion,
which needs no display. A message names programs that are not installed. README.md one folder up says how to install
them, and why figures differ.
"""
import argparse
import ctypes
import ctypes.util
import json
import subprocess
import tempfile
import warnings
from pathlib import Path

import numpy as np

warnings.filterwarnings("ignore")

NAMES = ("Sq Sa Ssk Sku Sp Sv Sz Sdq Sdr Sal Str Std Sk Spk Svk Smr1 Smr2 Vmp Vmc Vvc Vvv Sxp").split()


class Heights:
    def __init__(self, tools, file, folder):
        stream, array = folder / "heights.rcg", folder / "heights.npy"
        subprocess.run([tools / "rc-import", file, "-o", stream], check=True)
        subprocess.run([tools / "rc-export", "--format", "npy", "-o", array, stream], check=True)
        told = subprocess.run([tools / "rc-info", "--json", "--areal", "--psd", stream], check=True, capture_output=True)
        self.told = json.loads(told.stdout)
        self.h = np.load(array).astype(float)
        self.dx, self.dy = self.told["dx"], self.told["dy"]


def ours(m):
    return {name: m.told["areal"][name.lower()] for name in NAMES}


def by_surfalize(m):
    from surfalize import Surface
    s = Surface(m.h * 1e6, m.dx * 1e6, m.dy * 1e6)
    unit = dict.fromkeys("Sq Sa Sp Sv Sz Sal Sk Spk Svk Vmp Vmc Vvc Vvv Sxp".split(), 1e-6)
    unit |= dict.fromkeys(("Sdr", "Smr1", "Smr2"), 1e-2)
    return {name: float(getattr(s, name)()) * unit.get(name, 1) for name in NAMES}


def by_surface_topography(m):
    from SurfaceTopography import Topography
    ny, nx = m.h.shape
    t = Topography(m.h.T - m.h.mean(), (nx * m.dx, ny * m.dy), unit="m")
    return {"Sq": t.rms_height_from_area(), "Sdq": t.rms_gradient()}


def by_gwyddion(m, library):
    ctypes.CDLL(str(library).replace("gwyprocess2", "gwyddion2"), mode=ctypes.RTLD_GLOBAL)  # it does not request it itself
    g = ctypes.CDLL(library)
    g.gwy_data_field_new.restype = g.gwy_data_field_get_data.restype = ctypes.c_void_p
    for name in ("get_surface_area", "get_surface_slope", "get_min", "get_max", "fractal_psdf_dim"):
        getattr(g, "gwy_data_field_" + name).restype = ctypes.c_double
    ny, nx = m.h.shape
    real = [ctypes.c_double(v) for v in (nx * m.dx, ny * m.dy)]
    f = ctypes.c_void_p(g.gwy_data_field_new(nx, ny, *real, 0))
    h = np.ascontiguousarray(m.h)
    ctypes.memmove(g.gwy_data_field_get_data(f), h.ctypes.data, h.nbytes)
    mean, ra, rms, skew, kurtosis = (ctypes.c_double() for _ in range(5))
    g.gwy_data_field_get_stats(f, *map(ctypes.byref, (mean, ra, rms, skew, kurtosis)))
    low, high = g.gwy_data_field_get_min(f), g.gwy_data_field_get_max(f)
    return {"Sq": rms.value, "Sa": ra.value, "Ssk": skew.value, "Sku": kurtosis.value + 3,
            "Sp": high - mean.value, "Sv": mean.value - low, "Sz": high - low,
            "Sdq": g.gwy_data_field_get_surface_slope(f),
            "Sdr": g.gwy_data_field_get_surface_area(f) / (real[0].value * real[1].value) - 1}


def spectrum(m):
    """Wave numbers, the spectrum of rc-info, that of SurfaceTopography."""
    from SurfaceTopography import Topography
    ny, nx = m.h.shape
    t = Topography(m.h.T - m.h.mean(), (nx * m.dx, ny * m.dy), unit="m")
    psd = m.told["psd"]
    q, c = np.array(psd["q"]), np.array(psd["c"])
    theirs_q, theirs_c = t.power_spectrum_from_area(window="hann", reliable=False)
    good = np.isfinite(theirs_c) & (theirs_q > 0) & (theirs_c > 0)
    at = np.geomspace(q[5], 0.8 * np.pi / max(m.dx, m.dy), 6)
    theirs = np.exp(np.interp(np.log(at), np.log(theirs_q[good]), np.log(theirs_c[good])))
    ours = np.exp(np.interp(np.log(at), np.log(q), np.log(c)))
    return at, ours, theirs


def cell(value):
    return "-" if value is None else "undefined" if not np.isfinite(value) else f"{value:.6g}"


def show(m, others):
    mine = ours(m)
    columns = {}
    for name, find in others.items():
        try:
            columns[name] = find(m)
        except (ImportError, OSError) as e:
            print(f"{name}: not measured ({e})\n")
    print("| | rc-info | " + " | ".join(columns) + " |\n|" + " --- |" * (len(columns) + 2))
    for name in NAMES:
        value = mine[name] if mine[name] is not None else float("nan")
        print(f"| {name} | {cell(value)} | " + " | ".join(cell(c.get(name)) for c in columns.values()) + " |")
    print()
    if "SurfaceTopography" in columns and np.isfinite(m.h).all():
        print("| q, rad/m | c, m4 | SurfaceTopography |\n| --- | --- | --- |")
        for row in zip(*spectrum(m)):
            print("| " + " | ".join(f"{v:.4g}" for v in row) + " |")
        print()


def main():
    top = Path(__file__).resolve().parent.parent.parent
    a = argparse.ArgumentParser(prog="areal", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--tools", type=Path, default=top / "build" / "tools")
    a.add_argument("--gwyddion", default=ctypes.util.find_library("gwyprocess2") or "libgwyprocess2.so.0")
    a.add_argument("file", nargs="+", type=Path)
    a = a.parse_args()
    others = {"surfalize": by_surfalize, "SurfaceTopography": by_surface_topography,
              "Gwyddion": lambda m: by_gwyddion(m, a.gwyddion)}
    for file in a.file:
        with tempfile.TemporaryDirectory() as folder:
            m = Heights(a.tools, file, Path(folder))
        print(f"**{file.name}**, {m.h.shape[1]} x {m.h.shape[0]} nodes\n")
        show(m, others)


main()
