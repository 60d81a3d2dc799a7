# SPDX-License-Identifier: GPL-3.0-or-later
# No tool writes NaN or infinity unless its input has them: not in frames, keys or reports, for any valid
# numbers in the input. A tool whose results overflow reports this and fails.
. "$(dirname "$0")/../pipe.sh"

# Exits with 1 if a stream or a text contains a number that is not finite, and prints it.
cat >finite.pl <<'P'
my $bad = 0;
local $/;
for my $name (@ARGV) {
    open my $file, "<:raw", $name or next;
    my $b = <$file>;
    $bad++, print STDERR "$name: $1\n" if $b !~ /^RCG1/ && $b =~ /((?:^|[^a-z_])-?(?:nan|inf|infinity)(?![a-z_]))/i;
    while ($b =~ /\GRCG1\n(.*?)\n\n/gcs) {
        my $head = $1;
        my %key = map { /^([^=]*)=(.*)$/ ? ($1, $2) : () } split /\n/, $head;
        my $width = $key{type} eq "f32" ? 4 : 8;
        my $n = $key{nx} * $key{ny};
        my @v = unpack(($width == 4 ? "f<" : "d<") . "*", substr($b, pos($b), $width * $n));
        my $k = grep { $_ != $_ || abs($_) == 9**9**9 } @v;
        $bad++, print STDERR "$name: $k of $n values of $key{channel}\n" if $k;
        /^-?(nan|inf)/i and $bad++, print STDERR "$name: a key is $_\n" for values %key;
        pos($b) += $width * $n;
        $b =~ /\Gcrc32 \w+\n/gc;
    }
}
exit($bad > 0);
P

# tried 'shell command': it ends without a signal, with an exit status of the tool. All numbers in out.rcg,
# report.json and standard output are finite; if it failed, it printed the reason.
ran=0
done_well=0
tried() {
    rm -f out.rcg report.json
    timeout 60 bash -c "$1" >out.txt 2>err.txt
    local status=$?
    ran=$((ran + 1))
    [ "$status" = 0 ] && done_well=$((done_well + 1))
    if [ "$status" -gt 3 ] || { [ "$status" != 0 ] && [ ! -s err.txt ]; } || ! perl finite.pl out.rcg report.json out.txt 2>why.txt; then
        claim "$1: exit status $status: $(head -n 3 why.txt | tr '\n' ';')" false
    fi
}

# heights KIND NX NY
cat >heights.pl <<'P'
my ($kind, $nx, $ny) = @ARGV;
srand 4;
my %of = (zero => sub { 0 }, constant => sub { 3.3e-6 }, plain => sub { 1e-6 * rand },
    denormal => sub { 4.9e-324 * int(1 + 9 * rand) }, tiny => sub { 1e-300 * rand },
    small => sub { 1e-160 * rand }, large => sub { 1e150 * rand }, huge => sub { 1e300 * (rand() - 0.5) },
    largest => sub { rand() < 0.5 ? -1.7e308 : 1.7e308 },
    spike => sub { $_[0] == int($nx * $ny / 2) ? 1e308 : 0 },
    mixed => sub { (1e300, 1e-300, 0, 4.9e-324)[4 * rand] });
for my $j (0 .. $ny - 1) {
    print join(",", map { $of{$kind}->($j * $nx + $_) } 0 .. $nx - 1), "\n";
}
P

tools_on() {
    local f=$1 load
    tried "rc-info --json --areal $f >out.txt"
    tried "rc-info --json --psd --psd-map out.rcg $f"
    for step in --plane '--poly 3' --sphere --cylinder '--robust --plane' '--lowpass 5um' '--robust --highpass 5um' '--taper 2um'; do
        tried "rc-detrend $step $f -o out.rcg"
    done
    tried "rc-detrend --outliers 3 --fill $f -o out.rcg"
    tried "rc-pick --resample 7x5 $f -o out.rcg"
    tried "rc-pick --resample 29x31 --type f32 $f -o out.rcg"
    tried "rc-add $f $f -o out.rcg"
    tried "rc-add --subtract $f $f -o out.rcg"
    for load in 1e-300 1 1e300; do
        tried "rc-solve --load $load --estar 1GPa --report report.json $f -o out.rcg"
    done
    tried "rc-solve --periodic --load 1 --estar 1GPa --stiffness --discretization --report report.json $f -o out.rcg"
    tried "rc-solve --load 1 --hardness 1e300 --estar 1e-300 --report report.json --output pressure,gap,displacement,height,plastic $f -o out.rcg"
    tried "rc-solve --approach 1e-7 --estar 1GPa --report report.json $f -o out.rcg"
    tried "rc-export --format csv $f"
}

