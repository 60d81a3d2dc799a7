# SPDX-License-Identifier: GPL-3.0-or-later
# The report of rc-stress gives the largest and the smallest value of each component with its position, over
# all materials and in each. They equal the closed form for two waves. Depths far below the map get a warning.
. "$(dirname "$0")/../pipe.sh"

# p = cos t + 0.5 cos 2t with t = 2 pi x/L in plane strain, from 1.5 Pa down to -0.75 Pa, on a coat of the
# substrate's material. For each wave of amplitude a and wave number q szz is -a (1 + q z) e^(-q z) cos q x,
# sxx is -a (1 - q z) e^(-q z) cos q x. sxz is -a q z e^(-q z) sin q x, and syy is nu (sxx + szz).
rc-synth wave --nx 33 --dx 1um --ny 1 --amplitude 1 --wavelength 33um -o a.rcg
rc-synth wave --nx 33 --dx 1um --ny 1 --amplitude 0.5 --wavelength 16.5um -o b.rcg
rc-add a.rcg b.rcg | rc-pick --set channel=pressure --set unit=Pa --set boundary=periodic \
    --set 'layers=2.5e-06,2e11,0.3;inf,2e11,0.3' -o two.rcg
rc-stress --depths 0,1um,2.5um,3um,8um --components szz,s1,s3,mises --report two.json two.rcg -o two-stress.rcg

rc-stress --depths 0,1um,2.5um,3um,8um --components szz,s1,s3,mises --report two.tsv two.rcg -o x.rcg
claim "a table has the extreme values and their depths, as the JSON" perl -MJSON::PP -e '
    open my $f, "<", "two.json" or die; my $r = decode_json(<$f>);
    open my $g, "<", "two.tsv" or die; chomp(my @l = <$g>);
    my %is; @is{split /\t/, $l[0]} = split /\t/, $l[1];
    for my $c (qw(szz s1 s3 mises)) {
        for my $m (qw(max min)) {
            next if $c eq "mises" && $m eq "min";
            abs($is{"${m}_$c/Pa"} - $r->{$m}{$c}{value}) <= 1e-12 * abs $r->{$m}{$c}{value} or die "${m}_$c";
            $is{"${m}_${c}_depth/m"} == $r->{$m}{$c}{depth} or die "${m}_$c depth";
        }
    }
    grep(/^min_mises|_sxx/, keys %is) and die "a column too many"'
claim "each depth has a frame for each component" test "$(channels two-stress.rcg)" = \
    "$(for _ in 1 2 3 4 5; do echo szz mises s1 s3; done | xargs)"
