# SPDX-License-Identifier: GPL-3.0-or-later
"""Wall time of rc-solve against other contact solvers, on the same heights, to the same true error.

    python bench/peers [-n SIZE] [--case NAME,...] [--peer NAME,...] [--error E,...] [--tools DIR] [--work DIR]
                       [--threads N] [--repeat N] [--limit S] [--wait S] [sweep | time | table | agree]

Peers are the Python packages aspher, tamaas and ContactMechanics, and `pk99`, the paper's method in rc-solve with
padded transforms: what one would write without further thought. A peer that is not installed is reported as not
measured. README.md one folder up says how to install them.

Surfaces come from rc-synth, the same file for all. A run's true error is sum |p - ref| / sum ref over the
nodes, against rc-solve at 1e-9 and against the peer's own tightest solution.

sweep   finds for each peer the settings that reach each error (default 1e-2, 1e-3, 1e-4, 1e-6): every ladder of
        tolerances in steps of half a decade, the last step halved twice for the quickest two ladders
time    runs rc-solve with `--tol E` and the peer's two quickest settings in turns
table   prints what `time` has found
agree   how far each peer's own converged pressure is from ours

Without one of them: all but the last. What was found is kept in --work, so that it can be done in pieces. Every run
is a process of its own. What is timed is the call that solves, from heights in memory to a pressure in memory, plans
and all set-up included, for both sides; importing a module, reading and writing are not. Before each timed run it
waits, up to --wait seconds, for other processes to rest; runs during which they took more than a tenth of the machine
do not count, and of --repeat others, in three times as many tries, the least does.
"""
import argparse
import sys
from pathlib import Path

import cases
import measure
import solvers
import tables


def listed(known, kind=str):
    def read(text):
        values = [kind(w) for w in text.split(",")]
        for v in values:
            if known and v not in known:
                raise argparse.ArgumentTypeError(f"'{v}': there are {', '.join(known)}")
        return values
    return read


def options():
    top = Path(__file__).resolve().parent.parent.parent
    a = argparse.ArgumentParser(prog="peers", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("-n", type=int, default=1024)
    a.add_argument("--case", dest="cases", type=listed(cases.CASES), default=[c for c in cases.CASES])
    a.add_argument("--peer", dest="peers", type=listed(solvers.PEERS), default=list(solvers.PEERS))
    a.add_argument("--error", dest="errors", type=listed(None, float), default=[1e-2, 1e-3, 1e-4, 1e-6])
    a.add_argument("--tools", type=Path, default=top / "build" / "tools")
    a.add_argument("--work", type=Path, default=Path("peers-work"))
    a.add_argument("--threads", type=int, default=2)
    a.add_argument("--repeat", type=int, default=3)
    a.add_argument("--limit", type=float, default=120.,
                   help="seconds for one run of a peer, ten times that for its reference")
    a.add_argument("--wait", type=float, default=20.)
    a.add_argument("what", nargs="?", choices=["sweep", "time", "table", "agree"])
    return a.parse_args()


def main():
    opts = options()
    opts.work.mkdir(parents=True, exist_ok=True)
    there = [p for p in opts.peers if solvers.version(p) is not None]
    for peer in there:
        for case in opts.cases:
            if opts.what in (None, "sweep"):
                measure.sweep(opts, peer, case)
            if opts.what in (None, "time"):
                for error in opts.errors:
                    measure.timed(opts, peer, case, error)
    if opts.what in (None, "table", "agree"):
        tables.heading(opts, opts.peers)
    if opts.what in (None, "table"):
        tables.times(opts, opts.peers)
    if opts.what == "agree":
        tables.agreement(opts, opts.peers)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        solvers.child(*sys.argv[2:])
    else:
        main()
