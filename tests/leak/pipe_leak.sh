# SPDX-License-Identifier: GPL-3.0-or-later
# rc-leak on gaps with closed-form solutions, given as frames. Tested are rates and units, a list of loads,
# and warnings and refusals of one sentence each.
. "$(dirname "$0")/../pipe.sh"

# made KEYS NX NY DX DY CHANNEL EXPRESSION...: writes a stream of one case. perl computes the values from $i,
# $j; KEYS are header lines.
cat >made.pl <<'END'
use Compress::Zlib;
my ($keys, $nx, $ny, $dx, $dy, @frames) = @ARGV;
my $n = 0;
while (my ($channel, $value) = splice @frames, 0, 2) {
    my $frame = "RCG1\nchannel=$channel\nnx=$nx\nny=$ny\ndx=$dx\ndy=$dy\nunit=" . ($channel eq "gap" ? "m" : "Pa") . "\ntype=f64\n$keys\n\n";
    for our $j (0 .. $ny - 1) { for our $i (0 .. $nx - 1) { $frame .= pack "d<", eval $value } }
    print $frame, sprintf("crc32 %08x\n", crc32($frame));
    $n++;
}
print "RCGEND $n\n";
END
made() { perl made.pl "$@"; }
column() { # NAME ROW FILE
    awk -F '\t' -v n="$1" -v r="$2" 'NR == 1 { for (i = 1; i <= NF; i++) { split($i, h, "/"); if (h[1] == n) c = i } } NR == r + 1 { print $c }' "$3"
}

# ---- known flows ----

# a stream of times, as of rc-solve --relaxation --time; a load alone has no time
made 'time=2.5' 12 4 2e-6 1e-6 gap '$j < 3 ? 2e-6 : 1e-12' pressure '$j < 3 ? 0 : 8e7' >at-time.rcg
rc-leak --quiet --report time.tsv at-time.rcg -o flow.rcg
claim "the report has the time of the stream" test "$(column time 1 time.tsv)" = 2.5
# lists of speeds and positions have one load
for key in speed position; do
    for value in 0.25 4; do
        made "$key=$value" 12 4 2e-6 1e-6 gap '$j < 3 ? 2e-6 : 1e-12' pressure '$j < 3 ? 0 : 8e7' >"$key$value.rcg"
    done
    cat "${key}0.25.rcg" "${key}4.rcg" | rc-leak --quiet --report list.tsv -o flow.rcg
    claim "  and its ${key}s, so that its rows are told apart" test "$(column $key 1 list.tsv) $(column $key 2 list.tsv) $(column time 2 list.tsv)" = '0.25 4 NaN'
done

# 12 columns have a gap of 2 um in 3 of 4 rows and a wall of contact in the fourth: 3 g^3 dy/(12 dx)
made 'boundary=free
load=3' 12 4 2e-6 1e-6 gap '$j < 3 ? 2e-6 : 1e-12' pressure '$j < 3 ? 0 : 8e7' >channel.rcg
rc-leak --viscosity 2mPas --pressure-drop 100kPa --report channel.json channel.rcg -o flow.rcg 2>flow.err
claim "a resolved channel causes no warning" test ! -s flow.err
near "$(field flow_conductance channel.json)" 1e-18 "$rounding" "a channel: its conductance"
near "$(field flow_rate channel.json)" "$(awk 'BEGIN { print 1e-18 * 1e5 / (12 * 2e-3) }')" "$six_digits" "  and rate"
near "$(field conductance_lower channel.json)" 1e-18 "$rounding" "  which is proven from below"
near "$(field conductance_upper channel.json)" 1e-18 "$rounding" "  and from above"
near "$(field flow_factor channel.json)" "$(awk 'BEGIN { print 1e-18 * 24 / 4 / (1.5e-6) ^ 3 }')" "$six_digits" "  its flow factor"
near "$(field mean_pressure channel.json)" 2e7 "$rounding" "  the mean pressure of the contact"
near "$(field load channel.json)" 3 "$rounding" "  and its load, for a curve"
near "$(field contact_fraction channel.json)" 0.25 "$rounding" "  and fraction"
near "$(field critical_gap channel.json)" 2e-6 "$rounding" "  the critical gap"
near "$(field critical_flow channel.json)" "$(awk 'BEGIN { print 8e-18 * 4 / 24 * 1e5 / (12 * 2e-3) }')" "$six_digits" "  and what it lets through"
near "$(field throat_nodes channel.json)" 3 "$same" "  which is 3 nodes wide"
# 12 cells: pressures at (i + 1/2)/12 of the way; the flux per width is g^3 dp/(24 dx)/(12 eta) everywhere
row() { rc-pick --channel "$1" flow.rcg | rc-export --format csv | grep -v '^#' | sed -n "$2p"; }
claim "fluid pressure falls along the channel and is missing in contact" bash -c '
    awk -F , "{ for (i = 1; i <= 12; i++) { d = \$i - 1e5 * (12.5 - i) / 12; if (d < -1e-6 || d > 1e-6) exit 1 } n = NF } END { exit n != 12 }" <<<"$1" &&
        [[ $2 =~ ^[nN]a[nN](,[nN]a[nN]){11}$ ]]' - "$(row fluid-pressure 2)" "$(row fluid-pressure 4)"
