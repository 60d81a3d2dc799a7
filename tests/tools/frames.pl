# SPDX-License-Identifier: GPL-3.0-or-later
# frames.pl FILE:CHANNEL[=NAME] ...: a stream of one case of these frames, the first of its channel in each file, in
# this order, under these names.
use strict;
use warnings;
use Compress::Zlib;

sub frame {
    my ($file, $channel, $name) = @_;
    open my $in, '<:raw', $file or die "$file: $!";
    local $/;
    my $all = <$in>;
    my $at = 0;
    while (substr($all, $at, 5) eq "RCG1\n") {
        my $head = substr($all, $at, index($all, "\n\n", $at) + 2 - $at);
        my ($nx) = $head =~ /^nx=(\d+)$/m;
        my ($ny) = $head =~ /^ny=(\d+)$/m;
        my $size = $nx * $ny * ($head =~ /^type=f32$/m ? 4 : 8);
        my $values = substr($all, $at + length($head), $size);
        if ($head =~ s/^channel=\Q$channel\E$/channel=$name/m) {
            $head =~ s/^unit=.*$/unit=Pa/m if $name eq 'pressure';
            return sprintf("%s%scrc32 %08x\n", $head, $values, crc32($head . $values));
        }
        $at += length($head) + $size + length("crc32 12345678\n");
    }
    die "$file: no $channel";
}

binmode STDOUT;
for (@ARGV) {
    my ($file, $channel, $name) = /^(.*):([^=]*)(?:=(.*))?$/;
    print frame($file, $channel, $name // $channel);
}
printf "RCGEND %d\n", scalar @ARGV;
