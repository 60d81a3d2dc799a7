#!/usr/bin/env perl
# SPDX-License-Identifier: GPL-3.0-or-later
# Reduces PNG files of rc-render to 256 colours, in place: a third of the size. Texts and resolution are kept.
#
#     sample_surfaces/palette.pl FILE.png ...
#
# The colours are divided by the box of the largest variance, at its mean (a form of Heckbert's median cut,
# SIGGRAPH 1982, 297); a box has the mean of its colours.
use strict;
use warnings;
use Compress::Zlib;
use List::Util 'sum0';

my $most = 256;

# The rows of an RGB picture of 8 bits, without their filters.
sub rows {
    my ($w, $h, $data) = @_;
    my ($n, @rows, @above) = (3 * $w);
    @above = (0) x $n;
    for my $y (0 .. $h - 1) {
        my ($filter, @v) = unpack 'C*', substr $data, $y * ($n + 1), $n + 1;
        for my $x (0 .. $n - 1) {
            my ($a, $b, $c) = ($x < 3 ? 0 : $v[$x - 3], $above[$x], $x < 3 ? 0 : $above[$x - 3]);
            my ($pa, $pb, $pc) = (abs($b - $c), abs($a - $c), abs($a + $b - 2 * $c));
            $v[$x] = 255 & ($v[$x] + (0, $a, $b, ($a + $b) >> 1, $pa <= $pb && $pa <= $pc ? $a : $pb <= $pc ? $b : $c)[$filter]);
        }
        push @rows, pack 'C*', @v;
        @above = @v;
    }
    return @rows;
}

# A box of colours [r, g, b, count, name]: its mean, and the axis and size of its largest variance.
sub box {
    my @colours = @_;
    my $n = sum0 map { $_->[3] } @colours;
    my ($axis, $size, @mean) = (0, -1);
    for my $k (0 .. 2) {
        $mean[$k] = sum0(map { $_->[$k] * $_->[3] } @colours) / $n;
        my $spread = sum0 map { $_->[3] * ($_->[$k] - $mean[$k]) ** 2 } @colours;
        ($axis, $size) = ($k, $spread) if $spread > $size;
    }
    return {colours => \@colours, mean => \@mean, axis => $axis, size => $size};
}

sub boxes {
    my @boxes = box(@_);
    while (@boxes < $most) {
        @boxes = sort { $b->{size} <=> $a->{size} } @boxes;
        last if $boxes[0]{size} <= 0;
        my $old = shift @boxes;
        my ($axis, $at) = ($old->{axis}, $old->{mean}[$old->{axis}]);
        for my $side (0, 1) { push @boxes, box(grep { ($_->[$axis] > $at) == $side } @{$old->{colours}}) }
    }
    return @boxes;
}

sub chunk { my ($type, $data) = @_; return pack('N', length $data) . $type . $data . pack 'N', crc32($type . $data) }

for my $file (@ARGV) {
    open my $in, '<:raw', $file or die "$file: $!\n";
    my ($png, $w, $h, $data, $before, $after) = (do { local $/; <$in> }, 0, 0, '', '', '');
    for (my $at = 8; $at < length $png;) {
        my ($n, $type) = unpack 'Na4', substr $png, $at, 8;
        my $body = substr $png, $at + 8, $n;
        $at += 12 + $n;
        if ($type eq 'IHDR') {
            ($w, $h, my $kind) = unpack 'NNn', $body;
            die "$file: it is not RGB with 8 bits\n" if $kind != 0x0802;
        } elsif ($type eq 'IDAT') {
            $data .= $body;
        } elsif ($type ne 'IEND') {
            $before .= chunk($type, $body);
        }
    }
    my @rows = rows($w, $h, uncompress($data));
    my (%count, %place);
    for my $row (@rows) { $count{$_}++ for unpack '(a3)*', $row }
    my @boxes = boxes(map { [unpack('CCC', $_), $count{$_}, $_] } sort keys %count);
    for my $k (0 .. $#boxes) { $place{$_->[4]} = chr $k for @{$boxes[$k]{colours}} }
    my $pixels = join '', map { "\0" . join '', map { $place{$_} } unpack '(a3)*', $_ } @rows;
    open my $out, '>:raw', $file or die "$file: $!\n";
    print $out "\x89PNG\r\n\x1a\n", chunk('IHDR', pack 'NNC5', $w, $h, 8, 3, 0, 0, 0), $before,
        chunk('PLTE', pack 'C*', map { map { int($_ + 0.5) } @{$_->{mean}} } @boxes), chunk('IDAT', compress($pixels, 9)), chunk('IEND', '');
    close $out or die "$file: $!\n";
}
