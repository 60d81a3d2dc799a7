# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of the machine, and the load by other programs."""
import os
import time


class Others:
    """The share of the machine that other processes used in this time."""

    def __init__(self):
        self.began = self.now()

    @staticmethod
    def now():
        ticks = [int(w) for w in open("/proc/stat").readline().split()[1:9]]
        t = os.times()
        return (sum(ticks) - ticks[3] - ticks[4]) / os.sysconf("SC_CLK_TCK"), sum(t[:4]), time.perf_counter()

    def share(self):
        busy, mine, wall = (b - a for a, b in zip(self.began, self.now()))
        return max(0., busy - mine) / (wall * os.cpu_count())


def wait_for_quiet(seconds=20.):
    """Waits until no other program computes, at most this long."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        others = Others()
        time.sleep(0.15)
        if others.share() < 0.05:
            return


def processor():
    keys = dict(line.split(":", 1) for line in open("/proc/cpuinfo") if ":" in line)
    keys = {k.strip(): v.strip() for k, v in keys.items()}
    return f"{keys.get('model name', '?')} (family {keys.get('cpu family', '?')}, model {keys.get('model', '?')})"
