# SPDX-License-Identifier: GPL-3.0-or-later
# Scripts read reports by their headings and keys, which headings.txt records. For each command it has the
# first line of its table. Below are all keys of its JSON lines in alphabetical order, an outer key before the
# inner ones. Add a new column at the end of its list; no column changes its name, unit or position.
. "$(dirname "$0")/../pipe.sh"

# keys FILE.json: prints the keys "a", "a.b", ... of all objects of the lines, each once.
keys() {
    perl -MJSON::PP -ne '
        sub walk { my ($at, $v) = @_;
            if (ref $v eq "HASH") { for (sort keys %$v) { my $k = $at eq "" ? $_ : "$at.$_"; $seen{$k}++ or push @all, $k; walk($k, $v->{$_}) } }
            elsif (ref $v eq "ARRAY") { walk("$at\[]", $_) for @$v } }
        walk("", decode_json($_));
        END { print "$_\n" for sort @all }' "$1"
}

# lines: breaks words into lines.
lines() { tr '\t\n' '  ' | sed 's/ $//' | fold -s -w 110 | sed 's/ $//'; echo; }
# recorded NAME: prints its part of headings.txt.
recorded() {
    awk -v head="== $1" '/^== / { on = $0 == head; next } on' "$RC_SOURCE/tests/tools/headings.txt"
}
# report NAME 'command with --report $r': its table and its keys equal the recorded ones.
report() {
    claim "$1 writes a table and lines of JSON" bash -c "r=table.tsv; $2 && r=lines.json && $2"
    head -n 1 table.tsv | lines >table.txt
    claim "  no column has a blank in its name or unit" test -z "$(head -n 1 table.tsv | grep ' ')"
    keys lines.json | lines >keys.txt
    claim "  the table has the listed columns" diff <(recorded "$1: table") table.txt
    claim "  the lines have the listed keys" diff <(recorded "$1: keys") keys.txt
    tr ' ' '\n' <keys.txt >>"${1%%[ ,]*}.keys"
    if [ -n "${RC_RECORD-}" ]; then # a file that becomes headings.txt
        { echo "== $1: table"; cat table.txt; echo "== $1: keys"; cat keys.txt; } >>"$RC_RECORD"
    fi
    rm -f table.tsv lines.json
}

rc-synth selfaffine --nx 24 --dx 1um --hurst 0.8 --rms-slope 0.1 --seed 2 -o rough.rcg
rc-synth sphere --nx 32 --dx 20nm --radius 10um -o ball.rcg
body='--E1 91GPa --nu1 0.3 --E2 rigid --threads 1 --quiet'
report rc-solve "rc-solve $body --load 1mN,2mN --hardness 8GPa --history --conductivity 45W/mK,16W/mK --report \$r -o p.rcg rough.rcg"
report "rc-solve --periodic=y" "rc-solve $body --periodic=y --load 1N/m --report \$r -o line.rcg rough.rcg"
report "rc-solve, one load" "rc-solve $body --load 1mN --discretization --report \$r -o one.rcg rough.rcg"
report "rc-solve --yield" "rc-solve $body --yield 1GPa --slabs 6 --increments 8 --load 200uN --report \$r -o y.rcg ball.rcg"
report "rc-solve --adhesion" "rc-solve $body --adhesion 50mJ/m2 --approach 0 --report \$r -o a.rcg ball.rcg"
report "rc-solve --travel" "rc-solve $body --load 200uN --travel 0 --counter ball.rcg --report \$r -o t.rcg ball.rcg"
report "rc-solve --relaxation" "rc-solve --relaxation 1GPa,9GPa:1ms --nu1 0.49 --E2 rigid --threads 1 --quiet --load 20uN --time 0 --report \$r -o v.rcg ball.rcg"
report "rc-solve --speed" "rc-solve --relaxation 1MPa,9MPa:1ms --nu1 0.5 --E2 rigid --periodic --mean-pressure 0.1MPa --speed 1mm/s \
    --threads 1 --quiet --report \$r -o s.rcg rough.rcg"
