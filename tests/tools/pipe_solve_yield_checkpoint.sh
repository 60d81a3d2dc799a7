# SPDX-License-Identifier: GPL-3.0-or-later
# rc-solve --yield with --checkpoint and --resume. A history of a yielding body that is interrupted at any
# point continues with the result of an uninterrupted one.
. "$(dirname "$0")/../pipe.sh"

rc-synth selfaffine --nx 48 --dx 1um --hurst 0.8 --rms-height 0.15um --rolloff 24um --short-cut 10um --seed 4 -o rough.rcg
solve="rc-solve --quiet --periodic --E1 210GPa --nu1 0.3 --E2 rigid --output pressure,residual,strain"
# All figures of every row except the cost.
figures='mean_pressure|contact_area|max_pressure|indentation|residual_indentation|plastic_volume|max_plastic_strain|plastic_work|plastic_depth|increments|applications|slabs'
# figures_of FILE.tsv: prints a line "name value" for each figure.
figures_of() {
    awk -F '\t' -v want="^($figures)(/|\$)" 'NR == 1 { for (i = 1; i <= NF; i++) { name[i] = $i; is[i] = $i ~ want } }
        NR > 1 { for (i = 1; i <= NF; i++) if (is[i]) print name[i], $i }' "$1"
}
# apart A B: prints the largest relative difference of their figures.
apart() {
    paste <(figures_of "$1") <(figures_of "$2") | awk '
        { n++; d = $2 - $4; s = $2; d = d < 0 ? -d : d; s = s < 0 ? -s : s; if ($1 != $3) exit 1; if (d > 0) d /= s; if (d > m) m = d }
        END { if (n < 24) exit 1; printf "%.3g\n", m + 0 }'
}
# A state has a frame for each of its maps; the last one has the numbers. ends FILE: prints where states end.
ends() {
    perl -0777 -ne 'while (/^checkpoint.numbers=.*?RCGEND 1\n/gms) { print pos, "\n" }' "$1"
}
states() { grep -ac '^checkpoint.numbers=' "$1"; }

# ---- a history ----

history="--mean-pressure 150MPa,0,200MPa --yield 2GPa,10GPa"
$solve $history --report plain.tsv -o plain.rcg rough.rcg
$solve $history --checkpoint kept.rcg --interval 0 --report whole.tsv -o whole.rcg rough.rcg
claim "a checkpoint does not change the result" cmp plain.rcg whole.rcg
for row in 1:150 3:200; do
    near "$(figures_of whole.tsv | awk -v k="${row%:*}" '$1 ~ /^mean_pressure/ && ++n == k { print $2 }')" "${row#*:}e6" "$summed" \
        "  load ${row%:*} is carried"
done
near "$(total pressure plain.rcg 1)" 0.3456 "$summed" "  by its pressures, 150 MPa on 48 um by 48 um"
claim "  and each load has its frames" test "$(channels plain.rcg | sed 's/\( exx eyy exy exz eyz peeq\)*//g')" = \
    "pressure residual pressure residual pressure residual"
claim "  of the strain in each slab" test $(($(channels plain.rcg | tr ' ' '\n' | grep -c peeq) % 3)) = 0
claim "it has states of each load" test "$(states kept.rcg)" -gt 20
claim "a resumed run gives the same bits" bash -c "
    cp kept.rcg again.rcg && $solve $history --checkpoint again.rcg --resume --report again.tsv -o again-out.rcg rough.rcg &&
    cmp whole.rcg again-out.rcg && cmp kept.rcg again.rcg"
near "$(apart whole.tsv again.tsv)" 0 "$same" "  and so are its figures, the applications that it took included"

# The run is killed anywhere, that is, after each frame and with a part of the next. The contacts are solved
# to 1e-4, and a contact that continues from a saved pressure has another first step. Therefore later results
# agree within this tolerance.
cut_off() {
    local end last=0 n=0
    for end in $(ends kept.rcg); do
        head -c $(((last + 2 * end) / 3)) kept.rcg >cut.rcg # a third of the last state is missing
        last=$end
        n=$((n + 1))
        [ $((n % 4)) = 0 ] || continue
        $solve $history --checkpoint cut.rcg --resume --report cut.tsv -o cut-out.rcg rough.rcg || return 1
        apart whole.tsv cut.tsv || return 1
    done >apart.txt
    [ "$n" -gt 25 ] && sort -g apart.txt | tail -n 1 >worst.txt
}
claim "a checkpoint truncated in any frame can be resumed" cut_off
between 0 "$(cat worst.txt)" 1e-4 "  to the same figures, within the tolerance of the contacts"
head -c "$(ends kept.rcg | tail -n 3 | head -n 1)" kept.rcg >late.rcg
before=$(states late.rcg)
$solve $history --checkpoint late.rcg --resume --interval 0 -o late-out.rcg rough.rcg
between 1 "$(($(states late.rcg) - before))" 4 "  and only what is missing is done again"

