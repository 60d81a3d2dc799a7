# SPDX-License-Identifier: GPL-3.0-or-later
# The errors of rc-cost are those of the pressures of rc-solve with the same words, computed here
# independently. Its reference agrees with Hertz; the proposed command has the stated error, and a command that
# is not a pipe of these tools is refused.
. "$(dirname "$0")/../pipe.sh"

# Prints the values of a stream of one f64 frame, one per line, without the checksum and the end line after
# them.
values() {
    head -c -24 "$1" | tail -c "$((8 * $2))" | od -An -v -w8 -t f8
}

# off A B N: prints the relative L1 distance of the N values of two streams.
off() {
    values "$1" "$3" >a.txt
    values "$2" "$3" >b.txt
    paste a.txt b.txt | awk '{ d = $1 - $2; s += d < 0 ? -d : d; t += $2 } END { printf "%.12g\n", s / t }'
}

# column NAME FILE: prints the values of a column of the table, one per row.
column() {
    awk -v name="$1" '/^#/ { next } !at { for (k = 1; k <= NF; k++) if ($k == name) at = k; next } { print $at }' "$2"
}

export RC_THREADS=1

# ---- a rough periodic surface: the nine tolerances ----

rc-synth selfaffine --nx 66 --ny 62 --dx 1um --hurst 0.8 --rms-slope 0.1 --rolloff 30um --short-cut 6um --seed 11 \
    -o rough.rcg
nodes=$((66 * 62))
contact="rc-solve --periodic --mean-pressure 2GPa --estar 114GPa"
nine=1e-2,1e-3,1e-4,1e-5,1e-6,1e-7,1e-8,1e-9,1e-10
rc-cost --tol $nine --reference tol=1e-12 --quiet -o cost.txt --report cost.json --plot cost.png rough.rcg -- $contact
$contact --tol 1e-12 --output pressure --quiet -o truth.rcg rough.rcg

# Tolerance of figures with three digits, with the rounding of the last one.
three_and=$(awk -v t="$three_digits" 'BEGIN { print 1.2 * t }')
every_error() {
    paste <(column tol cost.txt) <(column error cost.txt) | awk '$1 != "1e-12"' >full.txt
    [ "$(wc -l <full.txt)" = 9 ] || return 1
    while read -r tol error; do
        $contact --tol "$tol" --output pressure --quiet -o one.rcg rough.rcg || return 1
        echo "$tol $error $(off one.rcg truth.rcg $nodes)"
    done <full.txt >both.txt
    cat both.txt >&2
    awk -v digits="$three_and" -v floor="$of_sum" '
        { d = $2 - $3; if (d < 0) d = -d; if (NF != 3 || d > digits * $3 + floor) bad = 1 }
        END { exit bad || NR != 9 }' both.txt
}
claim "true errors equal those of rc-solve with these tolerances" every_error
claim "  none is above its tolerance" bash -c "awk '\$2 > \$1 { exit 1 }' both.txt"
# Figures have three digits, and below 1e-11 the error of the reference matters.
estimates() {
    paste <(column estimate cost.txt) <(column error cost.txt) |
        awk -v t="$three_digits" '$2 > 1e-11 { n++; if ($1 < (1 - t) * $2 || $1 > 1.5 * $2) exit 1 } END { exit n < 7 }'
}
claim "estimates are 1 to 1.5 times the true errors" estimates
claim "the default study has 1/8, 1/4, 1/2 and 1 of the nodes a side, and five tolerances" bash -c "
    rc-cost --quiet -o default.txt rough.rcg -- $contact && [ \$(grep -c '^ *1/[842] ' default.txt) = 15 ] && [ \$(grep -c '^ *1 ' default.txt) = 6 ]"

