#!/usr/bin/perl
# SPDX-License-Identifier: GPL-3.0-or-later
# A tool that is broken in the way RC_BREAK, for broken_tools.sh: a symbolic link to this file with the name of
# the tool. It runs the tool of this name in RC_REAL and changes what that has written: standard output, if it is
# a file or a pipe, and the files of -o and --report. Each change is a line of the file RC_BREAK_LOG. Tools in
# RC_BREAK_NOT are whole.
use strict;
use warnings;
use Compress::Zlib 'crc32';

my ($name) = $0 =~ m{([^/]+)$};
my $asked = $ENV{RC_BREAK};
my @ways = $asked eq 'none' ? qw(digit percent info drop value three one) : $asked;
my $kept_whole = grep { $_ eq $name } split ' ', $ENV{RC_BREAK_NOT} // '';
@ways = grep { !/^(drop|value)$/ } @ways if $kept_whole;
my ($way, $changes, %would, %file) = ('', 0);

# ---- numbers of reports ----

my %place = map { $_ => 1 } qw(case frame nx ny nodes); # they say which result a line belongs to

sub changed {
    my ($key, $v) = @_;
    return $v if $place{$key} || $v !~ /^-?[0-9]/ || $v !~ /[1-9]/;
    $changes++;
    if ($way ne 'digit') {
        return sprintf '%.17g', $v * 1.01 if $v !~ /^-?[0-9]+$/;
        return $v + (abs $v < 150 ? 1 : int($v / 100));
    }
    my ($mantissa, $power) = $v =~ /^([^eE]*)(.*)$/;
    $mantissa =~ s/(\d)$/($1 + 1) % 10/e;
    return $mantissa . $power;
}

sub break_json {
    my ($t) = @_;
    $t =~ s/"([^"]+)": (\[[^\]\[{}]*\]|-?[0-9][^],} \n]*)/my ($k, $v) = ($1, $2);
        $v =~ s{(-?[0-9][^], ]*)}{changed($k, $1)}ge; qq("$k": $v)/ge;
    return $t;
}

sub break_table {
    my ($t) = @_;
    my @lines = split /\n/, $t, -1;
    my $gap = $lines[0] =~ /\t/ ? "\t" : ',';
    my @head = split $gap, $lines[0];
    for my $line (@lines[1 .. $#lines]) {
        my @v = split $gap, $line, -1;
        $v[$_] = changed($head[$_] // '', $v[$_]) for 0 .. $#v;
        $line = join $gap, @v;
    }
    return join "\n", @lines;
}

sub break_info {
    my ($t) = @_;
    my $label = qr/  (?!grid|size|type|keys|history|case|frame)\w[^\n0-9]*? /;
    $t =~ s/^($label)(-?[0-9][0-9.]*(?:e[-+]?\d+)?)(?=\s)/$1 . changed('', $2)/gme;
    return $t;
}

# ---- streams ----

sub break_stream {
    my ($s) = @_;
    my (@frames, $at);
    while ($s =~ /\GRCG1\n.*?\n\n/gcs) {
        my ($begin, $data) = ($-[0], $+[0]);
        my $head = substr $s, $begin, $data - $begin;
        my ($nx) = $head =~ /^nx=(\d+)/m;
        my ($ny) = $head =~ /^ny=(\d+)/m;
        my $size = $nx * $ny * ($head =~ /^type=f32/m ? 4 : 8);
        pos($s) = $data + $size;
        return $s unless $s =~ /\Gcrc32 [0-9a-f]{8}\n/gc;
        push @frames, [$head, substr($s, $data, $size)];
    }
    return $s unless @frames && $s =~ /\GRCGEND \d+\n\z/gc;
    if ($way eq 'drop') {
        return $s if @frames < 2;
        pop @frames;
    } else {
        for my $frame (@frames) { # the first one that is not 0 everywhere
            my $c = $frame->[0] =~ /^type=f32/m ? 'f<*' : 'd<*';
            my @v = unpack $c, $frame->[1];
            next unless grep { $_ != 0 && $_ == $_ } @v;
            $frame->[1] = pack $c, map { $_ * 1.001 } @v;
            last;
        }
    }
    $changes++;
    return join('', map { $_->[0] . $_->[1] . sprintf "crc32 %08x\n", crc32($_->[0] . $_->[1]) } @frames) .
        'RCGEND ' . @frames . "\n";
}

# ---- what was written ----

sub broken {
    my ($t) = @_;
    my $is = $t;
    for (@ways) {
        $way = $_;
        $changes = 0;
        $is = broken_so($t);
        $would{$way} = 1 if $changes;
    }
    return $asked eq 'none' ? $t : $is;
}

sub broken_so {
    my ($t) = @_;
    return $t if $t eq '';
    return break_stream($t) if $t =~ /\ARCG1\n/ && $way =~ /^(drop|value)$/;
    return $t if $t =~ /\ARCG1\n/ || $way !~ /^(digit|percent|info)$/;
    return $t if ($way eq 'percent' && $name eq 'rc-info') || ($way eq 'info' && $name ne 'rc-info');
    return break_json($t) if $t =~ /\A\{"/;
    return break_table($t) if $t =~ /\A[a-z_0-9]+([\t,])[a-z_0-9]+\1/;
    return $name eq 'rc-info' ? break_info($t) : $t;
}

for my $k (0 .. $#ARGV) {
    $file{$ARGV[$k + 1] // ''} = 1 if $ARGV[$k] =~ /^(-o|--report)$/;
    $file{$1} = 1 if $ARGV[$k] =~ /^--report=(.*)/s;
}
my %old = map { $_ => join ' ', (stat $_)[1, 7, 9] } grep { -f } keys %file;
my $takes = -p STDOUT || -f STDOUT;
my $kept;
open $kept, '+>', undef or die "broken_tool: $!" if $takes;
binmode STDOUT;
binmode $kept if $takes;
my $child = fork // die "broken_tool: $!";
if ($child == 0) {
    open STDOUT, '>&', $kept or die "broken_tool: $!" if $takes;
    exec "$ENV{RC_REAL}/$name", @ARGV or die "broken_tool: $!";
}
for my $signal (qw(TERM INT HUP)) {
    $SIG{$signal} = sub { kill $signal, $child };
}
1 while waitpid($child, 0) < 0;
my $status = $?;

for my $f (grep { -f && !-l && ($old{$_} // '') ne join ' ', (stat)[1, 7, 9] } keys %file) {
    local $/;
    open my $in, '<:raw', $f or next;
    my $was = <$in>;
    my $is = broken($was);
    next if $is eq $was;
    open my $out, '>:raw', $f or next;
    print $out $is;
}
if ($takes) {
    local $/;
    seek $kept, 0, 0;
    print broken(scalar <$kept> // '');
    close STDOUT;
}
for (grep { $status == {three => 3, one => 1}->{$_} << 8 } grep { /^(three|one)$/ } @ways) {
    $would{$_} = 1;
    $status = 0 if $asked ne 'none';
}
if (%would && open my $log, '>>', $ENV{RC_BREAK_LOG}) {
    print $log "$_\n" for keys %would;
}
if ($status & 127) {
    $SIG{$_} = 'DEFAULT' for qw(TERM INT HUP);
    kill $status & 127, $$;
}
exit $status >> 8;
