# SPDX-License-Identifier: GPL-3.0-or-later
"""python_page.py PAGE: fails unless the page of rc-report is well-formed and complete in itself; prints title and heading."""
import base64
import sys
import xml.etree.ElementTree

KNOWN = set('html head meta title style body h1 h2 p pre figure img figcaption table tr th td ul li'.split())
root = xml.etree.ElementTree.parse(sys.argv[1]).getroot()  # refuses a tag without its end, and a bare < or &
pictures = 0
for e in root.iter():
    assert e.tag in KNOWN, e.tag
    assert set(e.attrib) <= {'lang', 'charset', 'http-equiv', 'content', 'alt', 'src', 'id'}, e.attrib
    if e.tag == 'img':
        head, _, data = e.attrib['src'].partition(',')
        assert head == 'data:image/png;base64' and base64.b64decode(data, validate=True)[1:4] == b'PNG' and e.attrib['alt']
        pictures += 1
assert [e.tag for e in root] == ['head', 'body'] and 'url(' not in root.find('head/style').text
policy = [m.attrib['content'] for m in root.iter('meta') if 'http-equiv' in m.attrib]
assert len(policy) == 1 and policy[0].startswith("default-src 'none'"), policy
print('%d pictures: %s: %s' % (pictures, root.find('head/title').text, root.find('body/h1').text))