flux=$(awk 'BEGIN { print 8e-18 / 24e-6 * 1e5 / (12 * 2e-3) }')
near "$(row flux 1 | cut -d , -f 7)" "$flux" "$six_digits" "flux per width"
claim "  the flux is missing in contact" test "$(row flux 4 | tr , '\n' | sort -u | tr A-Z a-z)" = nan
claim "the frame channels has its values" test "$(row channel 1 | tr , '\n' | sort -u) $(row channel 4 | tr , '\n' | sort -u)" = "2.0 0.0"
claim "the frames have their units" bash -c 'rc-info --json flow.rcg | grep -o "\"unit\": \"[^\"]*\"" | tr "\n" " " | grep -qx "\"unit\": \"Pa\" \"unit\": \"m2/s\" \"unit\": \"1\" "'
claim "the frames have the keys for a picture" bash -c 'rc-info flow.rcg | says "throat_x=" cat && rc-info flow.rcg | says "flow_rate=4.16666.*e-12" cat'
claim "the frames have the history" says 'rc-leak [^|]* --viscosity 0.002 --pressure-drop 100000' head -c 2000 flow.rcg

told() { rc-leak --verbose "$@" channel.rcg -o x.rcg 2>&1; }
claim "--verbose prints the flow, the contact and the gap" bash -c "grep -qx 'rc-leak: channel.rcg[^:]*: flow 4.17e-12 m3/s, contact 25 %, narrowest gap 2 um; [0-9]* unknowns, [0-9.e-]* s' <<<'$(told --viscosity 2mPas --pressure-drop 100kPa)'"
claim "  without a fluid its conductance, with sliding the flow that it drags" bash -c "grep -q ': flow conductance 1e-18 m3, dragged along by sliding [0-9.e-]* m3/s, contact 25 %' <<<'$(told --sliding 2m/s)'"
claim "  across the wall that no path is open" bash -c "grep -q ': no path from edge to edge: sealed, contact 25 %; ' <<<'$(told --direction y)'"
rc-leak --quiet --report bare.json channel.rcg -o bare.rcg
claim "without a fluid there is a conductance, but no flow rate" grep -q '"viscosity": null, "pressure_drop": null, .*"flow_rate": null, .*"flow_conductance": [19]' bare.json
claim "  pressures fall from 1 to 0, and fluxes are in m2" bash -c 'rc-info --json bare.rcg | grep -o "\"unit\": \"[^\"]*\"" | tr "\n" " " | grep -qx "\"unit\": \"1\" \"unit\": \"m2\" \"unit\": \"1\" "'
claim "--output selects frames, which come in a fixed order" bash -c 'test "$(rc-leak --quiet --output channel,flux channel.rcg | rc-info --json | grep -o "\"channel\": \"[a-z-]*\"" | tr "\n" " ")" = "\"channel\": \"flux\" \"channel\": \"channel\" "'
rc-leak --quiet --direction y --report across.json channel.rcg -o across.rcg
claim "no fluid flows across the wall" grep -q '"flow_conductance": 0, .*"percolates": false, .*"critical_gap": 0, "critical_x": null' across.json
claim "  no critical constriction is marked" bash -c 'rc-info across.rcg >across.txt && ! grep -q throat_x across.txt'