report rc-slip "rc-slip --mu 0.3 --threads 1 --quiet --tangential 0.1mN --report \$r -o q.rcg one.rcg"
report "rc-slip --periodic=y" "rc-slip --mu 0.3 --threads 1 --quiet --tangential 1uN --report \$r -o q.rcg line.rcg"
rc-solve $body --load 2uN -o rolls.rcg ball.rcg
report "rc-slip --steady" "rc-slip --mu 0.3 --threads 1 --quiet --creep 1e-3,0 --steady --report \$r -o q.rcg rolls.rcg"
report rc-wear "rc-wear --coefficient 1e-6mm3/Nm --distance 1m --threads 1 --quiet --report \$r -o w.rcg one.rcg"
report "rc-wear --periodic=y" "rc-wear --coefficient 1e-6mm3/Nm --distance 1m --threads 1 --quiet --report \$r -o w.rcg line.rcg"
report rc-heat "rc-heat --mu 0.3 --speed 1 --conductivity 45,45 --diffusivity 1e-5,1e-5 --threads 1 --quiet --report \$r -o h.rcg one.rcg"
rc-slip --mu 0.3 --threads 1 --quiet --creep 1e-3,0 --steady --output pressure,dissipation -o d.rcg rolls.rcg
report "rc-heat --rolling" "rc-heat --rolling 1 --conductivity 45,45 --diffusivity 1e-5,1e-5 --threads 1 --quiet --report \$r -o h.rcg d.rcg"
report rc-stress "rc-stress --depths 0,1um --threads 1 --quiet --report \$r -o s.rcg one.rcg"
report rc-fatigue "rc-fatigue --bending-limit 6MPa --torsion-limit 4MPa --pass x --depths 1um,2um --threads 1 --quiet --report \$r -o s.rcg one.rcg"
report rc-leak "rc-leak --viscosity 1mPas --pressure-drop 1kPa --threads 1 --quiet --report \$r -o f.rcg one.rcg"
report rc-deflect "rc-deflect --threads 1 --quiet --report \$r -o d.rcg p.rcg"
report rc-info "rc-info --areal --psd --profile rows --report \$r rough.rcg"
report "rc-info --patches" "rc-info --areal --patches --report \$r one.rcg"
report rc-cost "rc-cost --grid 2,1 --tol 1e-1,1e-3 --threads 1 --quiet --report \$r rough.rcg -- rc-solve --load 1mN --estar 100GPa"

# The list in a page has every column, and otherwise only those of several processes.
page_words() { # PAGE SECTION PATTERN: prints the words of matching lines; those of rc-solve include the pages of its effects
    local page pages=("$RC_SOURCE/man/$1.1")
    [ "$1" = rc-solve ] && for page in "$RC_SOURCE"/man/contact-*.7; do
        grep -q '^\.Sh OPTIONS' "$page" && pages+=("$page")
    done
    awk -v section="$2" -v pattern="$3" '
        /^\.S[hs] / { on = substr($0, 5) == section }
        on && $0 ~ pattern { for (k = 2; k <= NF; k++) if ($k ~ /^[a-z][a-z0-9_]*$/) print $k }' "${pages[@]}"
}
shared='ranks exchanges messages bytes_exchanged other_bytes exchange_seconds'
listed() { # PAGE SECTION
    claim "$1(1): its list has every column" test -z \
        "$(grep -v '\.' "$1.keys" | sort -u | comm -23 - <(page_words "$1" "$2" '^\.(It )?Cm ' | sort -u))"
    claim "  the list has only columns" test -z \
        "$(page_words "$1" "$2" '^\.It Cm ' | sort -u | comm -23 - <(tr ' ' '\n' <<<"$shared" | sed 's/.*\.//' - "$1.keys" | sort -u))"
}
listed rc-slip REPORT
listed rc-leak REPORT
listed rc-stress "THE REPORT"
listed rc-solve "THE REPORT"
claim "rc-solve(1) and the pages of its effects describe each column once" test -z \
    "$(page_words rc-solve "THE REPORT" '^\.It Cm ' | sort | uniq -d | tee /dev/stderr)"
page_words rc-info OPTIONS '^\.Cm ' >info.words
page_words rc-info "JSON FIELDS" '^\.(It )?Cm ' >>info.words
claim "rc-info(1): its lists have every column" test -z \
    "$(sed '/^[a-z]*_deviation$/d' rc-info.keys | sort -u | comm -23 - <(sort -u info.words))"