# A trial is on the front if no other one is as accurate, and faster or smaller by more than the scatter and in
# nothing worse. Below the error of the reference all errors count as equal.
front_again() {
    perl -MJSON::PP -e '
        my ($floor, @trial) = (0);
        while (<>) {
            my $r = decode_json($_);
            push @trial, $r if $r->{state} eq "done";
            $floor = $r->{bound} if $r->{what} eq "reference";
        }
        my $marked = 0;
        for my $r (@trial) {
            $marked += $r->{front};
            my $seen = sub { my $e = $_[0]{error}; $e > $floor ? $e : $floor };
            my $s = 0.1 * $r->{seconds}; $s = 2e-3 if $s < 2e-3;
            my $b = 0.1 * $r->{memory}; $b = 1048576 if $b < 1048576;
            my $beaten = grep {
                my ($f, $m) = ($r->{seconds} - $_->{seconds}, $r->{memory} - $_->{memory});
                $_->{converged} && $seen->($_) <= $seen->($r) && ($f > $s && $m >= -$b || $m > $b && $f >= -$s) } @trial;
            die "$r->{tol}: marked or not, it is wrong\n" if !$beaten != !!$r->{front};
        }
        die "none is marked\n" if !$marked;' "$1"
}
claim "the front has the trials that no other beats in time or memory by more than the scatter" front_again cost.json
rc-synth sphere --nx 96 --dx 5um --radius 7.5mm -o ball.rcg
rc-synth sphere --nx 256 --dx 2um --radius 7.5mm -o plain.rcg
rc-cost --vary kernel=fft64,direct --quiet --report sums.json -o sums.txt plain.rcg -- rc-solve --load 20N --estar 114GPa
claim "  also where plain sums take longer" bash -c "$(declare -f front_again); front_again sums.json && grep -q '\"front\": false' sums.json"
table_again() {
    perl -MJSON::PP -e '
        open my $table, "<", "cost.txt" or die;
        my @row = map { [split] } grep { !/^#/ } <$table>;
        my %at = map { $row[0][$_] => $_ } 0 .. $#{$row[0]};
        my %by;
        while (<>) { my $r = decode_json($_); $by{sprintf "%g", $r->{tol}} = $r }
        for my $cell (@row[1 .. $#row]) {
            my $r = $by{sprintf "%g", $cell->[0]} or die "@$cell: not in the report\n";
            for (["estimate", $r->{estimate}], ["error", $r->{error}], ["bound", $r->{bound}],
                 map { [$_, $r->{"${_}_error"}] } "max_pressure", "contact_area", "approach") {
                die "@$cell: $_->[0] is not $_->[1]\n" if $cell->[$at{$_->[0]}] ne sprintf "%.2e", $_->[1];
            }
        }
        die scalar(@row), " rows\n" if @row != 11;' cost.json
}
claim "each trial has a JSON line with the figures of the table" table_again
claim "the picture is a PNG of 1200 pixels" bash -c '
    [ "$(head -c 4 cost.png | tail -c 3)" = PNG ] && [ "$(od -An -j 16 -N 4 -t x1 cost.png | tr -d " ")" = 000004b0 ]'

# ---- the reference, and lists ----

claim "the reference is one step beyond the list" bash -c "rc-cost --tol 1e-2,1e-4 --quiet rough.rcg -- $contact | grep -q '^# reference: tol 1e-06, '"
claim "  of counts too, in the direction that costs more" bash -c "
    rc-cost --vary increments=8,16,32 --quiet rough.rcg -- rc-solve --periodic --mean-pressure 1MPa --relaxation 1GPa,2GPa:1s --nu1 0.5 --E2 rigid \
        --time 1s | grep -q '^# reference: increments 64, '"
claim "  of words the first one" bash -c "rc-cost --vary kernel=fft64,fft --quiet rough.rcg -- $contact | grep -q '^# reference: kernel fft64, '"
claim "the same value twice has the error 0" bash -c "
    rc-cost --vary kernel=fft64,fft64 --quiet rough.rcg -- $contact | awk '\$1 == \"fft64\" { n++; if (\$8 != \"0.00e+00\") exit 1 } END { exit n != 2 }'"
claim "an option that the command has is replaced" bash -c "
    rc-cost --tol 1e-3 --error 1e-2 --quiet rough.rcg -- $contact --tol 0.1 | grep -qx 'rc-solve --periodic --mean-pressure 2GPa --estar 114GPa --tol 1e-3 --threads 1 rough.rcg'"
claim "the last change bounds the reference: the bound of every trial is at least its error" bash -c '
    paste <(awk "!/^#/ { print \$8, \$9 }" cost.txt) | awk "NR > 1 && \$2 < \$1 { exit 1 }"'

# ---- the command ----

rc-cost --error 1e-3 -o command rough.rcg -- $contact
rc-pick --crop 0,0,16,14 -o tiny.rcg rough.rcg # where only words matter
proposed() {
    [ "$(wc -l <command)" = 1 ] && cat command >&2 &&
        sh -c "$(cat command) --output pressure" >ran.rcg &&
        $contact --tol 1e-10 --output pressure --quiet -o near.rcg rough.rcg &&
        off ran.rcg near.rcg $nodes >distance && awk '{ exit !($1 <= 1e-3) }' distance
}
claim "the command for 1e-3 gives a result within 1e-3 of a solution to 1e-10" proposed
claim "a file name with special characters is quoted" bash -c '
    cp tiny.rcg "a b.rcg" && says " .a b.rcg.$" rc-cost --quiet --error 1e-3 "a b.rcg" -- '"$contact"
claim "5% is 0.05" says '^rc-' rc-cost --quiet --error 5% tiny.rcg -- $contact
claim "with --budget the command is the most accurate in time" bash -c "
    rc-cost --tol $nine --budget 20s rough.rcg -- $contact >budget.txt 2>budget.err && grep -Eq 'tol 1e-(9|10|11) ' budget.txt"
claim "  its error is printed without a request" grep -Eq 's, pressure off by at most [0-9.e-]+ % \(its own estimate is' budget.err
rc-synth selfaffine --nx 128 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 1 -o yields.rcg
hard="rc-solve --quiet --periodic --mean-pressure 500MPa --estar 114GPa --hardness 3GPa"
for try in 1 2 3 4 5 6 7 8; do # a program beside this one can make a trial the fastest that is not
    rc-cost --tol 1e-1,1e-2,1e-6 --error 5% yields.rcg -- ${hard/--quiet /} >proposed.txt 2>proposed.err
    ! grep -q -- '--tol 1e-2' proposed.txt || break
done
$hard --tol "$(sed 's/.*--tol \([^ ]*\).*/\1/' proposed.txt)" --report quick.json -o x.rcg yields.rcg
$hard --tol 1e-6 --report tight.json -o x.rcg yields.rcg
near "$(sed -n 's/.*: other figures are off by more than 5 %: yielded_area \([0-9.]*\) %; --of NAME chooses one$/\1/p' proposed.err)" \
    "$(awk -v a="$(field yielded_area quick.json)" -v b="$(field yielded_area tight.json)" 'BEGIN { d = 100 * (a / b - 1); print d < 0 ? -d : d }')" 0.05 \
    "the figure that is off by more than --error is named, with its error (try $try)"
claim "  none where all are within" bash -c "rc-cost --tol 1e-2,1e-4 --error 30% yields.rcg -- ${hard/--quiet /} 2>said && ! grep -q 'other figures' said"
claim "  nor the one that was chosen" bash -c "rc-cost --tol 1e-1,1e-2,1e-4 --error 30% --of yielded_area yields.rcg -- ${hard/--quiet /} 2>said && ! grep -q 'other figures' said"
refuses 1 'no trial was fast enough: the best was .* s, error at most .*; raise --budget' "a budget that nothing meets, saying what was the quickest" \
    "rc-cost --budget 1us tiny.rcg -- $contact"
refuses 1 'no trial was accurate enough: the best was .*; raise --error' "an error below what was measured" "rc-cost --error 1e-15 tiny.rcg -- $contact"

# ---- what is refused ----

refused() {
    refuses 2 "$1" "refused: $2" "rc-cost $2"
}
refused '--error does not work with --budget' "--budget 1s --error 1e-3 rough.rcg -- $contact"
refused 'a command is missing' "rough.rcg"
refused 'the command follows after --, as in rc-cost FILE -- rc-solve' "rough.rcg $contact"
refused "'sh' is not a program of this family: no shell runs it" "rough.rcg -- sh -c true"
refused "'/bin/rc-solve' is not a program" "rough.rcg -- /bin/rc-solve"
refused "'rc-nosuch' is not a program of this family: it cannot be run" "rough.rcg -- rc-nosuch"
refused "'rc-slove' is not a program of this family: it cannot be run.*: did you mean rc-solve?" "rough.rcg -- rc-slove --load 1N"
claim "no other program is offered for a name that is near none" bash -c \
    '! rc-cost rough.rcg -- rc-nosuch 2>said.txt && ! grep "did you mean" said.txt'
refused "'rc-cost' is not a program" "rough.rcg -- rc-cost rough.rcg"
refused 'leave out -o of rc-solve: give it to rc-cost' "rough.rcg -- $contact -o x"
refused 'leave out --report of rc-solve: it writes a file' "rough.rcg -- $contact --report x"
refused 'leave out --checkpoint of rc-solve: it writes a file' "rough.rcg -- $contact --checkpoint x"
refused 'shell characters >: no shell' "rough.rcg -- $contact '>' x"
refused 'shell character ;: no shell' "rough.rcg -- '$contact; touch x'"
refused 'shell character \$: no shell' "rough.rcg -- 'rc-solve --load \$(id) --estar 1GPa'"
refused 'lacks a closing "' "rough.rcg -- 'rc-solve --load \"1N | rc-leak'"
refused 'leave out rough.rcg' "rough.rcg -- $contact rough.rcg"
refused 'rc-solve has no option --lod' "rough.rcg -- rc-solve --lod 1N"
refused 'a program is missing' "rough.rcg -- $contact '|'"
refused 'rc-render has no --report' "rough.rcg -- $contact '|' rc-render"
refused 'the command has no option --nix' "--vary nix=1,2 rough.rcg -- $contact"
refused 'write 2.tol for rc-slip' "--vary tol=1e-2,1e-3 rough.rcg -- $contact '|' rc-slip --mu 0.3"
refused 'the command has 1 program' "--vary 2.tol=1e-2,1e-3 rough.rcg -- $contact"
refused '--threads cannot be varied' "--vary threads=1,2 rough.rcg -- $contact"
refused 'give the elasticity' "rough.rcg -- rc-solve --load 1N"
refused 'did you mean pressure' "--of pressur --quiet tiny.rcg -- $contact"
refused 'whole numbers k' "--grid 1.5 rough.rcg -- $contact"
refused 'tolerances above 0' "--tol 1e-2,0 rough.rcg -- $contact"
claim "nothing was written" test ! -e x
claim "a command in one word is split as a shell would" bash -c "
    rc-cost --tol 1e-2 --quiet tiny.rcg -- \"rc-detrend '--plane' | rc-solve --periodic --load \\\"1mN\\\" --estar 1GPa\" | grep -q '^# reference: rc-detrend --plane'"

# ---- limits, failures and signals ----

claim "a value that fails is a row with its reason" bash -c "
    rc-cost --vary 'kernel=fft;direct;fast' --quiet tiny.rcg -- rc-solve --load 1mN --estar 1GPa >rows.txt && grep -q '^# kernel fast: left out: .*must be one of' rows.txt &&
    grep -q '^direct ' rows.txt"
claim "trials above --limit are omitted and named" bash -c '
    rc-synth sphere --nx 800 --dx 1um --radius 7.5mm |
        rc-cost --vary kernel=fft,direct --limit 3s --quiet -- rc-solve --load 500N --estar 114GPa >short.txt &&
    grep -q "^# kernel direct: left out: it would take about .* left of --limit" short.txt'
claim "--dry-run prints the expected time and runs no trial" bash -c '
    rc-cost --dry-run --plot dry.png ball.rcg -- rc-solve --load 20N --estar 114GPa >dry.txt &&
    grep -q "^20 trials on 96 x 96 nodes, about .* s for rc-solve after the reference" dry.txt && [ ! -e dry.png ]'
# large enough for plain sums to take long on any machine
rc-synth sphere --nx 300 --dx 5um --radius 20mm -o large.rcg
study="rc-cost --progress line --limit 5min --vary kernel=fft,direct large.rcg -- rc-solve --load 2kN --estar 114GPa --tol 1e-9"
# In the background a shell ignores SIGINT, and programs inherit that.
interrupted() {
    local tool status children= late
    mkdir -p scratch
    TMPDIR=$PWD/scratch perl -e '$SIG{$_} = "DEFAULT" for "INT", "TERM"; exec @ARGV' $study >cut.txt 2>told.txt &
    tool=$!
    # it measures in a separate process
    until [ -n "$children" ] && grep -q 'kernel direct' told.txt || ! kill -0 "$tool"; do
        sleep 0.01
        children=$(pgrep -P "$tool" | tr '\n' ' ')
    done
    late=$(perl -MTime::HiRes=time -e '$| = 1; my ($tool, $signal) = @ARGV; my $at = time; kill $signal, $tool;
        while (open(my $s, "<", "/proc/$tool/stat") && <$s> !~ /\) Z/) { select undef, undef, undef, 0.01 } printf "%.3f", time - $at' "$tool" "$1")
    wait "$tool"
    status=$?
    echo "status $status after $late s" >&2
    # shellcheck disable=SC2086
    [ "$status" = "$2" ] && grep -q '^ *fft ' cut.txt && grep -q '^# kernel direct: interrupted' cut.txt && [ -n "${children// /}" ] &&
        ! kill -0 $children && [ -z "$(ls scratch)" ] && awk "BEGIN { exit !($late < 0.5) }"
}
claim "SIGINT ends rc-cost and its trial within half a second, and the table has the finished trials" interrupted INT 130
claim "SIGTERM too" interrupted TERM 143
killed() {
    local tool child="" n
    TMPDIR=$PWD/scratch $study >/dev/null 2>&1 &
    tool=$!
    until child=$(pgrep -P "$tool") || ! kill -0 "$tool"; do sleep 0.05; done
    kill -KILL "$tool"
    wait "$tool" 2>/dev/null
    for n in {1..40}; do kill -0 "$child" 2>/dev/null || break; sleep 0.05; done
    [ -n "$child" ] && ! kill -0 "$child" 2>/dev/null && [ -z "$(ls scratch)" ]
}
claim "a kill of rc-cost ends its trial too, and leaves no file" killed

# ---- the programs ----

of_path() {
    mkdir -p alone && ln -f "$RC_BIN/rc-cost" alone/ 2>/dev/null || cp "$RC_BIN/rc-cost" alone/
    alone/rc-cost --dry-run tiny.rcg -- $contact >path.txt && grep -q '^  grid 1, tol' path.txt || return 1
    ! PATH=/nowhere alone/rc-cost --dry-run tiny.rcg -- $contact 2>none.txt && grep -q 'it cannot be run' none.txt
    printf '#!/bin/sh\necho "rc-solve: no contact today" >&2\nexit 1\n' >alone/rc-solve && chmod +x alone/rc-solve
    ! alone/rc-cost --dry-run tiny.rcg -- $contact 2>own.txt && grep -q 'no contact today' own.txt
}
claim "rc-cost runs the rc-solve of its folder, otherwise that of PATH, and says if there is none" of_path
# Programs that count their runs, without those that only answer questions.
counted() {
    local name
    mkdir -p counting seen && ln -f "$RC_BIN/rc-cost" counting/ 2>/dev/null || cp "$RC_BIN/rc-cost" counting/
    for name in rc-solve rc-slip; do
        printf '#!/bin/sh\ncase " $* " in *" --completions "* | *" --dry-run "*) ;; *) echo "$*" >>"%s/%s" ;; esac\nexec "%s/%s" "$@"\n' \
            "$PWD/seen" $name "$RC_BIN" $name >counting/$name && chmod +x counting/$name
    done
    rc-synth sphere --nx 64 --dx 7um --radius 7.5mm -o few.rcg
    counting/rc-cost --vary 2.tol=1e-1,1e-2 --quiet few.rcg -- rc-solve --load 20N --E1 210GPa --nu1 0.3 --E2 rigid '|' \
        rc-slip --mu 0.3 --tangential 1N >counted.txt || return 1
    # one solution, run up to five times in all for its time; three trials of rc-slip, each up to five times or more if it was disturbed
    [ "$(sort -u seen/rc-solve | grep -vc quiet)" = 1 ] && [ "$(sort -u seen/rc-solve | wc -l)" -le 2 ] && [ "$(wc -l <seen/rc-solve)" -le 9 ] &&
        [ "$(sed 's/ --quiet//' seen/rc-slip | sort -u | wc -l)" = 3 ]
}
claim "a program whose input and words are those of another trial does not run again" counted

# Each run takes 0.7 s or more: besides the reference three fit into 2 s, and a fourth one is stopped.
limited() {
    mkdir -p slowly && ln -f "$RC_BIN/rc-cost" slowly/ 2>/dev/null || cp "$RC_BIN/rc-cost" slowly/
    printf '#!/bin/sh\ncase " $* " in *" --completions "* | *" --dry-run "*) ;; *) echo "$*" >>"%s"; sleep 0.7 ;; esac\nexec "%s/rc-solve" "$@"\n' \
        "$PWD/slow.runs" "$RC_BIN" >slowly/rc-solve && chmod +x slowly/rc-solve
    slowly/rc-cost --limit 2s --vary increments=8,16 --vary slabs=3,5 --quiet tiny.rcg -- \
        rc-solve --periodic --mean-pressure 0.5GPa --E1 210GPa --nu1 0.3 --E2 rigid --yield 2GPa,5GPa >slow.txt || return 1
    wc -l slow.runs >&2
    [ "$(wc -l <slow.runs)" -le 5 ] && grep -q 'left of --limit' slow.txt
}
claim "--limit holds for all trials, also those before the reference and beside it" limited
refuses 1 'no reference: .*stopped after .* \(tol 0.001\): raise --limit, or give lists that end at less accurate values' \
    "a reference that takes too long, with what to do" "slowly/rc-cost --limit 0.3s --tol 1e-1,1e-2 tiny.rcg -- rc-solve --load 1N --estar 1GPa"
rc-cost --tol 1e-8,1e-1,1e-4 --plot line.svg --quiet -o line.txt rough.rcg -- $contact
claim "the line of the picture does not turn back in time" awk '
    /<path d="M.*stroke-width="2.2"/ { gsub(/.*d="M|" fill.*/, ""); n = split($0, point, "L"); lines += n == 4
        for (k = 2; k <= n; k++) bad += point[k] + 0 < point[k - 1] + 0 }
    END { exit bad || lines != 1 }' line.svg
unquoted() { rc-cost --tol 1e-2 --quiet "$@" tiny.rcg -- rc-solve --load 1mN --estar 1GPa | rc-leak -o x.rcg; }
refuses 1 "rc-leak: standard input is the result of rc-cost: if rc-leak is a part of its command, write '.' in quotes before it" "a pipe without quotes" \
    "$(declare -f unquoted); unquoted"
refuses 1 "is the result of rc-cost" "  also of a command that was chosen" "$(declare -f unquoted); unquoted --error 0.5"

# ---- Hertz: radius 7.5 mm, E* 114 GPa, 20 N; a^3 = 3 P R / 4 E*, p0 = 3 P / 2 pi a^2, approach a^2 / R ----

rc-cost --grid 2 --tol 1e-3,1e-5 --of max_pressure --quiet -o hertz.txt ball.rcg -- rc-solve --load 20N --estar 114GPa
figure() {
    sed -n "s/^# reference:.* $1 \([0-9.e+-]*\).*/\1/p" hertz.txt
}
near "$(figure max_pressure)" 9.633992e+08 "$coarse_grid" "the reference's largest pressure is Hertz's"
rc-cost --grid 2 --tol 1e-3 --of approach --quiet -o hertz.txt ball.rcg -- rc-solve --load 20N --estar 114GPa
near "$(figure approach)" 1.321612e-06 "$coarse_grid" "its approach is Hertz's"
# Block means of a paraboloid are the same paraboloid at the coarse nodes, plus a constant.
coarse_sphere() {
    rc-cost --grid 2 --tol 1e-3 --reference tol=1e-12 --quiet ball.rcg -- rc-solve --load 20N --estar 114GPa >half.table &&
        rc-synth sphere --nx 48 --dx 10um --radius 7.5mm |
        rc-solve --load 20N --estar 114GPa --tol 1e-3 --output pressure --quiet -o half.rcg &&
        rc-solve --load 20N --estar 114GPa --tol 1e-12 --output pressure --quiet -o fine.rcg ball.rcg &&
        values half.rcg 2304 >half.txt && values fine.rcg 9216 >fine.txt &&
        awk 'NR == FNR { c[NR - 1] = $1; next }
             { k = FNR - 1; d = c[int(int(k / 96) / 2) * 48 + int(k % 96 / 2)] - $1
               s += d < 0 ? -d : d; t += $1 } END { printf "%.6g\n", s / t }' half.txt fine.txt >coarse.txt
}
claim "the sphere of a coarser grid can be solved separately" coarse_sphere
near "$(column error half.table | head -1)" "$(cat coarse.txt)" "$three_and" \
    "the error of a coarser grid is that of the same sphere on fewer nodes, spread over its cells"
rc-synth sphere --nx 512 --dx 0.9375um --radius 7.5mm -o large.rcg
rc-cost --error 0.2 --quiet -o coarser large.rcg -- rc-solve --load 20N --estar 114GPa
claim "a coarser grid is proposed if the error allows it" \
    grep -Eq '^rc-pick --resample 64x64 large.rcg \| rc-solve --load 20N --estar 114GPa --tol 1e-[0-9] --threads 1$' coarser
claim "  the command runs" bash -c 'sh -c "$(cat coarser) --output pressure --quiet --report coarser.json" >coarser.rcg'
near "$(field nx coarser.json)" 64 "$same" "  on that grid"
near "$(field max_pressure coarser.json)" 9.633992e+08 "$coarse_grid" "  with Hertz's largest pressure"
