# SPDX-License-Identifier: GPL-3.0-or-later
# made_maps.pl park|netcdf|mat NX NY: a file of that format with a map of that size, on standard output.
use strict;
use warnings;

my ($format, $nx, $ny) = @ARGV;
my $n = $nx * $ny;

# Park Systems: a TIFF of one pixel; the map is a private tag of floats, another is its header.
sub park {
    my $wide = sub { my ($text, $size) = @_; pack "v$size", map({ ord } split //, $text), (0) x $size };
    my $header = pack 'V', 0;
    $header .= $wide->('Z Height', 32) . $wide->('Tapping', 8);
    $header .= "\0" x (100 - length $header);
    $header .= pack 'VV', $nx, $ny;
    $header .= "\0" x (140 - length $header);
    $header .= pack 'd<d<', $nx, $ny;
    $header .= "\0" x (220 - length $header);
    $header .= pack('d<d<d<', 1, 1, 0) . $wide->('nm', 8);
    $header .= "\0" x (348 - length $header);
    $header .= pack 'V', 2;
    $header .= "\0" x (580 - length $header);
    my $data = join '', map { pack 'f<', $_ % 97 } 1 .. $n;
    my $at = 8 + 4;
    my @tag = ([256, 4, 1, 1], [257, 4, 1, 1], [258, 3, 1, 8], [259, 3, 1, 1], [262, 3, 1, 1], [273, 4, 1, 8],
        [277, 3, 1, 1], [278, 4, 1, 1], [279, 4, 1, 1], [50432, 4, 1, 0x0e031301], [50433, 4, 1, 0x1000002],
        [50434, 7, length $data, $at], [50435, 7, length $header, $at + length $data]);
    print 'II', pack('vV', 42, $at + length($data) + length($header)), "\1\0\0\0", $data, $header,
        pack('v', scalar @tag), map({ pack 'vvVV', @$_ } @tag), pack 'V', 0;
}

# NetCDF classic: dimensions y and x with their coordinates, and a map of doubles in nanometres.
sub netcdf {
    my $text = sub { my $t = shift; pack('N', length $t) . $t . "\0" x (-length($t) % 4) };
    my $variable = sub {
        my ($name, $dimensions, $unit, $size, $at) = @_;
        return $text->($name) . pack('N*', scalar @$dimensions, @$dimensions) . pack('NN', 12, 1) . $text->('units')
            . pack('N', 2) . $text->($unit) . pack 'NNN', 6, $size, $at;
    };
    my $make = sub {
        my $at = shift;
        return "CDF\1" . pack('N', 0) . pack('NN', 10, 2) . $text->('y') . pack('N', $ny) . $text->('x') . pack('N', $nx)
            . pack('NN', 0, 0) . pack('NN', 11, 3)
            . $variable->('y', [0], 'um', 8 * $ny, $at) . $variable->('x', [1], 'um', 8 * $nx, $at + 8 * $ny)
            . $variable->('height', [0, 1], 'nm', 8 * $n, $at + 8 * ($nx + $ny));
    };
    print $make->(length $make->(0)), map({ pack 'd>', $_ } 0 .. $ny - 1), map({ pack 'd>', $_ } 0 .. $nx - 1),
        map { pack 'd>', $_ % 97 } 1 .. $n;
}

# MATLAB: doubles in micrometres, packed.
sub mat {
    require Compress::Zlib;
    my $element = sub { my ($type, $bytes) = @_; pack('VV', $type, length $bytes) . $bytes . "\0" x (-length($bytes) % 8) };
    my $array = sub {
        my ($name, $class, $rows, $columns, $type, $numbers) = @_;
        return $element->(14, $element->(6, pack 'VV', $class, 0) . $element->(5, pack 'VV', $rows, $columns)
                . $element->(1, $name) . $element->($type, $numbers));
    };
    my $text = sub { $array->($_[0], 4, 1, length $_[1], 4, pack 'v*', map { ord } split //, $_[1]) };
    my $packed = Compress::Zlib::compress($array->('map', 6, $ny, $nx, 9, join '', map { pack 'd<', sin $_ } 1 .. $n));
    print pack('A124 v', 'MATLAB 5.0 MAT-file', 0x100), 'IM', $array->('dx', 6, 1, 1, 9, pack 'd<', 1),
        $text->('dunit', 'um'), $text->('unit', 'um'), pack('VV', 15, length $packed), $packed;
}

binmode STDOUT;
{ park => \&park, netcdf => \&netcdf, mat => \&mat }->{$format}->();
