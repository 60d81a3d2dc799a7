# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact of rough surfaces: the rc-* tools as functions on numpy arrays.

    import rcg
    surface = rcg.open('rough-steel.x3p')                          # an instrument file, or a grid stream
    surface = rcg.detrend(surface, poly=2, spikes=5, fill=True)  # steps in the order written
    result = rcg.solve(surface, radius='3.75mm', load='60N', estar='114GPa', hardness='6GPa')
    result.pressure                                                # 2-D array, pascals
    result.report['contact_area']                                  # square metres
    rcg.render(result, channel='pressure', border=True)            # a picture
    rcg.report('rough-steel.x3p', 'page.html', load='0.1N')        # a page about the surface

Each tool is one function: add cost deflect detrend export fatigue heat info leak open (rc-import) pick render report scene
slip solve stress synth wear. help(rcg.solve) lists its options. frame, read, write, loads and dumps handle the
grid stream, run calls a tool by its name, and so does report with the name of a tool and frames.
sample('rough-steel.x3p') is the path of a sample surface; materials() is the table behind body1='steel'. Long runs show their progress in terminals and notebooks.
"""
from .stream import Error, Frame, dumps, frame, loads, read, write
from .tools import FUNCTIONS, NotConverged, Page, Picture, Result, ToolWarning, Trials, Verdicts, function, materials, run, sample

__version__ = '0.1.0'
__all__ = ['Error', 'Frame', 'NotConverged', 'Page', 'Picture', 'Result', 'ToolWarning', 'Trials', 'Verdicts', 'frame', 'loads', 'read',
           'dumps', 'write', 'run', 'sample', 'materials'] + sorted(FUNCTIONS)


def __getattr__(name):
    """The function of a tool, made from its option table when it is first used."""
    if name not in FUNCTIONS:
        raise AttributeError('module %r has no attribute %r' % (__name__, name))
    globals()[name] = made = function(name)
    return made


def __dir__():
    return sorted(set(globals()) | set(__all__))
