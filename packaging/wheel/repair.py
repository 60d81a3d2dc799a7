#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""repair.py WHEEL OUT: puts beside the tools of a wheel the shared libraries and the fonts that they need.

It does the work of `auditwheel repair`, which is for extension modules: it gives programs a wrong RPATH, starts them
through Python, and leaves GLib, zlib and expat to the system. Here only glibc comes from the system. Runs in the root
whose libraries were linked.
"""
import base64
import glob
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

GLIBC = re.compile(r'(linux-vdso|ld-linux.*|lib(c|m|pthread|dl|rt|resolv|util))\.so')
SHARE = 'data/share/rough-contact'
FONTS = '/usr/share/fonts/truetype/dejavu/DejaVuSans%s.ttf'
BUILT = {'libxml2': 'libxml2', 'libzip': 'libzip', 'libtiff': 'tiff', 'libhdf5': 'hdf5', 'libcairo': 'cairo',
         'libpangocairo': None, 'libfontconfig': 'fontconfig'}


def said(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout


def needed(program):
    """{name: file} of every library that a program loads, glibc's left out."""
    found = {}
    for name, file in re.findall(r'(?m)^\s*(\S+) => (\S+)', said('ldd', program)):
        if not GLIBC.match(name):
            if file == 'not':
                sys.exit('%s needs %s, which is missing' % (program, name))
            found[name] = os.path.realpath(file)
    return found


def rpath(file, path):
    """DT_RPATH, so that LD_LIBRARY_PATH of a cluster cannot put other libraries in their place."""
    subprocess.run(['patchelf', '--force-rpath', '--set-rpath', path, file], check=True)
    os.chmod(file, 0o755)


def glibc(file):
    """The newest version of glibc whose functions a file uses."""
    return max((tuple(map(int, v.split('.'))) for v in re.findall(r'\bGLIBC_([0-9.]+)\b', said('objdump', '-T', file))),
               default=(2, 5))


def licence(file):
    """A name, and the text of the licence of a library or font: of Debian's package, or of the sources built here."""
    if file.startswith('/opt/rc/'):
        stem = re.match(r'libfontconfig|libcairo|lib[a-z]+[0-9]?', os.path.basename(file)).group()
        source = BUILT[stem.replace('libhdf5_hl', 'libhdf5')]
        return source, glob.glob('/libraries/%s-*/debian/copyright' % source)[0]
    for name in (file, file.replace('/usr', '', 1)):
        done = subprocess.run(['dpkg', '-S', name], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True)
        if done.returncode == 0:
            package = done.stdout.split(':')[0]
            return package, '/usr/share/doc/%s/copyright' % package
    sys.exit('%s: no package holds it, so its licence is unknown' % file)


def sources(licences):
    """Versions of Debian's source packages, whose sources the GPL and the LGPL ask for."""
    lines = set()
    for name in os.listdir(licences):
        built = glob.glob('/libraries/%s_*.dsc' % name)
        if built:
            lines.add('%s %s' % (name, re.sub(r'.*_(.*)\.dsc', r'\1', built[0])))
        else:
            lines.add(said('dpkg-query', '-W', '-f', '${source:Package} ${source:Version}\n', name).splitlines()[0])
    return 'Source packages of Debian from which the libraries and fonts in this wheel were built:\n' + '\n'.join(sorted(lines)) + '\n'


def pack(folder, info, name):
    """The wheel of a folder: always the same bytes for the same files."""
    record = []
    with zipfile.ZipFile(name, 'w', zipfile.ZIP_DEFLATED, compresslevel=9) as z:
        def put(arc, body, mode):
            entry = zipfile.ZipInfo(arc, (2020, 1, 1, 0, 0, 0))
            entry.external_attr, entry.compress_type = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED
            z.writestr(entry, body)

        files = sorted(os.path.join(at, file) for at, _, here in os.walk(folder) for file in here)
        for path in files:
            arc = os.path.relpath(path, folder)
            if arc != info + '/RECORD':
                with open(path, 'rb') as file:
                    body = file.read()
                put(arc, body, 0o755 if os.access(path, os.X_OK) else 0o644)
                digest = base64.urlsafe_b64encode(hashlib.sha256(body).digest()).rstrip(b'=').decode()
                record.append('%s,sha256=%s,%d\n' % (arc, digest, len(body)))
        put(info + '/RECORD', ''.join(record) + info + '/RECORD,,\n', 0o644)


def main(wheel, out):
    work = tempfile.mkdtemp()
    with zipfile.ZipFile(wheel) as z:
        z.extractall(work)
    data = glob.glob(work + '/*.data')[0]
    info = os.path.basename(data)[:-5] + '.dist-info'
    share, licences = os.path.join(data, SHARE), os.path.join(work, info, 'licenses/bundled')
    for folder in (share + '/lib', share + '/fonts', licences):
        os.makedirs(folder)
    libraries, newest = {}, (2, 17)
    for tool in glob.glob(data + '/scripts/rc-*'):
        libraries.update(needed(tool))
        newest = max(newest, glibc(tool))
        rpath(tool, '$ORIGIN/../share/rough-contact/lib')
    for name, source in sorted(libraries.items()):
        file = os.path.join(share, 'lib', name)
        shutil.copy(source, file)
        subprocess.run(['strip', '--strip-unneeded', file], check=True)
        newest = max(newest, glibc(file))
        rpath(file, '$ORIGIN')
    fonts = [FONTS % weight for weight in ('', '-Bold')]
    for source in list(libraries.values()) + fonts:
        package, text = licence(source)
        shutil.copy(text, os.path.join(licences, package))
    for font in fonts:
        shutil.copy(font, share + '/fonts')
    with open(os.path.join(work, info, 'licenses/SOURCES'), 'w') as file:
        file.write(sources(licences))
    tag = 'manylinux_%d_%d_x86_64' % newest
    with open(os.path.join(work, info, 'WHEEL')) as file:
        text = re.sub(r'(?m)^(Tag: \S+)-linux_x86_64$', r'\1-' + tag, file.read())
    with open(os.path.join(work, info, 'WHEEL'), 'w') as file:
        file.write(text)
    name = os.path.join(out, os.path.basename(wheel).replace('linux_x86_64', tag))
    pack(work, info, name)
    shutil.rmtree(work)
    print('%s: %d libraries, %.1f MB' % (os.path.basename(name), len(libraries), os.path.getsize(name) / 1e6))


main(*sys.argv[1:])