# a gap that varies along the flow: (1 - A^2)^(5/2)/(1 + A^2/2), A = 0.5
made periodic=yes 32 4 1e-6 1e-6 gap '1e-6 * (1 + 0.5 * cos(2 * 3.14159265358979 * ($i + 0.5) / 32))' >wave.rcg
rc-leak --report wave.json wave.rcg -o wave-flow.rcg 2>wave.err
near "$(field flow_factor wave.json)" "$(awk 'BEGIN { print 0.75 ^ 2.5 / 1.125 }')" "$six_digits" "a wave across the flow"
claim "the sides join, because the map is periodic" grep -q '"sides": "periodic"' wave.json
claim "a case without a pressure frame causes a warning" grep -q 'without a pressure frame .*rc-solve --output pressure,gap' wave.err
rc-leak --quiet --sides closed --report closed.json wave.rcg -o closed.rcg
claim "  --sides closed closes them" grep -q '"sides": "closed"' closed.json
rc-leak --quiet --report stripes.json --direction y wave.rcg -o stripes.rcg
near "$(field flow_factor stripes.json)" 1.375 "$rounding" "a wave along it: 1 + 3 A^2/2"

# ---- sliding ----

# dragged gap <g^-2>/<g^-3>; the smooth body slides, the rough one, both: from each to the next the frame moves
dragged=$(awk 'BEGIN { print 0.75 / 1.125 }')
near "$(field shear_stress_factor wave.json)" "$dragged" "$six_digits" "a wave across the flow: its shear stress factor"
near "$(field shear_flow_factor wave.json)" "$(awk 'BEGIN { print (0.75 / 1.125 - 1) / sqrt(0.125) }')" "$six_digits" "  and shear flow factor"
claim "  without --sliding there is no shear flow" grep -q '"sliding": null, "sliding_rough": null, .*"shear_flow": null' wave.json
slid() { rc-leak --quiet --sliding "$1" --report - "${@:2}" wave.rcg | field shear_flow /dev/stdin; }
near "$(slid 2m/s)" "$(awk 'BEGIN { print 4e-12 * 0.75 / 1.125 }')" "$six_digits" "the smooth body slides at 2 m/s: U/2 times this gap"
near "$(slid 0,2m/s)" "$(awk 'BEGIN { print 4e-12 * (2 - 0.75 / 1.125) }')" "$six_digits" "the rough body slides: it carries more than the mean gap"
near "$(slid 2m/s,2m/s)" 8e-12 "$six_digits" "both slide: they carry the whole mean gap along"
near "$(slid 5m/s,3m/s)" "$(awk 'BEGIN { print 4e-12 * 0.75 / 1.125 + 12e-12 }')" "$six_digits" "a moving observer: the mean gap times his speed more"
near "$(slid -2m/s)" "$(awk 'BEGIN { print -4e-12 * 0.75 / 1.125 }')" "$six_digits" "  backwards: the opposite flow"
near "$(slid 2m/s --direction y)" 32e-12 "$six_digits" "along the grooves, 32 um wide: the mean gap"
refuses 2 'it must be one speed .* or two' "three speeds" "rc-leak --sliding 1m/s,2m/s,3m/s wave.rcg -o x.rcg"

# ---- rough contacts under a list of loads ----

