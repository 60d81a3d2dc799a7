# SPDX-License-Identifier: GPL-3.0-or-later
"""notebooks.py OUT NOTEBOOK...: runs the notebooks; OUT gets their pictures. A cell that fails ends it."""
import base64
import os
import sys

import nbformat
from nbclient import NotebookClient

out = sys.argv[1]
for name in sys.argv[2:]:
    book = nbformat.read(name, 4)
    NotebookClient(book, timeout=200).execute()
    found = [output for cell in book.cells for output in cell.get('outputs', [])]
    said = ''.join(o['text'] for o in found if o.get('name') == 'stderr')
    warned = [line for line in said.splitlines() if 'Warning' in line]  # progress is welcome
    assert not warned, warned
    pictures = [o['data']['image/png'] for o in found if 'image/png' in o.get('data', {})]
    for k, picture in enumerate(pictures):
        with open(os.path.join(out, '%s-%d.png' % (os.path.splitext(os.path.basename(name))[0], k + 1)), 'wb') as file:
            file.write(base64.b64decode(picture))
    print('%s: %d pictures' % (os.path.basename(name), len(pictures)))
