# SPDX-License-Identifier: GPL-3.0-or-later
# The tests of this folder source this file after pipe.sh. It has small inputs, and command lines for every
# kind of work of every tool. Each writes only `out` or standard output. The number before a command line
# multiplies the step from one failing allocation to the next.

# All commands use one thread, so that the n-th allocation or call is always the same one.
export RC_THREADS=1
# The date in formats that contain one.
export SOURCE_DATE_EPOCH=1700000000

make_inputs() {
    rc-synth selfaffine --nx 16 --ny 18 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 3 -o h.rcg
    rc-solve --quiet --estar 1GPa --load 1mN h.rcg -o c.rcg
    rc-solve --quiet --E1 1GPa --nu1 0.3 --E2 rigid --layer 2um,2GPa,0.3 --load 1mN h.rcg -o l.rcg
    local channel
    for channel in traction-x pressure traction-y; do
        rc-pick --channel pressure c.rcg | sed "s/^channel=pressure\$/channel=$channel/" | reseal | perl -0777 -pe 's/RCGEND 1\n//'
    done >t.rcg
    echo RCGEND 3 >>t.rcg
    local format
    for format in x3p sdf gsf npy csv xyz hdf5 gwy sur mat; do rc-export h.rcg -o "h.$format"; done
    gzip -kn h.gsf
    printf '5 6 7\n6 NaN 8\n7 8 9\n' >hole.txt
    printf 'x/N\ty/m\tk\n1\t1\ta\n1\t2\ta\n2\t3\tb\n2\t5\tb\n' >table.tsv
    rc-import --dx 1um --z-unit nm hole.txt -o hole.rcg
}

