# SPDX-License-Identifier: GPL-3.0-or-later
# --report FILE.tsv writes a table with the names and units of the columns in its first line, and a row for
# each case. Its cells have the scalars of the JSON lines that --report FILE writes for the same run.
# --report - writes only these lines to standard output; the stream goes to the file of -o, and a file named
# `-` is never made.
. "$(dirname "$0")/../pipe.sh"

# ---- --report FILE.tsv ----

# same_cells TABLE LINES [NAME...]: the columns are the scalars of the JSON lines in the order of the first
# line, and every cell has the text of its line. null, and keys that only other lines have, are NaN. Named
# columns change from run to run: they must only be filled.
same_cells() {
    perl -MJSON::PP -e '
        my ($table, $lines, @changing) = @ARGV;
        open my $t, "<", $table or die; open my $l, "<", $lines or die;
        sub row { my $line = <$t> // die "a row is missing\n"; chomp $line; split /\t/, $line, -1 }
        my ($rows, %scalar, @head) = 0;
        for my $name (row()) { push @head, $name =~ s!/.*!!r }
        while (my $line = <$l>) {
            my ($object, @cell) = (decode_json($line), row());
            my $last = 0;
            @cell == @head or die "@{[scalar @cell]} cells under @{[scalar @head]} names\n";
            for my $k (0 .. $#head) {
                my ($name, $cell) = ($head[$k], $cell[$k]);
                my $here = index $line, "\"$name\": ";
                my @said = $cell eq "NaN" ? "null" : ($cell, "\"$cell\"");
                if ($name eq "seconds" && ref $object->{seconds}) { # the total of the object
                    $cell > 0 && $object->{seconds}{total} > 0 or die "seconds: $cell\n";
                    next;
                } elsif ($name =~ /^(max|min)_([a-z]+?)(_depth)?$/ && $object->{max}) { # in the objects of the line
                    my $there = $object->{$1}{$2}{$3 ? "depth" : "value"};
                    abs($cell - $there) <= 1e-14 * abs $there or die "$name: $cell, not $there\n";
                    next;
                } elsif (!exists $object->{$name}) {
                    $cell eq "NaN" or die "$name: $cell, not in the line\n";
                } elsif (grep { $_ eq $name } @changing) {
                    $cell ne "" or die "$name: nothing\n";
                } else {
                    grep { $line =~ /"\Q$name\E": \Q$_\E[,\}]/ and $here = $-[0] } @said or die "$name: $cell, not in $line";
                }
                next if $rows > 0 || !exists $object->{$name};
                $last < $here or die "$name: out of order\n";
                $last = $here;
            }
            for my $name (keys %$object) {
                next if $name eq "seconds";
                my $inside = ref $object->{$name} && !JSON::PP::is_bool($object->{$name});
                $inside == grep({ $_ eq $name } @head) and die "$name: a column, or none\n";
            }
            $rows++;
        }
        defined <$t> and die "rows that no line has\n";
        $rows > 0 or die "no rows\n";' "$@"
}

# cells NAME TABLE: prints the cells of this column, one per line.
cells() {
    awk -F '\t' -v name="$1" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == name) c = k; next } { print $c }' "$2"
}

rc-synth selfaffine --nx 47 --ny 33 --dx 1.1um --dy 1.29um --hurst 0.8 --rms-slope 0.1 --seed 5 -o rough.rcg

# ---- rc-solve ----

press="rc-solve --quiet --estar 114GPa --radius 2.385mm --hardness 6GPa --threads 1 --output pressure"
claim "rc-solve writes a table for a list of loads" $press --load 0.1:0.5:5 --report loads.tsv -o pressed.rcg rough.rcg
claim "rc-solve writes lines of JSON for the same run" $press --load 0.1:0.5:5 --report loads.json -o again.rcg rough.rcg
claim "the table has a row for each load, and the names" test "$(wc -l <loads.tsv)" = 6
claim "rc-solve: the cells are the scalars of the JSON lines" same_cells loads.tsv loads.json peak_memory memory_estimate
rc-pick --set 'source=a, "b".x3p' rough.rcg | $press --load 0.1:0.5:5 --report loads.csv -o again.rcg
claim "FILE.csv is the same table with commas" perl -MText::ParseWords -e '
    open my $t, "<", "loads.tsv" or die; open my $c, "<", "loads.csv" or die;
    while (my $line = <$t>) {
        my $other = <$c>; chomp($line, $other);
        my @tabs = split /\t/, $line, -1; my @commas = parse_line(",", 1, $other);
        die "@commas" if @tabs != @commas;
        for my $k (0 .. $#tabs) { $names[$k] = $tabs[$k] if $. == 1;
            die "$names[$k]: $tabs[$k], $commas[$k]" if $tabs[$k] ne $commas[$k] && $names[$k] !~ /^(source|file|seconds|.*memory|.*seconds)/ } }'
claim "  a cell with commas and quotes is written in quotes" says '^1,"a, ""b"".x3p",47,33,' cat loads.csv
for ending in tsv csv; do
    rc-render --curve load:contact_area --title x --font 9 -o $ending.svg loads.$ending
done
claim "  rc-render --curve reads it" diff <(sed 's/loads\.[tc]sv/loads/g' tsv.svg) <(sed 's/loads\.[tc]sv/loads/g' csv.svg)
printf 'v/m,of\n1,"a ""b"", c"\n2,d\n3,"a ""b"", c"\n' >words.csv
claim "  quoted words too" bash -c 'rc-render --curve v:v --by of -o words.svg words.csv && says "a &quot;b&quot;, c|a \"b\", c" cat words.svg'
k=0
for load in $(cells load/N loads.tsv); do
    k=$((k + 1))
    near "$load" "0.$k" "$summed" "row $k is load $k"