cat >judge.pl <<'END'
use JSON::PP;
local $/;
my $r = decode_json(<>);
my ($pi, $nu, @depth) = (4 * atan2(1, 1), 0.3, 0, 1e-6, 2.5e-6, 3e-6, 8e-6);
my (%all, %in, %deep);
for my $k (0 .. $#depth) {
    for my $i (0 .. 32) {
        my ($x, $z, $xx, $zz, $xz) = (($i - 16) * 1e-6, $depth[$k], 0, 0, 0);
        for ([1, 2 * $pi / 33e-6], [0.5, 2 * $pi / 16.5e-6]) {
            my ($a, $q) = @$_;
            my $e = $a * exp(-$q * $z);
            $zz -= (1 + $q * $z) * $e * cos($q * $x);
            $xx -= (1 - $q * $z) * $e * cos($q * $x);
            $xz -= $q * $z * $e * sin($q * $x);
        }
        my $yy = $nu * ($xx + $zz);
        my ($m, $d) = (($xx + $zz) / 2, sqrt((($xx - $zz) / 2) ** 2 + $xz ** 2));
        my @s = sort { $b <=> $a } $m + $d, $m - $d, $yy;
        my %s = (szz => $zz, s1 => $s[0], s3 => $s[2],
            mises => sqrt((($s[0] - $s[1]) ** 2 + ($s[1] - $s[2]) ** 2 + ($s[2] - $s[0]) ** 2) / 2));
        for my $c (keys %s) {
            for my $end (1, -1) {
                my $here = [$s{$c}, abs $x, $z];
                for ($all{$c}{$end}, $in{$c}{$end}[$z > 2.5e-6], $deep{$c}{$end}[$k]) {
                    $_ = $here if !$_ || $end * $here->[0] > $end * $_->[0] + 1e-13;
                }
            }
        }
    }
}
sub same { my ($what, $a, $b, $t) = @_; abs($a - $b) <= $t or die "$what: $a, expected $b\n" }
for my $c (keys %all) {
    for ([max => 1], [min => -1]) {
        my ($name, $end) = @$_;
        my ($got, $want) = ($r->{$name}{$c}, $all{$c}{$end});
        same("$c $name", $got->{value}, $want->[0], 1e-12);
        same("$c $name at x", abs $got->{x}, $want->[1], 1e-15);
        same("$c $name at y", $got->{y}, 0, 0);
        same("$c $name at depth", $got->{depth}, $want->[2], 0);
        same("$c $name in depth $_", $got->{by_depth}[$_], $deep{$c}{$end}[$_][0], 1e-12) for 0 .. $#depth;
        for my $m (0, 1) {
            my $place = $got->{place_by_material}[$m];
            same("$c $name in material $m", $got->{by_material}[$m], $in{$c}{$end}[$m][0], 1e-12);
            same("$c $name in material $m at x", abs $place->[0], $in{$c}{$end}[$m][1], 1e-15);
            same("$c $name in material $m at y", $place->[1], 0, 0);
            same("$c $name in material $m at depth", $place->[2], $in{$c}{$end}[$m][2], 0);
        }
    }
}
END
claim "largest and smallest values and their places agree with the closed form, in all and by material" \
    perl judge.pl two.json
claim "  the same holds for a section" bash -c '
    rc-stress --section y=0 --depths 0,1um,2.5um,3um,8um --components szz,s1,s3,mises --report s.json \
        two.rcg -o section.rcg && perl judge.pl s.json'

# ---- the tension that cracks a film ----

rc-synth sphere --nx 128 --dx 4um --radius 7.5mm |
    rc-solve --quiet --load 240N --E1 208GPa --nu1 0.3 --E2 208GPa --nu2 0.3 --output pressure -o ball.rcg
rc-stress --depths 0 --components s1 --report ball.json ball.rcg -o ball-stress.rcg
end() { perl -MJSON::PP -e 'local $/; my $r = decode_json(<>); print "$r->{'"$1"'}{s1}{'"$2"'}\n"' ball.json; }
# Johnson 1985, section 3.4: (1 - 2 nu) p0/3 at the edge; the error of the grid is 3 % with 57 cells in the
# radius
near "$(end max value)" "$(awk 'BEGIN { print 0.4 / 3 * 2.20472e9 }')" 0.03 "the tension around Hertz's contact"
between 0.99 "$(awk -v x="$(end max x)" -v y="$(end max y)" 'BEGIN { print sqrt(x * x + y * y) / 227.98e-6 }')" \
    1.04 "  is at its edge, in radii"
# in the middle s1 is the larger of sxx = -(1 + 2 nu) p0/2 and szz
near "$(end min value)" "$(awk 'BEGIN { print -0.8 * 2.20472e9 }')" "$coarse_grid" "  beside the compression in its middle"
between 0 "$(awk -v x="$(end min x)" -v y="$(end min y)" 'BEGIN { print sqrt(x * x + y * y) }')" 4e-6 "  within a cell"

# ---- depths meant in micrometres ----

claim "a depth of 5 m under a map of half a millimetre causes a warning" \
    warns '--depths: 5 m is 9\.8e\+03 times the width of the map, 0\.000512 m.*write 5um' \
    rc-stress --depths 0,5 --components szz -o far.rcg ball.rcg
claim "  a depth within ten widths causes none" bash -c '
    rc-stress --depths 5.1mm --components szz -o far.rcg ball.rcg 2>said.txt && ! test -s said.txt'
claim "  a slightly larger one does" warns 'times the width' rc-stress --depths 5.2mm --components szz -o far.rcg ball.rcg