# ---- too few increments: the second attempt is resumed, not the first ----

harder="--mean-pressure 700MPa --yield 2GPa"
$solve $harder --checkpoint try.rcg --interval 0 --report try.tsv -o try-out.rcg rough.rcg
claim "a load may need more increments than those of its first attempt" test $? = 0
$solve $harder --checkpoint try.rcg --resume --report try2.tsv -o try2-out.rcg rough.rcg
claim "  and so does its resumed run" test $? = 0
claim "with more applications than one attempt" test "$(figures_of try.tsv | awk '$1 == "applications" { print $2 }')" -gt "$(figures_of try.tsv | awk '$1 == "increments" { print 5 * $2 }')"
claim "  a resumed run gives the same result" cmp try-out.rcg try2-out.rcg
head -c "$(ends try.rcg | tail -n 5 | head -n 1)" try.rcg >part.rcg
$solve $harder --checkpoint part.rcg --resume --report part.tsv -o part-out.rcg rough.rcg
near "$(figures_of part.tsv | awk '$1 == "increments" { print $2 }')" "$(figures_of try.tsv | awk '$1 == "increments" { print $2 }')" 0 \
    "  and cut off in it it goes on with as many"
near "$(figures_of part.tsv | awk '$1 ~ /^plastic_work/ { print $2 }')" "$(figures_of try.tsv | awk '$1 ~ /^plastic_work/ { print $2 }')" 1e-4 \
    "  to the same work"

# ---- a signal ----

# interrupted: ends a run by a signal while increments are computed. On a busy machine the run may be over before
# the signal reaches it; then the next attempt begins.
interrupted() {
    local attempt status
    for attempt in 1 2 3 4 5 6; do
        rm -f signal.rcg signal-out.rcg
        ${solve/--quiet/} $history --increments 200 --checkpoint signal.rcg --interval 0.01 --report signal.tsv -o signal-out.rcg rough.rcg 2>signal.err &
        # the first states are those of the elastic solution
        until [ "$(states signal.rcg 2>/dev/null)" -ge 6 ] 2>/dev/null || ! kill -0 $! 2>/dev/null; do sleep 0.02; done
        kill -TERM $! 2>/dev/null
        wait $!
        status=$?
        [ $status = 0 ] || break
    done
    [ $status = 143 ] && rc-info --quiet signal.rcg >/dev/null
}
claim "after a signal the checkpoint has a state" interrupted
claim "  a warning says that the frames hold an intermediate state" grep -Eq 'interrupted in increment [0-9]+ of 200: the frames hold an intermediate state, not a solution, and its error is unknown$' signal.err
claim "--resume continues from it" bash -c "
    $solve $history --increments 200 --checkpoint signal.rcg --resume --report on.tsv -o on.rcg rough.rcg &&
    $solve $history --increments 200 --report straight.tsv -o straight.rcg rough.rcg"
# two hundred further contacts, each with a mean error of 1e-4 over the map: a single node may have several
# times that
between 0 "$(apart straight.tsv on.tsv)" 1e-3 "  to the same figures"

# ---- another problem ----

other() { # WHAT PATTERN OPTIONS: the resumed run is refused
    cp kept.rcg other.rcg
    refuses 1 "another problem: $2" "that of $1" "$3 --checkpoint other.rcg --resume -o x.rcg rough.rcg"
}
loads="--mean-pressure 150MPa,0,200MPa"
other "another yield stress" '--yield was 2GPa,10GPa, is 3GPa,10GPa$' "$solve $loads --yield 3GPa,10GPa"
other "another hardening" '--yield was .*, is t.tsv$' "printf '0 2GPa\n1 12GPa\n' >t.tsv; $solve $loads --yield t.tsv"
other "no yield" '--yield was .*, is not given$' "${solve/,residual,strain/} $loads --history"
other "other slabs" '--slabs was not given, is 6$' "$solve $history --slabs 6"
other "a list of slabs" '--slabs was not given, is 1um,2um$' "$solve $history --slabs 1um,2um"
other "other increments" '--increments was not given, is 9$' "$solve $history --increments 9"
other "another tolerance" '--tol was not given, is 0.05$' "$solve $history --tol 0.05"
other "another body of the same E*" '--nu1 was 0.3, is -0.3$' \
    "rc-solve --quiet --periodic --E1 210GPa --nu1 -0.3 --E2 rigid $loads --yield 2GPa,10GPa"