maps=0
for kind in zero constant plain denormal tiny small large huge largest spike mixed; do
    for shape in 13,11 16,1 1,1; do
        for d in 1e-60 1e-6 1e60; do
            case $kind,$shape,$d in *,13,11,1e-6 | plain,* | huge,13,* | tiny,13,*) ;; *) continue ;; esac
            perl heights.pl $kind ${shape%,*} ${shape#*,} >heights.csv
            rc-import --dx $d --z-unit 1 $([ $shape = 13,11 ] || echo --format profile) heights.csv -o h.rcg 2>/dev/null || continue
            maps=$((maps + 1))
            tools_on h.rcg
        done
    done
done
between 19 "$maps" 25 "maps of hostile heights"

# Pressures and synthetic surfaces.
for p in 4.9e-324 1e-300 1e150 1e300; do
    rc-synth sphere --nx 12 --dx 1um --radius 1mm | rc-pick --set channel=pressure --set unit=Pa >p.rcg
    perl -0777 -pe 's/(unit=Pa.*?\n\n)(.{1152})/$1 . pack("d<*", (('$p') x 143, 0))/se' p.rcg | reseal >q.rcg
    tried "rc-deflect --estar 1GPa q.rcg -o out.rcg"
    tried "rc-deflect --periodic --estar 1e-300 q.rcg -o out.rcg"
    tried "rc-deflect --kernel fft --tol 1e-3 --estar 1GPa q.rcg -o out.rcg"
    tried "rc-stress --nu 0.3 --mu 0.5 --depths 0,1e-300,1e-6,1e300 --report report.json q.rcg -o out.rcg"
    tried "rc-stress --nu 0.5 --section x=0 --depths 1e-9,1e-6 --report report.json q.rcg -o out.rcg"
    tried "rc-info --patches --json q.rcg"
done
for options in 'sphere --radius 1e-300' 'sphere --radius 1e300' 'cone --slope 1e300' 'punch --radius 1e-300 --height 1e308' \
    'wave --amplitude 1e308 --wavelength 1e-5' 'selfaffine --hurst 0.8 --rms-slope 1e300' 'selfaffine --hurst 1e-300 --rms-height 1e300' \
    'selfaffine --hurst 1 --rms-height 1e-300 --skewness 1'; do
    for d in 1e-60 1e-6 1e60; do
        tried "rc-synth $options --nx 16 --dx $d -o out.rcg"
        tried "rc-synth $options --nx 16 --dx $d --type f32 -o out.rcg"
    done
done
claim "some runs succeed: $done_well of $ran" [ "$done_well" -gt $((ran / 3)) ]
claim "some runs are refused" [ "$done_well" -lt "$ran" ]

# Spacings whose squares or wave numbers are no numbers of double precision.
rc-synth selfaffine --nx 16 --dx 1um --hurst 0.8 --rms-slope 0.1 -o rough.rcg
for d in 5e-324 1e-300 9e-61 1.1e60 1e300; do
    sed "s/^dx=.*/dx=$d/" rough.rcg | reseal >far.rcg
    for tool in "rc-info --psd" "rc-info --areal" "rc-report -o page.html" "rc-solve --load 1 --estar 1GPa -o out.rcg"; do
        refuses 1 "spacing dx=[0-9.e+-]+ dy=1e-06 m: both must be from 1e-60 to 1e\+60" "$tool of a spacing of $d" "timeout 20 $tool far.rcg"
    done
    refuses 1 '1e-60 to 1e\+60' "rc-synth --dx $d" "rc-synth sphere --radius 1 --nx 16 --dx $d -o out.rcg"
done

# NaN in the input appears in the output.
printf '1,2,3\n4,nan,6\n7,8,9\n' >holes.csv
claim "a missing point stays missing" bash -c 'rc-import --dx 1um --z-unit 1um holes.csv | rc-detrend --plane | says "\"missing\": 1" rc-info --json'
claim "an outlier becomes missing" bash -c 'rc-synth selfaffine --nx 16 --dx 1um --hurst 0.8 --rms-height 1um | rc-detrend --outliers 1 | says "\"missing\": [1-9]" rc-info --json'
refuses 1 "values of height are too large for single precision.*--type f64" "single precision is named" \
    "rc-synth cone --slope 1e50 --nx 16 --dx 1um --type f32 -o out.rcg"