# Each line has the factor of the step between faults, then the command.
commands=$(
    cat <<'LIST'
1 rc-synth selfaffine --nx 16 --dx 1um --hurst 0.8 --rms-slope 0.1 --weibull 2 -o out
1 rc-synth sphere --nx 16 --dx 1um --radius 1mm --type f32
1 rc-import h.x3p -o out
1 rc-import h.sdf -o out
1 rc-import h.gsf.gz -o out
1 rc-import --dx 1um --z-unit m h.npy -o out
1 rc-import --dx 1um --z-unit m h.csv -o out
1 rc-import --z-unit m --dx 1um h.xyz -o out
2 rc-import h.hdf5 -o out
1 rc-import h.gwy -o out
1 rc-import h.sur -o out
1 rc-import h.mat -o out
1 rc-import --list h.gwy
2 rc-detrend --plane --rows bow --poly 3 --lowpass 6um --outliers 5 --taper 3um h.rcg -o out
1 rc-detrend --spikes 0.5 h.rcg -o out
1 rc-detrend --sphere --robust h.rcg -o out
1 rc-detrend --cylinder h.rcg -o out
1 rc-detrend --fill hole.rcg -o out
1 rc-detrend --mirror hole.rcg -o out
1 rc-detrend --robust --highpass 6um h.rcg -o out
1 rc-pick --crop 2,2,12,12 --resample 0.7um,1.6um --mirror x --rotate 90 --set note=a h.rcg -o out
1 rc-pick --channel pressure c.rcg
1 rc-add h.rcg h.rcg -o out
2 rc-solve --quiet --periodic --estar 1GPa --hardness 20MPa --load 1mN:2mN:2 --history --output pressure,plastic h.rcg -o out
1 rc-solve --quiet --kernel mlms --estar 1GPa --approach 0.1um --report /dev/null h.rcg -o out
1 rc-solve --quiet --method pk99 --kernel direct --estar 1GPa --load 1mN --discretization h.rcg -o out
1 rc-solve --quiet --E1 1GPa --nu1 0.3 --E2 rigid --layer 2um,2GPa,0.3 --load 1mN h.rcg -o out
1 rc-solve --quiet --estar 1GPa --load 1mN --conductivity 45W/mK,16W/mK --report /dev/null h.rcg -o out
1 rc-solve --quiet --estar 1GPa --load 1mN --dry-run h.rcg
2 rc-slip --quiet --mu 0.3 --nu 0.3 --tangential 0.1mN --report /dev/null c.rcg -o out
4 rc-slip --quiet --mu 0.3 --E1 0.91GPa --nu1 0.3 --E2 rigid --path 0.5mN,0,0;1mN,0.1mN,0 --increments 2 c.rcg
4 rc-solve --quiet --periodic --relaxation 1GPa,1GPa:1ms --nu1 0.49 --E2 rigid --load 1mN --speed 1e-3,0.1 h.rcg -o out
4 rc-solve --quiet --estar 1GPa --load 1mN --radius 1mm --travel 0,1um --counter h.rcg --window 12x12 h.rcg -o out
4 rc-wear --quiet --coefficient 1e-6mm3/Nm --distance 1m --steps /dev/null c.rcg -o out
2 rc-fatigue --quiet --nu 0.3 --bending-limit 6MPa --torsion-limit 4MPa --criteria dangvan,findley --pass x --depths 1um,2um --report /dev/null c.rcg -o out
2 rc-heat --quiet --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5,1e-5 --depths 0,1um --report /dev/null c.rcg -o out
5 rc-stress --nu 0.3 --depths auto c.rcg -o out
2 rc-stress --nu 0.3 --mu 0.1 --depths 1um,2um --components mises,s1 --report /dev/null c.rcg -o out
3 rc-stress --nu 0.3 --section y=0 --depths 0:4um:4 c.rcg -o out
5 rc-stress --depths auto l.rcg -o out
3 rc-stress --nu 0.3 --depths 1um --components sxz t.rcg -o out
1 rc-deflect --estar 1GPa c.rcg -o out
1 rc-deflect --estar 1GPa --kernel mlms c.rcg -o out
1 rc-info --areal --psd h.rcg -o out
1 rc-info --json --areal --psd h.rcg
1 rc-info --areal --profile rows --report /dev/null h.rcg
1 rc-info --patches --json c.rcg -o out
1 rc-info --psd --psd-map map h.rcg -o out
1 rc-solve --quiet --estar 1GPa --load 1mN --checkpoint kept --resume h.rcg -o out
1 rc-export --format x3p h.rcg -o out
1 rc-export --format sdf h.rcg -o out
1 rc-export --format npy h.rcg -o out
1 rc-export --format mat h.rcg -o out
1 rc-export --format stl --relief 5mm --verbose h.rcg -o out
1 rc-export --format gwy --channel height c.rcg -o out
1 rc-export --format hdf5 c.rcg -o out
1 rc-export --format vti c.rcg -o out
1 rc-export --format vtr c.rcg -o out
1 rc-export --format csv h.rcg
3 rc-render --raw --channel pressure c.rcg -o out.png
6 rc-render --figure --channel pressure c.rcg -o out.pdf
6 rc-render --curve x:y --by k --spread table.tsv -o out.pdf
32 rc-cost --quiet --tol 1e-2 --plot plot.png -o out h.rcg -- rc-solve --periodic --estar 1GPa --load 1mN --method pk99
32 rc-cost --quiet --grid 2,1 -o out h.rcg -- rc-solve --periodic --estar 1GPa --load 1mN | rc-stress --nu 0.3 --depths 1um,2um
1 rc-cost --quiet --tol 1e-2,1e-3 --dry-run h.rcg -- rc-solve --estar 1GPa --load 1mN --kernel direct
LIST
)
commands="$commands
32 rc-scene --quiet --load 1mN --E1 1GPa --nu1 0.3 --E2 2GPa --nu2 0.3 --hardness 0.1GPa --yield 0.1GPa --mu 0.3 --coefficient 1e-9mm3/Nm --distance 1um --report /dev/null h.rcg -o out
1 rc-leak --quiet --viscosity 1mPas --pressure-drop 1kPa --report /dev/null c.rcg -o out
1 rc-leak --quiet --direction y --output channel c.rcg"

# written COMMAND: prints the file that the command writes, nothing for standard output.
written() {
    local name=${1##* -o }
    case $1 in *' -o '*) echo "${name%% *}" ;; esac
}

# A further file of a command is complete or absent, and a checkpoint can be resumed.
whole_beside() {
    [ ! -e map ] || rc-info --quiet map >/dev/null 2>&1 || return 1
    [ ! -e plot.png ] || [ "$(tail -c 8 plot.png | head -c 4)" = IEND ] || return 1
    [ ! -e kept ] || [ ! -s kept ] || rc-solve --quiet --estar 1GPa --load 1mN --checkpoint kept --resume --output pressure h.rcg >/dev/null 2>&1 || return 1
    rm -f map kept plot.png
}

# Lists files that a run must not leave behind.
others() {
    local f
    for f in * .[!.]*; do
        case $f in map | kept | plot.png | out | out.png | out.pdf | run.out | run.err | clean | clean.out | count | '.[!.]*') ;; *) echo "$f" ;; esac
    done
}