other "other loads before" 'load was 0.4608, is 0.41472$' "$solve --mean-pressure 150MPa,0,180MPa --yield 2GPa,10GPa"
${solve/,residual,strain/} --mean-pressure 150MPa --checkpoint elastic.rcg -o x.rcg rough.rcg && rm x.rcg
refuses 1 '--yield was not given, is 2GPa,10GPa' "that of elastic bodies" \
    "$solve --mean-pressure 150MPa --yield 2GPa,10GPa --checkpoint elastic.rcg --resume -o x.rcg rough.rcg"

# ---- spoilt ----

# lie PLACE VALUE FILE: changes a number of the last state and corrects the checksum. layout, slabs: in the
# header; voxels: how many the first row of the first slab has; last: a number of the last map.
lie() {
    perl -MCompress::Zlib -0777 -e '
        my ($place, $value) = splice @ARGV, 0, 2;
        my @s = <> =~ /(RCG1\n.*?RCGEND 1\n)/gs;
        my @n = split / /, $1 if $s[-1] =~ /^checkpoint.numbers=(.*)$/m;
        # two counts, the head of the model, two points, and the state at the last load, whose length comes before it
        my %at = (slabs => 41 + $n[35], layout => 37 + $n[35]);
        # the last number counts the maps of voxels, which are the last ones
        my $frame = $place eq "voxels" ? @s - $n[-1] : $#s;
        my ($head, $body) = $s[$frame] =~ /^(RCG1\n.*?\n\n)(.*)crc32 .{8}\nRCGEND 1\n$/s;
        if (exists $at{$place}) {
            $n[$at{$place}] = $value;
            $head =~ s/^checkpoint.numbers=.*$/checkpoint.numbers=@n/m;
        } else {
            substr($body, 0, 8) = pack("d<", $value);
        }
        $s[$frame] = $head . $body . sprintf("crc32 %08x\n", crc32($head . $body)) . "RCGEND 1\n";
        print @s;' -- "$1" "$2" "$3" >lies.rcg
}
lie layout 8 kept.rcg # earlier states begin with a number of increments
refuses 1 'case 3 cannot be continued \(.*another version of the program wrote it\): remove the file to start again' \
    "a state of an earlier version" "$solve $history --checkpoint lies.rcg --resume -o x.rcg rough.rcg"
lie slabs 2 kept.rcg
refuses 1 'case 3 cannot be continued \(.*a size is out of range' "a state of other slabs" \
    "$solve $history --checkpoint lies.rcg --resume -o x.rcg rough.rcg"
lie last nan kept.rcg
refuses 1 'case 3 cannot be continued \(.*it holds NaN' "one that is not finite" \
    "$solve $history --checkpoint lies.rcg --resume -o x.rcg rough.rcg"
lie voxels 1e9 kept.rcg
refuses 1 'case 3 cannot be continued \(.*a size is out of range' "one with more voxels than nodes" \
    "$solve $history --checkpoint lies.rcg --resume -o x.rcg rough.rcg"
head -c "$(ends kept.rcg | head -n 10 | tail -n 1)" kept.rcg >begun.rcg # in the first load
lie slabs 1e300 begun.rcg
refuses 1 'case 1 cannot be continued \(.*a size is out of range' "one without slabs" \
    "$solve $history --checkpoint lies.rcg --resume -o x.rcg rough.rcg"
lie slabs 2 begun.rcg
refuses 1 'case 1 cannot be continued \(.*not a state' "one with fewer" \
    "$solve $history --checkpoint lies.rcg --resume -o x.rcg rough.rcg"
(head -c -2000 kept.rcg && printf X && tail -c 1999 kept.rcg) >spoilt.rcg
refuses 1 'frame [0-9]* cannot be read .*checksum' "a file whose last state is damaged" "$solve $history --checkpoint spoilt.rcg --resume -o x.rcg rough.rcg"
claim "refused runs leave no file" bash -c '! ls x.rcg* 2>/dev/null'