rc-synth selfaffine --nx 128 --dx 1um --hurst 0.8 --rms-slope 0.05 --rolloff 32um --short-cut 4um --seed 2 -o rough.rcg
rc-solve --quiet --periodic --estar 1GPa --mean-pressure 1MPa,3MPa,5MPa,16MPa --output pressure,gap rough.rcg -o pressed.rcg
rc-leak --quiet --report loads.tsv pressed.rcg -o leak.rcg
claim "a stream of loads has no time" test "$(column time 1 loads.tsv)" = NaN
claim "four loads give four rows" test "$(wc -l <loads.tsv)" = 5
claim "  the conductance falls from row to row" bash -c '
    awk -F "\t" "NR == 1 { for (i = 1; i <= NF; i++) if (\$i == \"flow_conductance/m3\") c = i }
        NR > 1 { if (NR > 2 && !(\$c < last)) exit 1; last = \$c } END { exit last != 0 || NR != 5 }" loads.tsv'
claim "  at 16 MPa no path percolates" test "$(column percolates 4 loads.tsv)" = false
for row in 1 2 3; do
    near "$(column conductance_lower $row loads.tsv)" "$(column conductance_upper $row loads.tsv)" "$summed" "proven bounds meet"
done
claim "a pipe works too, with every frame of a case" bash -c '
    rc-solve --quiet --periodic --estar 1GPa --mean-pressure 3MPa rough.rcg | rc-leak --quiet | rc-info --json >piped.json && test "$(wc -l <piped.json)" = 3'
# stagnant fluid has no flow: channel is 1 exactly at nodes without contact whose flux is 0
claim "the flux is 0 in still fluid and missing in contact" bash -c '
    paste -d " " <(rc-pick --case 3 --channel channel leak.rcg | rc-export --format xyz | grep -v "^#" | awk "{ print \$3 }") \
        <(rc-pick --case 3 --channel flux leak.rcg | rc-export --format xyz | grep -v "^#" | awk "{ print \$3 }") |
        awk "{ n[\$1]++; if (\$1 == 0 ? tolower(\$2) != \"nan\" : (\$1 == 1) != (\$2 == 0)) exit 1 } END { exit !(n[0] > 100 && n[1] > 10 && n[2] > 1000) }"'
# rotated by a quarter turn, with the other direction
rc-pick --case 2 --rotate 90 pressed.rcg >turned.rcg
rc-leak --quiet --direction y --report turned.json turned.rcg -o turned-flow.rcg
near "$(field flow_conductance turned.json)" "$(column flow_conductance 2 loads.tsv)" "$summed" "turned, the same along y"
for threads in 1 2; do rc-leak --quiet --threads $threads pressed.rcg -o threads$threads.rcg; done
claim "threads change no bit" cmp threads1.rcg threads2.rcg

# ---- pictures ----

# legend FILE: prints the words of an SVG in one line.
legend() { sed 's/<[^>]*>/ /g' "$1" | tr -s ' \n' '  '; }
claim "rc-render draws the flux on logarithmic colours" rc-render --case 3 --channel flux --log leak.rcg -o flux.svg
claim "  contact and still fluid have their own entries in the legend" says 'stagnant fluid .*contact \([0-9]+ of 16384 nodes\)' legend flux.svg
claim "  the constriction has a cross" says 'the critical constriction' legend flux.svg
claim "  a window without the constriction has no cross" rc-render --case 3 --channel flux --log --window "$(awk -v x="$(column critical_x 3 loads.tsv)" \
    'BEGIN { print (x > 0 ? "-60um:-20um,-60um:60um" : "20um:60um,-60um:60um") }')" leak.rcg -o part.svg
claim "    its legend has no entry for the cross" bash -c '! grep -q "narrowest place" part.svg && test -s part.svg'
claim "rc-render draws the fluid pressure" rc-render --case 2 --channel fluid-pressure leak.rcg -o pressure.svg
claim "  the legend explains nodes without a value" says 'contact, or enclosed fluid \([0-9]+ of' legend pressure.svg
claim "rc-render draws the leakage against the load" rc-render --curve mean_pressure:flow_conductance --log y -o curve.svg loads.tsv
claim "  a note counts the cases without flow" says "1 case sealed \(no flow\)" legend curve.svg
claim "  the axis has the unit of a volume flow" says 'Flow conductance \(m 3 *\)' legend curve.svg
claim "channels are drawn in three colours, without a colour bar" rc-render --case 3 --channel channel leak.rcg -o channel.svg
claim "  the legend names the colours" says 'Flow channels .*contact stagnant fluid flowing fluid' legend channel.svg
claim "  a sheet has the same legend" bash -c 'rc-render --sheet auto --channel channel leak.rcg -o sheet.svg && grep -q ">stagnant fluid<" sheet.svg && ! grep -q ">[0-2]\.[05]0*<" sheet.svg'
rc-render --channel pressure --case 2 pressed.rcg -o contact.svg
claim "the legend of other maps has not changed" says 'no contact' legend contact.svg

