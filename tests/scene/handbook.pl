# SPDX-License-Identifier: GPL-3.0-or-later
# handbook.pl FILE EVERY: compares the verdicts of rc-scene with those of handbook.txt, in every so many scenes. Prints a line
# for each, "agrees", "disagrees", "explained" (it differs, and the file says why) or "undecided", then the counts.
use strict;
use warnings;
use JSON::PP;

my ($file, $every) = @ARGV;
my (%source, %count, @scene);
open my $in, '<', $file or die "$file: $!\n";
while (<$in>) {
    chomp;
    next if /^#/ || /^$/;
    if (/^source (\w+): (.*)/) {
        $source{$1} = $2;
    } elsif (/^scene (.*?) \| (.*?) \| (.*)/) {
        push @scene, {name => $1, surface => $2, contact => $3, said => []};
    } elsif (/^  ([\w-]+) (calls|negligible) (\w+): (.*)/ && exists $source{$3}) {
        push @{$scene[-1]{said}}, [$1, $2, $4, $source{$3}];
    } elsif (/^  explained ([\w-]+): (.*)/) {
        $scene[-1]{explained}{$1} = $2;
    } else {
        die "$file:$.: $_\n";
    }
}
my $scenes = 0;
for my $k (grep { $_ % $every == 0 } 0 .. $#scene) {
    my $s = $scene[$k];
    my $text = `rc-synth $s->{surface} | rc-scene --quiet --report - $s->{contact}`;
    die "$s->{name}: no report\n" if $? != 0;
    my %found = map { ($_->{effect} => $_) } @{decode_json($text)->{scene}};
    $scenes++;
    for (@{$s->{said}}) {
        my ($effect, $want, $why, $source) = @$_;
        my $e = $found{$effect};
        my $verdict = $e->{verdict} =~ s/ for it//r;
        my $word = $verdict eq $want ? 'agrees' : $verdict eq 'not decided' ? 'undecided'
            : exists $s->{explained}{$effect} ? 'explained' : 'disagrees';
        $count{$word}++;
        print "$word: $s->{name}: $effect, ", $e->{sentence} // "data missing: $e->{missing}", ", where $source: $why\n";
    }
}
print "$scenes scenes: ", join(', ', map { ($count{$_} // 0) . " $_" } qw(agrees disagrees explained undecided)), "\n";
