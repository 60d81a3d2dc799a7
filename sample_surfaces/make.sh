#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the sample surfaces again, bit for bit:
#
#     sample_surfaces/make.sh [FOLDER]
#
# rc-synth on PATH or in build/tools, perl and zip are needed. Heights are rounded to whole steps
# (as an instrument does), so that the last bits of a machine's arithmetic do not show.
set -euo pipefail
export LC_ALL=C TZ=UTC
here=$(cd "$(dirname "$0")" && pwd)
out=$(cd "${1-$here}" && pwd)
PATH="$PATH:$here/../build/tools"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# Values of a one-frame f64 stream as text, one a line. The stream ends with "crc32 12345678" and "RCGEND 1"
# and their line feeds: 24 bytes.
values() {
    head -c -24 | tail -c "$((8 * $1))" | od -An -v -w8 -t f8
}

# Packs data.bin, and valid.bin where there is one, as an X3P file: x3p NAME NX NY COMMENT OFFSET
x3p() {
    local files=(bindata/data.bin)
    rm -rf bindata && mkdir bindata
    mv data.bin bindata
    local mask=''
    if [ -e valid.bin ]; then
        mv valid.bin bindata
        files+=(bindata/valid.bin)
        mask="
      <ValidPointsLink>bindata/valid.bin</ValidPointsLink>
      <MD5ChecksumValidPoints>$(md5sum <bindata/valid.bin | cut -c1-32)</MD5ChecksumValidPoints>"
    fi
    cat >main.xml <<EOT
<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
  <Record1>
    <Revision>ISO5436 - 2000</Revision>
    <FeatureType>SUR</FeatureType>
    <Axes>
      <CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1.1e-6</Increment><Offset>0</Offset></CX>
      <CY><AxisType>I</AxisType><DataType>D</DataType><Increment>1.29e-6</Increment><Offset>0</Offset></CY>
      <CZ><AxisType>A</AxisType><DataType>I</DataType><Increment>5e-10</Increment><Offset>$5</Offset></CZ>
    </Axes>
  </Record1>
  <Record2>
    <Date>2026-11-21T00:00:00Z</Date>
    <Creator>sample_surfaces/make.sh</Creator>
    <Instrument><Manufacturer>none</Manufacturer><Model>synthetic</Model><Serial>0</Serial><Version>1</Version></Instrument>
    <CalibrationDate>2026-11-21T00:00:00Z</CalibrationDate>
    <ProbingSystem><Type>Software</Type><Identification>rc-synth</Identification></ProbingSystem>
    <Comment>$4</Comment>
  </Record2>
  <Record3>
    <MatrixDimension><SizeX>$2</SizeX><SizeY>$3</SizeY><SizeZ>1</SizeZ></MatrixDimension>
    <DataLink>
      <PointDataLink>bindata/data.bin</PointDataLink>
      <MD5ChecksumPointData>$(md5sum <bindata/data.bin | cut -c1-32)</MD5ChecksumPointData>$mask
    </DataLink>
  </Record3>
  <Record4>
    <ChecksumFile>md5checksum.hex</ChecksumFile>
  </Record4>
</p:ISO5436_2>
EOT
    echo "$(md5sum <main.xml | cut -c1-32) *main.xml" >md5checksum.hex
    chmod 644 main.xml md5checksum.hex bindata/*
    touch -d '2026-11-21 00:00:00 UTC' main.xml md5checksum.hex bindata/*
    rm -f "$out/$1"
    zip -q -X -9 -D "$out/$1" main.xml "${files[@]}" md5checksum.hex
}

# rough-steel.x3p: a ground and lapped steel specimen as a profilometer measures it: 242 x 206 points,
# self-affine roughness, with a tilt and a small curvature, 16-bit steps of 0.5 nm. 0.9 % of the points are
# missing, most of them in small clusters.
rc-synth selfaffine --nx 242 --ny 206 --dx 1.1um --dy 1.29um --hurst 0.8 --rms-height 0.25um \
    --rolloff 60um --short-cut 8um --seed 1999 | values $((242 * 206)) >heights
perl -e '
    my ($nx, $ny, $step, $seed) = (242, 206, 0.5e-9, 7);
    open(my $in, "<", "heights") or die; my @h = <$in>;
    my @valid = (1) x ($nx * $ny);
    sub draw { $seed = ($seed * 1103515245 + 12345) % 2147483648; return int($seed / 65536); }
    for (1 .. 40) {
        my ($x, $y, $r) = (draw() % $nx, draw() % $ny, 1 + draw() % 2);
        for my $j ($y - $r .. $y + $r) { for my $i ($x - $r .. $x + $r) {
            next if $i < 0 || $j < 0 || $i >= $nx || $j >= $ny;
            $valid[$j * $nx + $i] = 0 if draw() % 3;
        } }
    }
    my $raw = "";
    for my $k (0 .. $nx * $ny - 1) {
        my ($x, $y) = ($k % $nx / $nx - 0.5, int($k / $nx) / $ny - 0.5);
        my $z = $h[$k] + 1.7e-6 * $x - 0.9e-6 * $y + 0.6e-6 * ($x * $x + 0.5 * $y * $y);
        $raw .= pack("s<", sprintf("%.0f", $z / $step)) if $valid[$k];
        $raw .= pack("s<", -32768) unless $valid[$k];
    }
    open(my $data, ">:raw", "data.bin") or die; print $data $raw;
    open(my $mask, ">:raw", "valid.bin") or die; print $mask pack("b*", join("", @valid));
'
x3p rough-steel.x3p 242 206 \
    "Self-affine roughness, Hurst 0.8, RMS 0.25 um, tilted and bowed, with missing points" 2.5e-6

# rough-sphere.x3p: the roughness of the sphere of Polonsky and Keer, Wear 231 (1999), section 4.2: their grid
# and spacings; with --radius 7.5mm --load 240N --estar 113.93GPa --hardness 6GPa the contact area is 0.55 of
# Hertz's. 16-bit steps of 0.5 nm, nothing missing.
rc-synth selfaffine --nx 483 --ny 412 --dx 1.1um --dy 1.29um --hurst 0.8 --rms-height 0.405um \
    --rolloff 100um --short-cut 16um --seed 1999 | values $((483 * 412)) >heights
perl -e '
    open(my $in, "<", "heights") or die;
    open(my $data, ">:raw", "data.bin") or die;
    print $data pack("s<", sprintf("%.0f", $_ / 0.5e-9)) while <$in>;
'
x3p rough-sphere.x3p 483 412 "Self-affine roughness, Hurst 0.8, RMS 0.405 um" 0

# turned-brass.txt: a text matrix as topography programs export it: 96 x 64 points, turning marks
# 80 um apart with fine roughness on them, in micrometres, seven points missing.
rc-synth wave --nx 96 --ny 64 --dx 5um --amplitude 1.2um --wavelength 80um | values $((96 * 64)) >marks
rc-synth selfaffine --nx 96 --ny 64 --dx 5um --hurst 0.6 --rms-height 0.15um --short-cut 20um \
    --seed 47 | values $((96 * 64)) >fine
{
    printf '# Channel: Topography\n# Width: 480 um\n# Height: 320 um\n# Value units: um\n'
    paste marks fine | awk '
        { z = ($1 + $2) * 1e6 + 0.004 * (NR % 96)
          printf "%s", NR % 911 == 400 ? "Bad" : sprintf("%.4f", z)
          printf "%s", NR % 96 == 0 ? "\n" : "\t" }'
} >"$out/turned-brass.txt"