# ---- warnings ----

# one gap, one node wide
made boundary=free 9 9 1e-6 1e-6 gap '$i != 4 ? 1e-6 : $j == 3 ? 9e-7 : 0' pressure '$i == 4 && $j != 3 ? 1e6 : 0' >slit.rcg
claim "a constriction of one node causes a warning" warns 'the critical constriction, at x = 0 m, y = -1e-06 m, is 1 node wide, .*finer grid' rc-leak slit.rcg -o x.rcg
claim "  of three cases the first warns" bash -c 'cat slit.rcg slit.rcg slit.rcg | rc-leak -o x.rcg 2>x.err
    [ "$(grep -c "the critical constriction, at" x.err)" = 1 ]'
claim "    the others are counted" grep -q 'rc-leak: 2 other cases too: a narrow critical constriction' x.err
claim "  a constriction of three nodes causes no warning" bash -c "rc-leak channel.rcg -o x.rcg 2>x.err && ! grep constriction x.err"
made boundary=free 4 4 1e-6 1e-6 gap '($i < 2) == ($j < 2) ? 1e-6 : 0' pressure '($i < 2) == ($j < 2) ? 0 : 1e6' >corners.rcg
claim "a path through corners alone causes a warning" warns 'the only remaining path runs through cell corners; this grid cannot decide' rc-leak corners.rcg -o x.rcg
made boundary=free 8 8 1e-6 1e-6 gap '1e-7 * (1 + 30 * ($i % 2))' pressure 0 >comb.rcg
claim "a large error of the grid causes a warning" warns 'estimated error of the grid is 27[0-9] % of the flow' rc-leak comb.rcg -o x.rcg
claim "a steep gap causes a warning" warns 'RMS slope of the gap is 3 where fluid flows, .*below 0.3' rc-leak comb.rcg -o x.rcg
claim "a fluid pressure that would lift the bodies causes a warning" warns 'pressure drop, 3e\+06 Pa, is more than a tenth of the mean contact pressure, 2e\+07 Pa' \
    rc-leak --viscosity 1mPas --pressure-drop 3MPa channel.rcg -o x.rcg
claim "  a lower fluid pressure causes no warning" bash -c 'rc-leak --viscosity 1mPas --pressure-drop 1.9MPa channel.rcg -o x.rcg 2>x.err && ! grep -q lift x.err'
sed 's/^boundary=free/&\nconverged=no/' channel.rcg | perl -MCompress::Zlib -0777 -pe 's/(RCG1.*?)crc32 [0-9a-f]{8}\n/$1 . sprintf("crc32 %08x\n", crc32($1))/sge' >short.rcg
refuses 3 'converged' "what has not converged stays so" "rc-leak short.rcg -o short-flow.rcg"
claim "  a message says so" says 'converged=no' head -c 1000 short-flow.rcg

# ---- maps that repeat along one axis: the sides join where this axis lies across the flow ----