# costs_of FILE: prints settings and errors of a table of rc-cost. It omits times and memory, which change
# from run to run, and prints nothing for other files.
costs_of() {
    awk '/^#/ || !NF { next }
        !heads { heads = NF; for (k = 1; k <= NF; k++) skips[k] = $k ~ /^(time|cpu|runs|memory|note)/; next }
        { for (k = 1; k <= heads; k++) printf "%s ", skips[k] ? "" : $k; print "" }' "$1" 2>/dev/null
}

# without_result FILE: the trials without a result, with the reason.
without_result() {
    grep -acE '^# .*: (its process died|it failed|left out|stopped)' "$1"
}

# same_costs A B: equal, except for trials that A reports as impossible.
same_costs() {
    local extra missing
    extra=$(comm -23 <(costs_of "$1" | sort) <(costs_of "$2" | sort) | wc -l)
    missing=$(comm -13 <(costs_of "$1" | sort) <(costs_of "$2" | sort) | wc -l)
    [ -n "$(costs_of "$1")" ] && [ "$extra" = 0 ] && [ "$missing" = $(($(without_result "$1") - $(without_result "$2"))) ]
}

# same_work A B: equal files, or streams with equal headers and values equal to rounding. Without memory for
# sorting the C library uses another algorithm, and the order of sums changes.
same_work() {
    cmp -s "$1" "$2" || same_costs "$1" "$2" || perl -e '
        sub frames {
            local $/; open my $f, "<:raw", $_[0] or exit 1; my $s = <$f>; my @frames;
            while ($s =~ /\G(RCG1\n.*?\n\n)/gcs) {
                my ($head, $at) = ($1, pos $s);
                my ($nx) = $head =~ /^nx=(\d+)/m; my ($ny) = $head =~ /^ny=(\d+)/m;
                my $wide = $head =~ /^type=f32/m ? 4 : 8;
                push @frames, [$head, unpack(($wide == 4 ? "f" : "d") . "<*", substr $s, $at, $wide * $nx * $ny)];
                pos($s) = $at + $wide * $nx * $ny; $s =~ /\Gcrc32 \w+\n/gc;
            }
            exit 1 unless @frames && $s =~ /\GRCGEND \d+\n$/gc; return @frames;
        }
        my @a = frames($ARGV[0]); my @b = frames($ARGV[1]); exit 1 if @a != @b;
        for my $f (0 .. $#a) {
            my ($x, $y) = ($a[$f], $b[$f]); my $most = 0;
            exit 1 if $x->[0] ne $y->[0] || @$x != @$y;
            for (1 .. $#$x) { $most = abs $x->[$_] if abs $x->[$_] > $most }
            for (1 .. $#$x) { exit 1 if !(abs($x->[$_] - $y->[$_]) <= 1e-13 * $most) && "$x->[$_]" ne "$y->[$_]" }
        }' "$1" "$2"
}

# same_said FILE FILE: equal standard output, except for the mebibytes and the seconds of a plan. The mebibytes
# include the memory of the process, and with it that of the preloaded library; law_memory tests that the plan
# itself needs no memory. The seconds are those of a trial on this machine.
same_said() {
    cmp -s "$1" "$2" || cmp -s <(unmeasured "$1") <(unmeasured "$2")
}
unmeasured() { sed -E 's/, [0-9]+ MiB(,|$)/, MiB\1/; s/ *[0-9.e+-]+ s( |,|$)/ s\1/g' "$1"; }

# judge STATUS OUT WHERE: checks that a disturbed run has either done all of its work or has failed cleanly.
# Otherwise it prints the reason and fails.
judge() {
    local status=$1 out=$2 where=$3 tool=${4%% *}
    whole_beside || {
        echo "$where: map or checkpoint is not whole"
        return 1
    }
    case $status in
    0)
        if { [ -z "$out" ] || same_work "$out" clean; } && same_said run.out clean.out; then return 0; fi
        echo "$where: exit status 0 and another output"
        ;;
    1)
        if [ -n "$out" ] && [ "$(tr -d '\0' <"$out")" != old ]; then
            echo "$where: the old file is not as it was, and: $(head -c 900 run.err | tr -d '\0')"
        elif ! grep -aq "^$tool: " run.err; then
            echo "$where: no message, only: $(head -c 300 run.err | tr -d '\0')"
        else
            return 0
        fi
        ;;
    *) echo "$where: exit status $status: $(head -c 600 run.err | tr -d '\0')" ;;
    esac
    return 1
}