done
for column in load/N mean_pressure/Pa max_pressure/Pa contact_area/m2 approach/m stiffness/N/m dx/m peak_memory/B; do
    claim "  $column has its unit" bash -c "head -n 1 loads.tsv | tr '\t' '\n' | grep -qx '$column'"
done
claim "  a plain number has no unit" bash -c "head -n 1 loads.tsv | tr '\t' '\n' | grep -qx contact_nodes"
claim "the suffix may be in capitals" $press --load 0.5 --report one.TSV -o one.rcg rough.rcg
claim "  one load gives one row" test "$(wc -l <one.TSV)" = 2
claim "  an unknown value is NaN" test "$(cells stiffness/N/m one.TSV)" = NaN
claim "an estimate that is an object has no column" bash -c "
    $press --load 0.3,0.5 --discretization --report coarse.tsv -o /dev/null rough.rcg && lacks discretization coarse.tsv"
claim "with any other suffix the report is JSON" bash -c "$press --load 0.5 --report tsv -o /dev/null rough.rcg && grep -q '^{' tsv"

# A file name with characters that would break lines and cells.
rc-synth sphere --nx 9 --dx 5um --radius 7.5mm -o ball.rcg
sed $'/^source=/d; s/^nx=/source=a\tb\\\\nc "d"\\\nnx=/' ball.rcg | reseal >named.rcg
claim "a source name with a tab and a line feed is accepted" \
    rc-solve --load 1 --estar 114GPa --quiet --report named.tsv -o /dev/null named.rcg
claim "  it is one cell" test "$(cells source named.tsv)" = 'a b c "d"'
claim "  the table has two lines" test "$(wc -l <named.tsv)" = 2

# ---- rc-stress ----

strain="rc-stress --nu 0.3 --depths 1um,5um --components szz,mises --threads 1 --quiet"
claim "rc-stress writes a table" $strain --report stress.tsv -o /dev/null pressed.rcg
claim "rc-stress writes lines of JSON" $strain --report stress.json -o /dev/null pressed.rcg
claim "rc-stress: the cells are the scalars of the JSON lines" same_cells stress.tsv stress.json peak_memory memory_estimate
claim "  each case has a row" test "$(wc -l <stress.tsv)" = 6

# ---- rc-cost ----

try="rc-cost --tol 1e-2,1e-4 --grid 2,1 --threads 1 --quiet"
what="ball.rcg -- rc-solve --load 0.5 --estar 114GPa"
claim "rc-cost writes a table" bash -c "$try --report cost.tsv $what"
claim "rc-cost writes lines of JSON" bash -c "$try --report cost.json $what"
claim "rc-cost: the cells are the scalars of the JSON lines" \
    same_cells cost.tsv cost.json expected_seconds seconds processor_seconds runs memory front command

# ---- a report that cannot be written ----

refuses 1 'report full: this is a folder' "a folder, before the work" \
    "mkdir full && $press --load 0.5 --report full -o never.rcg rough.rcg"
refuses 1 'report /dev/full: writing failed' "a full disk" \
    "$press --load 0.5 --report /dev/full -o never.rcg rough.rcg"
claim "  no other file is left" test ! -e never.rcg

# ---- --report - ----

rc-synth sphere --nx 33 --dx 5um --radius 7.5mm -o ball.rcg
press="rc-solve --load 1N,2N --estar 114GPa --quiet ball.rcg"

# only_lines N: standard input has exactly N lines, all of them JSON objects.
only_lines() {
    tee lines.txt | awk -v n="$1" '!/^\{"(case|source)": .*\}$/ { bad = 1 } END { exit bad || NR != n }'
}
export -f only_lines

claim "rc-solve writes two lines and no stream" bash -c "$press --report - | only_lines 2"
claim "  -o - is standard output too" bash -c "$press --report - -o - | only_lines 2"
claim "rc-solve: -o gets the stream" bash -c "$press --report - -o pressed.rcg | only_lines 2"
$press -o plain.rcg
claim "  it is the usual stream" cmp pressed.rcg plain.rcg
claim "rc-stress writes lines and no stream" bash -c "rc-stress --nu 0.3 --depths 5um --report - plain.rcg | only_lines 2"
claim "rc-stress: -o gets the stream" \
    bash -c "rc-stress --nu 0.3 --depths 5um --report - -o stress.rcg plain.rcg | only_lines 2"
rc-stress --nu 0.3 --depths 5um -o plain-stress.rcg plain.rcg
claim "  it is the usual stream" cmp stress.rcg plain-stress.rcg
what="ball.rcg -- rc-solve --load 1 --estar 114GPa"
claim "rc-cost writes lines and no table" bash -c "rc-cost --tol 1e-2,1e-4 --quiet --report - $what | only_lines 3"
claim "rc-cost: -o gets the table" bash -c "rc-cost --tol 1e-2,1e-4 --quiet --report - -o table.txt $what >cost.json && grep -q front table.txt"
claim "  it does not get the lines" bash -c "[ -s cost.json ] && lacks '^\{' table.txt"
claim "--dry-run prints its plan as a row" bash -c "$press --report - --dry-run | only_lines 1"
refuses 1 'report -: writing failed' "a full disk is told" "$press --report - >/dev/full"
claim "no file has the name -" test ! -e ./-
