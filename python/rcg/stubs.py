# SPDX-License-Identifier: GPL-3.0-or-later
"""The type hints of rcg, from the option tables: python3 -m rcg.stubs TABLES.JSON prints __init__.pyi."""
import json
import sys

from . import FUNCTIONS, tools

HEAD = '''# Made by the build from the option tables of the tools.
import os
from typing import Any, Callable, Literal, overload

import numpy

from .stream import Error as Error, Frame as Frame, dumps as dumps, frame as frame, loads as loads, read as read, write as write
from .tools import NotConverged as NotConverged, Page as Page, Picture as Picture, Result as Result, ToolWarning as ToolWarning, Trials as Trials, Verdicts as Verdicts
from .tools import materials as materials, run as run, sample as sample

__version__: str

# A number in SI, a text with a unit as '60N', or both as (60, 'N').
Quantity = float | str | tuple[float, str]
Path = str | os.PathLike[str]
# An array needs dx=.
Surface = Result | Frame | list[Frame] | numpy.ndarray[Any, Any] | Path
'''
# The other call of this function: the report lines of another tool.
LINES = '''

@overload
def report(tool: str, frames: Any, *args: Any, **options: Any) -> tuple[list[Frame], list[dict[str, Any]]]: ...


@overload'''


def stub():
    parts = [HEAD]
    for name in sorted(name for name, tool in FUNCTIONS.items() if tool in tools._tables):
        made = tools.function(name)
        text = made.__doc__.replace('\\', '\\\\').rstrip().replace('\n', '\n    ').replace('    \n', '\n')
        parts.append('%s\ndef %s%s:\n    """%s"""\n' % (LINES if name == 'report' else '\n', name, made.__signature__.whole(), text))
    return ''.join(parts)


if __name__ == '__main__':
    with open(sys.argv[1], encoding='utf-8') as file:
        tools._tables.update((row['tool'], row) for row in map(json.loads, file))
    sys.stdout.write(stub())
