# SPDX-License-Identifier: GPL-3.0-or-later
# Reports of all tools have the same shape: boundary, tol, converged, effects with reasons, seconds with a total, and
# names of estimated errors. --dry-run writes the expected cost as numbers, with the same effects.
. "$(dirname "$0")/../pipe.sh"

rc-synth sphere --nx 32 --dx 2um --radius 1mm -o ball.rcg
rc-solve --quiet --E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.3 --load 0.5N --output pressure,gap,displacement,height -o pressed.rcg ball.rcg
rc-solve --quiet --E1 210GPa --nu1 0.3 --E2 210GPa --nu2 0.3 --load 0.5N --output pressure,gap,displacement,height -o alike.rcg ball.rcg
cat >commands.txt <<'END'
rc-solve --E1 210GPa --nu1 0.3 --E2 70GPa --nu2 0.3 --load 0.5N ball.rcg
rc-solve --periodic --estar 100GPa --load 0.1N,0.5N --hardness 5GPa ball.rcg
rc-solve --estar 100GPa --load 0.1N --discretization ball.rcg
rc-slip --mu 0.3 --tangential 50mN alike.rcg
rc-slip --mu 0.3 --creep 1e-4,0 --steady --coupling none pressed.rcg
rc-wear --coefficient 1e-6mm3/Nm --distance 10mm pressed.rcg
rc-heat --mu 0.2 --speed 1 --conductivity 45,45 --diffusivity 12mm2/s,12mm2/s pressed.rcg
rc-stress --nu 0.3 --depths 0,5um pressed.rcg
rc-fatigue --nu 0.3 --bending-limit 500MPa --torsion-limit 300MPa --pass x --depths 5um,20um pressed.rcg
rc-leak pressed.rcg
rc-deflect pressed.rcg
END
cat >look.pl <<'END'
use strict;
use JSON::PP;
my ($lines, $table, $plan) = @ARGV;
sub slurp { local $/; open my $f, "<", $_[0] or die "$_[0]: none\n"; my $t = <$f>; $t }
my @rows = map { decode_json($_) } split /\n/, slurp($lines);
my ($dry) = map { decode_json($_) } split /\n/, slurp($plan);
my ($head) = split /\n/, slurp($table);
my @column = map { s{/.*}{}r } split /\t/, $head;
sub check_effects {
    my ($where, $effects) = @_;
    ref $effects eq "HASH" && keys %$effects > 1 or die "$where: no effects\n";
    for (sort keys %$effects) {
        $effects->{$_} =~ /^(on\b|left out: \S|computed for)/ || $_ eq "kernel" or die "$where: effect $_: $effects->{$_}\n";
    }
}
for my $row (@rows) {
    $row->{boundary} =~ /^(free|periodic|periodic-x|periodic-y)$/ or die "boundary\n";
    exists $row->{$_} or die "no $_\n" for qw(tol converged threads peak_memory memory_estimate);
    ref $row->{seconds} eq "HASH" && $row->{seconds}{total} > 0 or die "seconds\n";
    my $sum = 0;
    $_ eq "total" || $_ eq "write" or $sum += $row->{seconds}{$_} for keys %{$row->{seconds}};
    $sum <= 1.0001 * $row->{seconds}{total} + 1e-6 or die "phases of $sum s, in all $row->{seconds}{total}\n";
    check_effects("report", $row->{effects});
    /error|mismatch/ && !/_error_estimate$/ && $_ ne "error_limited_by" and die "the name $_\n" for keys %$row;
    /_error_estimate$/ && ref $row->{$_} and die "$_ is no number\n" for keys %$row;
}
grep { $_ eq "seconds" } @column or die "no column seconds\n";
grep { $_ eq "tol" } @column or die "no column tol\n";
check_effects("plan", $dry->{effects});
join(" ", sort keys %{$dry->{effects}}) eq join(" ", sort keys %{$rows[0]{effects}}) or die "other effects in the plan: @{[sort keys %{$dry->{effects}}]}\n";
$dry->{expected_memory} > 1e5 or die "expected_memory $dry->{expected_memory}\n";
$dry->{expected_seconds} > 0 or die "expected_seconds\n";
exists $dry->{expected_convolutions} or die "expected_convolutions\n";
$dry->{nx} == 32 && $dry->{boundary} eq $rows[0]{boundary} or die "the map\n";
END
one() {
    local command=$1
    rm -f r.json r.tsv p.json &&
        $command --quiet --report r.json -o out.rcg && $command --quiet --report r.tsv -o out.rcg &&
        $command --quiet --dry-run --report p.json >plan.txt && perl look.pl r.json r.tsv p.json
}
while read -r command; do
    claim "report and plan: $command" one "$command"
    claim "  the plan names memory and time" says 'about .*[0-9] MiB, .*[0-9.e-]+ s with [0-9]+ thread' cat plan.txt
done <commands.txt
claim "--dry-run --report - prints the numbers alone" bash -c '
    rc-leak --quiet --dry-run --report - pressed.rcg >plan.txt && [ $(wc -l <plan.txt) = 1 ] && grep -q "^{.*expected_seconds" plan.txt'

# ---- the figures of --completions json ----

cat >figures.pl <<'END'
use strict;
use JSON::PP;
my ($json, $lines) = @ARGV;
sub slurp { local $/; open my $f, "<", $_[0] or die "$_[0]: none\n"; my $t = <$f>; $t }
my %figure = map { $_->{name} => $_ } @{decode_json(slurp($json))->{figures}};
keys %figure > 3 or die "no figures\n";
for my $row (map { decode_json($_) } split /\n/, slurp($lines)) {
    for (grep { /_error_estimate$/ } keys %$row) {
        my $f = $figure{$_} or next; # of the models that are not in use
        $f->{role} eq "error" && $f->{by} && $f->{of} or die "$_: $f->{role}\n";
    }
    for (qw(iterations convolutions)) { # not every tool has both
        !exists $row->{$_} || $figure{$_}{role} eq "cost" or die "$_ is no cost\n";
    }
    for (grep { /^max_pressure$|^friction$|^flow_factor$|^wear_volume$/ } keys %$row) {
        $figure{$_}{role} eq "result" && exists $figure{$_}{unit} or die "$_ is no result\n";
    }
}
my @errors = grep { $_->{role} eq "error" } values %figure;
@errors > 0 || !grep { /error/ } keys %figure or die "no error\n";
END
while read -r tool rest; do
    claim "--completions json has the figures of $tool" bash -c "
        $tool --completions json >figures.json && $tool $rest --quiet --report lines.json -o out.rcg && perl figures.pl figures.json lines.json"
done <commands.txt
