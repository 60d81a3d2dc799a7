# SPDX-License-Identifier: GPL-3.0-or-later
"""The printed tables, in Markdown."""
import os
import subprocess
import time

import cases
import measure
import solvers
from machine import processor


def heading(opts, peers):
    ours = subprocess.run([opts.tools / "rc-solve", "--version"], capture_output=True, text=True)
    versions = ", ".join(f"{p} {solvers.version(p) or '(not installed: not measured)'}" for p in peers)
    print(f"{time.strftime('%Y-%m-%d')}; {processor()}, {opts.threads} of {os.cpu_count()} threads; "
          f"{ours.stdout.splitlines()[0]}; {versions}.\n")


def shown(value, form):
    return "-" if value is None else format(value, form)


def row(r, peer):
    ours, theirs = r["ours"], r["theirs"]
    head = f"| {r['case']} | {r['n']} | {100 * r['contact']:.1f} % | {r['asked']:.0e} |"
    if ours is None:
        return head + f" not measured: others were at work | - | - | {peer} | - | - | - | - | - | - |"
    head += f" {ours['seconds']:.3f} | {ours['error']:.1e} | {ours['iterations']} | {peer} |"
    if theirs is None:
        why = "not measured: others were at work" if r["reached"] else "not reached"
        return head + f" {why} | - | - | - | - | - |"
    return head + (f" {theirs['seconds']:.3f} | {theirs['error']:.1e} | {shown(theirs['own'], '.1e')} | "
                   f"{theirs['iterations'] or '-'} | {theirs['seconds'] / ours['seconds']:.2f} | "
                   f"{measure.words(theirs['settings'])} |")


def times(opts, peers):
    print("| case | grid | contact | asked | rc-solve, s | error | steps | peer | s | error | by its own | steps | "
          "ratio | peer's settings |")
    print("|" + " --- |" * 14)
    rows = []
    for peer in peers:
        if solvers.version(peer) is None:
            continue
        for case in opts.cases:
            for r in sorted(measure.load(measure.kept(opts, "timed", peer, case), []), key=lambda r: -r["asked"]):
                if r["asked"] in opts.errors:
                    rows.append(r)
                    print(row(r, peer))
    ahead(rows)


def ahead(rows):
    """The faster program for each error."""
    print()
    for asked in sorted({r["asked"] for r in rows}, reverse=True):
        for peer in dict.fromkeys(r["peer"] for r in rows):
            these = [r for r in rows if r["asked"] == asked and r["peer"] == peer]
            both = [r for r in these if r["ours"] and r["theirs"]]
            ratios = {r["case"]: r["theirs"]["seconds"] / r["ours"]["seconds"] for r in both}
            behind = [f"{case} ({ratio:.2f})" for case, ratio in ratios.items() if ratio < 1]
            if not ratios:
                print(f"- {asked:.0e}: {peer} " + ("was not measured." if any(r["reached"] for r in these)
                                                   else "did not reach it."))
                continue
            print(f"- {asked:.0e}: {peer} takes {min(ratios.values()):.2f} to {max(ratios.values()):.2f} times as "
                  "long; " + (f"rc-solve is behind on {', '.join(behind)}." if behind else "rc-solve is ahead on all."))


def agreement(opts, peers):
    print("| case | grid | peer | its tightest settings | relative L1 distance | scaled to our load | "
          "its load off by |")
    print("|" + " --- |" * 7)
    for peer in peers:
        if solvers.version(peer) is None:
            continue
        for case in opts.cases:
            a = measure.agree(opts, peer, case)
            words = measure.words(solvers.tightest(peer, cases.boundary(case)))
            print(f"| {case} | {opts.n} | {peer} | {words} | " +
                  ("no answer | - | - |" if a is None else
                   f"{a['apart']:.1e} | {a['scaled']:.1e} | {a['load']:.0e} |"), flush=True)
