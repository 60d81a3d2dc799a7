# SPDX-License-Identifier: GPL-3.0-or-later
# Run in the root, in /libraries. It builds libraries from Debian's sources into /opt/rc, without the parts
# that the tools do not use (ICU, OpenSSL, curl, X11, JPEG and others). fontconfig is built too, because the
# one of Debian 11 writes into folders of fonts.
set -euo pipefail
prefix=/opt/rc
export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
built() { echo "$1, $SECONDS s"; }

with_cmake() { # FOLDER TARGET OPTION...
    cmake -S "$1" -B "$1/b" -G Ninja -DCMAKE_INSTALL_PREFIX=$prefix -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_BUILD_TYPE=Release "${@:3}"
    ninja -C "$1/b" "$2"
    ninja -C "$1/b" install
}
# What Debian patched must not be newer than what was made of it.
with_configure() { # FOLDER OPTION...
    (cd "$1" && touch aclocal.m4 && find . -name '*.in' -exec touch {} + && touch configure &&
        ./configure --prefix=$prefix --libdir=$prefix/lib --disable-static "${@:2}" CFLAGS='-O2 -w')
}

with_cmake libxml2-* all -DLIBXML2_WITH_{ICU,LZMA,PYTHON,PROGRAMS,TESTS,HTTP,FTP,MODULES}=OFF
built libxml2
with_cmake libzip-* all -DENABLE_{OPENSSL,GNUTLS,MBEDTLS,COMMONCRYPTO,BZIP2,LZMA,ZSTD}=OFF -DBUILD_{TOOLS,REGRESS,EXAMPLES,DOC}=OFF
built libzip
with_cmake tiff-* all -D{jpeg,old-jpeg,jbig,lerc,lzma,webp,zstd,libdeflate,cxx}=OFF
built libtiff

with_configure hdf5-* --enable-hl --disable-{tests,tools,fortran,cxx,java,ros3-vfd} --without-szlib --enable-build-mode=production
for part in src hl/src; do
    make -j2 -C hdf5-*/$part install
done
printf 'Name: hdf5\nDescription: HDF5\nVersion: 1.10\nCflags: -I%s/include\nLibs: -L%s/lib -lhdf5\n' $prefix $prefix >$prefix/lib/pkgconfig/hdf5.pc
built HDF5

(cd fontconfig-* && autoreconf -fi)
with_configure fontconfig-* --sysconfdir=/etc --localstatedir=/var --disable-{docs,nls,cache-build}
for part in fontconfig fc-case fc-lang src; do
    make -j2 -C fontconfig-*/$part
done
make -C fontconfig-*/src install-libLTLIBRARIES
make -C fontconfig-*/fontconfig install
make -C fontconfig-* install-pkgconfigDATA
built fontconfig
with_configure cairo-* --disable-{xlib,xcb,xlib-xcb,gl,script,interpreter,gobject,trace,ps,svg,gtk-doc} --enable-{pdf,png,ft,fc}
make -j2 -C cairo-*/src install
built cairo

# Debian 11 has no file of pkg-config for it.
printf 'Name: libdeflate\nDescription: deflate\nVersion: 1.7\nLibs: -ldeflate\n' >$prefix/lib/pkgconfig/libdeflate.pc