# in row 0 to column 6 and in row 3 from there: 13 nodes in a row if the rows are neighbours: the conductance g^3/13
bent='($i <= 6 && $j == 0) || ($i >= 6 && $j == 3)'
made boundary=periodic-y 12 4 1e-6 1e-6 gap "$bent ? 2e-6 : 1e-12" pressure "$bent ? 0 : 8e7" >bent.rcg
turn() { sed 's/\$i/$t/g; s/\$j/$i/g; s/\$t/$j/g' <<<"$1"; }
turned=$(turn "$bent")
made boundary=periodic-x 4 12 1e-6 1e-6 gap "$turned ? 2e-6 : 1e-12" pressure "$turned ? 0 : 8e7" >turned.rcg
along() { rc-leak --quiet --direction "$1" --report - "${@:2}" | field flow_conductance /dev/stdin; }
near "$(along x bent.rcg)" "$(awk 'BEGIN { print 8e-18 / 13 }')" "$six_digits" "periodic-y, flow along x: the rows at the edges are neighbours"
near "$(along y turned.rcg)" "$(awk 'BEGIN { print 8e-18 / 13 }')" "$six_digits" "  periodic-x, flow along y"
claim "  along the axis that repeats the sides are walls" test "$(along y bent.rcg) $(along x turned.rcg)" = "0 0"
claim "    and the report says so" says '"sides": "closed"' rc-leak --quiet --direction y --report - bent.rcg
near "$(along x --sides closed bent.rcg)" 0 0 "  --sides closed closes them"
refuses 1 'boundary=periodic-y contradicts --sides periodic, which needs a map that repeats along x' "sides of the free axis that do not meet" "rc-leak --direction y --sides periodic bent.rcg -o x.rcg"
claim "  along the free axis --sides periodic says nothing new" rc-leak --quiet --sides periodic bent.rcg -o x.rcg
# a rough gap, its rows moved by 5 of 16 with those that leave entering on the other side, and two of it beside each other
uneven='1e-6 * (1.2 + cos(0.7 * $i * $i) * cos(2 * 3.14159265358979 * J / 16) + 0.3 * sin(3 * $i + 6 * 3.14159265358979 * J / 16))'
for kind in "16 \$j" "16 (\$j+5)" "32 \$j"; do
    made boundary=periodic-y 20 "${kind% *}" 1e-6 1.5e-6 gap "${uneven//J/${kind#* }}" >"uneven${kind%% *}${#kind}.rcg"
    made boundary=periodic-x "${kind% *}" 20 1.5e-6 1e-6 gap "$(turn "${uneven//J/${kind#* }}")" >"turned${kind%% *}${#kind}.rcg"
done
one=$(along x uneven165.rcg)
near "$(along x uneven169.rcg)" "$one" "$rounding" "a rough gap moved along the axis that repeats has the same flow"
near "$(along x uneven325.rcg)" "$(awk "BEGIN { printf \"%.17g\", 2 * $one }")" "$rounding" "  two of it beside each other have twice the flow"
near "$(along y turned165.rcg)" "$one" "$rounding" "  the turned gap has the flow of the gap"
near "$(along x turned165.rcg)" "$(along y uneven165.rcg)" "$rounding" "    along the axis that repeats too"
rc-solve --quiet --periodic=y --estar 1GPa --mean-pressure 1MPa --output pressure,gap rough.rcg -o strip.rcg
claim "a pipe from rc-solve --periodic=y: the sides of a flow along x join" says '"boundary": "periodic-y", .*"sides": "periodic"' rc-leak --quiet --report - strip.rcg

# ---- refusals ----

refuses 1 'boundary=free contradicts --sides periodic, .* along y: remove that option' "sides that do not meet" "rc-leak --sides periodic channel.rcg -o x.rcg"
refuses 2 'direction z: it must be one of|direction z: ' "another direction" "rc-leak --direction z channel.rcg -o x.rcg"
refuses 2 '--viscosity has no effect without --pressure-drop' "a viscosity alone" "rc-leak --viscosity 1mPas channel.rcg -o x.rcg"
refuses 2 '--pressure-drop has no effect without --viscosity' "a pressure drop alone" "rc-leak --pressure-drop 1Pa channel.rcg -o x.rcg"
refuses 2 "unknown unit 'Pa': Pas is expected" "a viscosity in another unit" "rc-leak --viscosity 1Pa --pressure-drop 1Pa channel.rcg -o x.rcg"
refuses 2 'viscosity 0 Pas: it must be above 0' "no viscosity" "rc-leak --viscosity 0 --pressure-drop 1Pa channel.rcg -o x.rcg"
made boundary=free 3 3 1e-6 1e-6 pressure 1 >alone.rcg
refuses 1 'gap' "no gap" "rc-leak alone.rcg -o x.rcg"
made boundary=free 3 3 1e-6 1e-6 gap '$i == 1 ? "nan" : 1' pressure 0 >holes.rcg
refuses 1 'NaN or infinite.*: recompute the map' "a gap with holes" "rc-leak holes.rcg -o x.rcg"
made boundary=free 3 3 1e-6 1e-6 gap 1 pressure '$i == 1 ? "inf" : 0' >infinite.rcg
refuses 1 'NaN or infinite.*: recompute the map' "a pressure without end" "rc-leak infinite.rcg -o x.rcg"
made boundary=free 3 3 1e-6 1e-6 gap 1 >a.rcg
made boundary=free 4 3 1e-6 1e-6 pressure 0 >b.rcg
refuses 1 'bring them to one grid' "a gap and a pressure of two grids" "{ sed '/^RCGEND/d' a.rcg; sed 's/^RCGEND 1/RCGEND 2/' b.rcg; } | rc-leak -o x.rcg"
claim "refused commands leave no file" test ! -e x.rcg.tmp

# ---- cost of accuracy ----

rc-synth selfaffine --nx 96 --dx 1um --hurst 0.8 --rms-slope 0.05 --rolloff 48um --short-cut 12um --seed 3 -o costly.rcg
solve="rc-solve --periodic --estar 1GPa --mean-pressure 4MPa"
rc-cost --grid 2,1 --tol 1e-2,1e-4 --of flow_conductance --quiet --report cost.tsv -o cost.txt costly.rcg -- $solve '|' rc-leak --direction y
claim "rc-cost compares the flow on several grids" says '^# error: of flow_conductance, relative to the reference' cat cost.txt
flow_of() { rc-solve --quiet --periodic --estar 1GPa --mean-pressure 4MPa --tol 1e-10 --output pressure,gap | rc-leak --quiet --direction y --report - | tee flow.json | field flow_conductance /dev/stdin; }
fine=$(flow_of <costly.rcg)
near "$(sed -n 's/^# reference:.*: flow_conductance \([0-9.e-]*\) m3.*/\1/p' cost.txt)" "$fine" 1e-5 "  the reference is what rc-solve and rc-leak find"
coarse=$(rc-pick --resample 48x48 costly.rcg | flow_of)
near "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i } NR > 1 && $at["nx"] == 48 && $at["tol"] <= 1e-3 { print $at["flow_conductance_error"]; exit }' cost.tsv)" \
    "$(awk -v a="$coarse" -v b="$fine" 'BEGIN { print a / b - 1 }')" 0.02 "  on half the nodes a side its error is that of the coarse flow"

# ---- memory ----

rc-synth selfaffine --nx 512 --dx 1um --hurst 0.8 --rms-slope 0.05 --rolloff 64um --short-cut 16um --seed 2 -o wide.rcg
rc-solve --quiet --periodic --estar 1GPa --mean-pressure 3MPa --output pressure,gap wide.rcg -o wide-pressed.rcg
if nm -D "$(command -v rc-leak)" 2>/dev/null | grep __asan >asan.txt; then
    untried "memory, for the address sanitizer takes memory of its own"
else
    rc-leak --quiet --report wide.json wide-pressed.rcg -o wide-flow.rcg
    near "$(field memory_estimate wide.json)" "$(field peak_memory wide.json)" 0.1 "the memory that is counted"
    refuses 1 'need (about|at least) [0-9]+ MiB, --memory allows 20 MiB' "more than --memory, before the order" "rc-leak --memory 20M wide-pressed.rcg -o never.rcg"
    between_steps=$(awk -v peak="$(field peak_memory wide.json)" 'BEGIN { printf "%d", 0.85 * peak / 1024 }')
    refuses 1 'need (about|at least) [0-9]+ MiB, --memory allows [0-9]+ MiB' "and after it, by what it says" "rc-leak --memory ${between_steps}K wide-pressed.rcg -o never.rcg"
    claim "no half-written file is left" test ! -e never.rcg
fi
