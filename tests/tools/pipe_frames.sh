# SPDX-License-Identifier: GPL-3.0-or-later
# Frames and keys of a stream: every one that a tool writes is in rcg(5). For each tool that computes, the page says which it uses and
# which it refuses; all others together change no bit of its results and no message.
. "$(dirname "$0")/../pipe.sh"

page=$RC_SOURCE/man/rcg.5
# names: the names after .Cm in the lines of standard input.
names() { sed -n 's/^\.Cm //p' | sed 's/ [.]$//; s/ , /\n/g; s/ ,$//' | grep -x '[a-z][a-z0-9._-]*' | sort -u; }
sed -n '/^\.It Cm channel$/,/^Any other name/p' "$page" | names >channels.txt
sed -n 's/^    {"\([a-z0-9._-]*\)", [A-Z].*/\1/p' "$RC_SOURCE/formats/rcg/keys.c" | sort >rules.txt
sed -n '/^\.Ss Other keys/,/^\.Ss Frames and/s/^\.It Cm //p' "$page" | sed 's/ , /\n/g' | sort -u >documented.txt
# table TOOL WORDS: the names that the page lists for a tool, as "Frames used".
table() {
    sed -n '/^\.Ss Frames and keys/,/^\.Ss Axes/p' "$page" | awk -v it=".It Xr $1 1" -v words="$2" '
        /^\.It / { in_tool = $0 == it } !/^\.Cm/ { on = in_tool && index($0, words) == 1 } on && /^\.Cm/ { print }' | names
}

# ---- what the tools write ----

rc-synth selfaffine --nx 16 --ny 12 --dx 1um --hurst 0.8 --rms-height 20nm --seed 4 | rc-detrend --quiet --plane --outliers 9 | rc-pick --set periodic=no -o heights.rcg
same='--E1 200GPa --nu1 0.3 --E2 200GPa --nu2 0.3'
rc-solve --quiet --load 1mN $same heights.rcg -o w-solved.rcg
rc-solve --quiet --load 1mN $same --radius 1mm --travel 0,2um heights.rcg -o w-travel.rcg
rc-solve --quiet --load 1mN $same --adhesion 50mJ/m2 --output pressure,contact,adhesion heights.rcg -o w-adhesion.rcg
rc-solve --quiet --load 1mN $same --hardness 4GPa --output plastic,pressure heights.rcg -o w-plastic.rcg
rc-synth sphere --nx 24 --dx 2um --radius 100um -o ball.rcg
rc-solve --quiet --load 0.1N $same --yield 1GPa,50GPa --increments 1 --tol 0.3 --output pressure,residual,strain ball.rcg -o w-yield.rcg
rc-solve --quiet --load 1mN --relaxation 1GPa,2GPa:1s --nu1 0.3 --E2 rigid --time 1 heights.rcg -o w-time.rcg
rc-solve --quiet --load 1mN --periodic --relaxation 1GPa,2GPa:1s --nu1 0.3 --E2 rigid --speed 1mm/s heights.rcg -o w-speed.rcg
rc-solve --quiet --load 1mN --E1 200GPa --nu1 0.3 --layer 2um,400GPa,0.2,1GPa --E2 rigid heights.rcg -o w-layers.rcg
rc-slip --quiet --mu 0.3 --tangential 0.1mN --output traction-x,traction-y,slip-x,slip-y,state,slip,dissipation w-solved.rcg -o w-slip.rcg
rc-slip --quiet --mu 0.3 --creep 1e-3,0 --steady --output traction-x,slip,dissipation w-solved.rcg -o w-roll.rcg
rc-wear --quiet --coefficient 1e-6mm3/Nm --distance 10um w-solved.rcg -o w-wear.rcg
rc-wear --quiet --coefficient 1e-6mm3/Nm --distance 10um w-layers.rcg -o w-coat.rcg
rc-heat --quiet --mu 0.3 --speed 1m/s --conductivity 40,40 --diffusivity 1e-5,1e-5 w-solved.rcg -o w-heat.rcg
rc-stress --quiet --depths 0,1um --components sxx,syy,szz,sxy,sxz,syz,mises,tresca,s1,s2,s3 --mu 0.1 w-layers.rcg -o w-stress.rcg
rc-stress --quiet --section y=0 --depths 0:2um:3 w-solved.rcg -o w-section.rcg
rc-fatigue --quiet --bending-limit 1GPa --torsion-limit 0.6GPa --depths 1um --pass x --criteria crossland,dangvan,papadopoulos,findley w-solved.rcg -o w-fatigue.rcg
if [ -x "$RC_BIN/rc-leak" ]; then rc-leak --quiet --viscosity 1mPas --pressure-drop 1MPa w-solved.rcg -o w-leak.rcg; fi
rc-deflect --quiet w-solved.rcg -o w-deflect.rcg
rc-info --psd --psd-map w-psd.rcg heights.rcg >/dev/null
heads() { perl -0777 -ne 'while (/RCG1\n(.*?)\n\n/sg) { print "$1\n" }' "$@"; }
claim "all of these commands wrote frames" bash -c 'for f in w-*.rcg; do [ -s "$f" ] || { echo "$f" >&2 && exit 1; }; done; [ $(ls w-*.rcg | wc -l) -ge 16 ]'
heads heights.rcg w-*.rcg | sed -n 's/^channel=//p' | sort -u >written.txt
claim "  the page has the channels of all of them" bash -c 'comm -23 written.txt channels.txt >&2; [ -z "$(comm -23 written.txt channels.txt)" ] && [ $(wc -l <written.txt) -ge 35 ]'
heads heights.rcg w-*.rcg | sed -n 's/=.*//p' | grep -vxE 'channel|nx|ny|dx|dy|unit|type' | sort -u >keys.txt
claim "  the table of keys has theirs" bash -c 'comm -23 keys.txt rules.txt >&2; [ -z "$(comm -23 keys.txt rules.txt)" ] && [ $(wc -l <keys.txt) -ge 35 ]'
claim "  the page has every key of the table" bash -c 'comm -23 rules.txt documented.txt >&2; [ -z "$(comm -23 rules.txt documented.txt)" ]'

# ---- streams ----

# make_frames CHANNEL...: made/CHANNEL has made values on the grid of the pressure, with its keys.
make_frames() {
    mkdir made
    perl -MCompress::Zlib -0777 -e '
        open my $in, "<:raw", "pressure.rcg"; $_ = <$in>; /^(RCG1\n.*?\n\n)/s or die; my $first = $1;
        for my $channel (@ARGV) {
            my $head = $first;
            my ($unit, $scale) = $channel =~ /^(s[xyz123]|mises|tresca|pressure|hardness|adhesion|traction|amplitude|fluid)/ ? ("Pa", 1e7)
                : $channel =~ /^heat/ ? ("W/m2", 1e3) : $channel eq "dissipation" ? ("J/m2", 1) : $channel =~ /^temp/ ? ("K", 1)
                : $channel eq "wear-coefficient" ? ("1/Pa", 1e-15)
                : $channel =~ /^(height|gap|displacement|plastic|residual|slip|wear)/ ? ("m", 1e-8) : ("1", 1e-3);
            $head =~ s/^channel=.*$/channel=$channel/m; $head =~ s/^unit=.*$/unit=$unit/m;
            $head =~ s/\n\n$/\ndepth=1e-06\nthickness=2e-06\n\n/ if $channel =~ /^(e[xy][xyz]|peeq|s[xyz][xyz]|mises|tresca|s[123])$/;
            srand(7);
            my $body = $head . join("", map { my $r = rand; pack("d<", $channel eq "contact" ? $r > 0.3 : $channel =~ /^(state|channel)$/ ? int(3 * $r) : $scale * $r) } 1..192);
            open my $out, ">:raw", "made/$channel" or die; print $out $body, sprintf("crc32 %08x\n", crc32($body));
        }' "$@"
}
bare() { perl -0777 -pe 's/RCGEND \d+\n$//' "$@"; }
sealed() { # the frames of standard input with an end line
    perl -0777 -pe '$n = () = /^RCG1$/mg; $_ .= "RCGEND $n\n"'
}
# with KEY=VALUE... : all frames of standard input have these keys.
with() {
    perl -MCompress::Zlib -0777 -e '
        $_ = <STDIN>; my ($all, $n) = ("", 0);
        while (/(RCG1\n.*?\n\n)/sg) {
            my ($head, $at) = ($1, pos); my ($nx, $ny) = $head =~ /nx=(\d+)\nny=(\d+)/; my $values = substr($_, $at, 8 * $nx * $ny);
            pos($_) = $at + 8 * $nx * $ny + 15;
            for my $set (@ARGV) { my ($key) = split /=/, $set; $head =~ s/^\Q$key\E=.*\n//mg; $head =~ s/\n\n$/\n$set\n\n/ }
            $all .= $head . $values . sprintf("crc32 %08x\n", crc32($head . $values)); $n++;
        }
        print "${all}RCGEND $n\n"' "$@"
}
# results FILE CHANNELS...: the values of the frames, without those that the tool passed on from its input.
results() {
    perl -0777 -e '
        my ($file, %passed) = ($ARGV[0], map { $_ => 1 } @ARGV[1 .. $#ARGV]);
        open my $in, "<:raw", $file; $_ = <$in>; if (!/^RCG1/) { print; exit }
        while (/(RCG1\n.*?\n\n)/sg) {
            my ($head, $at) = ($1, pos); my ($nx, $ny) = $head =~ /nx=(\d+)\nny=(\d+)/; my ($channel) = $head =~ /channel=(.*)/;
            my $size = $nx * $ny * ($head =~ /type=f32/ ? 4 : 8); pos($_) = $at + $size + 15;
            print "$channel\n", substr($_, $at, $size) unless $passed{$channel};
        }' "$@"
}
for channel in pressure gap height; do rc-pick --channel $channel w-solved.rcg -o $channel.rcg; done
# shellcheck disable=SC2046
make_frames $(<channels.txt)

# A tool, the frames of the plain case, and its command.
tools() {
    cat <<'END'
rc-detrend height rc-detrend --lowpass 3um
rc-add height rc-add - heights.rcg
rc-solve height rc-solve --load 1mN --E1 200GPa --nu1 0.3 --E2 rigid
rc-slip pressure rc-slip --mu 0.3 --tangential 0.1mN
rc-stress pressure rc-stress --depths 0,1um
rc-fatigue pressure rc-fatigue --bending-limit 1GPa --torsion-limit 1GPa --depths 1um --pass x
rc-deflect pressure rc-deflect
rc-leak pressure,gap rc-leak
rc-wear pressure,gap,height rc-wear --coefficient 1e-6mm3/Nm --distance 1um
rc-heat pressure rc-heat --mu 0.3 --speed 1m/s --conductivity 40,40 --diffusivity 1e-5,1e-5
END
}
# run NAME COMMAND...: the results of plain.rcg or another input as NAME.values, the messages and the exit status as NAME.said.
run() {
    local name=$1 input=$2
    shift 2
    "$@" <"$input" >"$name.out" 2>"$name.err"
    { echo "status $?" && sed 's/, frame [0-9]* / /' "$name.err"; } >"$name.said" # more frames, other numbers
}
# plain FRAMES: the frames of the plain case.
plain() {
    local channel
    for channel in ${1//,/ }; do bare "$channel.rcg"; done
}

# ---- the table of frames ----

# A frame is used when it changes results, messages or the exit status.
used_frame() {
    local tool=$1 channel=$2
    shift 2
    cat plain.bare "made/$channel" | sealed >more.rcg
    run more more.rcg "$@"
    results more.out "$channel" >more.values
    if cmp -s plain.values more.values && cmp -s plain.said more.said; then
        echo "$tool ignores $channel" >&2
        return 1
    fi
}
frames_of() { # TOOL FRAMES COMMAND...
    local tool=$1 frames=$2 channel
    shift 2
    plain "$frames" >plain.bare
    sealed <plain.bare >plain.rcg
    run plain plain.rcg "$@"
    results plain.out >plain.values
    grep -q '^status 0$' plain.said || { cat plain.said >&2 && return 1; }
    { table "$tool" "Frames used" && table "$tool" "Frames refused" && tr , '\n' <<<"$frames"; } | sort -u >taken.txt
    comm -23 channels.txt taken.txt >ignored.txt
    [ "$(wc -l <ignored.txt)" -gt 3 ] && [ -n "$(table "$tool" "Frames used")" ] || return
    { cat plain.bare && sed 's|^|made/|' ignored.txt | xargs cat; } | sealed >more.rcg
    run more more.rcg "$@"
    # rc-detrend and rc-add pass frames on
    case $tool in rc-detrend | rc-add) results more.out $(<ignored.txt) ;; *) results more.out ;; esac >more.values
    cmp plain.values more.values >&2 && diff plain.said more.said >&2 || { echo "$tool does not ignore all of $(tr '\n' ' ' <ignored.txt)" >&2 && return 1; }
    for channel in $(table "$tool" "Frames used"); do
        case ,$frames, in *,$channel,*) continue ;; esac
        # the height where tractions change the pressure; heat in place of a pressure
        case $tool-$channel in rc-slip-height | rc-heat-heat) continue ;; esac
        used_frame "$tool" "$channel" "$@" || return
    done
    for channel in $(table "$tool" "Frames refused" | { [ "$tool" = rc-detrend ] && cat || head -n 3; }); do
        cat plain.bare "made/$channel" | sealed >more.rcg
        run more more.rcg "$@"
        grep -q '^status 1$' more.said && grep -qF "$channel" more.said || { echo "$tool takes $channel" >&2 && return 1; }
    done
}

# ---- the table of keys ----

values='form=sphere+1 layers=1e-6,4e11,0.2;inf,2e11,0.3 layers.residual=1e6 adhesion=0.05,exponential,1e-9 dunit=rad/m window=hann periodic=yes
boundary=periodic hardness_map=yes section=y direction=y frames=7 material=2 slabs=3 estar=1e9 e1=1e9 nu=0.2 e2=1e9 nu2=0.2 load=0.002
approach=1e-6 hardness=1e6 yield=1e8 hardening=1e9 depth=1e-6 depths=0,1e-6 thickness=1e-6 at=1e-6 mu=0.2 friction=0.2 tau_max=1e6
tangential_x=1 tangential_y=1 displacement_x=1e-6 displacement_y=1e-6 creep_x=1e-3 creep_y=1e-3 spin=1 position=1e-6 height=1e-6
window_x=1e-6 time=1 speed=1 distance=1 cycles=10 wear_1=1e-15 wear_2=1e-15 coat_left=1e-7 bending_limit=1e9 torsion_limit=1e9 max_temperature=10
flow_conductance=1 flow_rate=1 pressure_drop=1 viscosity=1 throat_x=1e-6 throat_y=1e-6 filled=3 outliers=3 spikes=3 taper=1e-6 form.radius=1
height.error=1e-9 pressure.error=1e-3 traction.error=1e-3 datum=1e-3 align.shift_x=1e-6 align.shift_y=1e-6 align.rotation=1e-3 align.residual=1e-9 align.volume=1e-15
align.volume_error=1e-17'
in_messages='source history case converged separated' # they name the frame, or cause a warning
claim "each key of the table has a value here" bash -c 'comm -23 rules.txt <(printf "%s\n" $0 | sed "s/=.*//" | sort) >&2
    [ -z "$(comm -23 rules.txt <(printf "%s\n" $0 | sed "s/=.*//" | sort))" ]' "$values $in_messages"
keys_of() { # TOOL FRAMES COMMAND...: plain.* are those of frames_of
    local tool=$1 set key ignored=()
    shift 2
    { table "$tool" "Keys used" && table "$tool" "Keys refused"; } | sort >taken.txt
    [ "$(wc -l <taken.txt)" -gt 1 ] || return
    for set in $values; do
        grep -qxF -- "${set%%=*}" taken.txt || ignored+=("$set")
    done
    # with layers alone rc-stress and rc-fatigue refuse time and speed
    with "${ignored[@]}" <plain.rcg >more.rcg
    run more more.rcg "$@"
    results more.out >more.values
    cmp plain.values more.values >&2 && diff plain.said more.said >&2 || { echo "$tool does not ignore all of ${ignored[*]}" >&2 && return 1; }
    for key in $(table "$tool" "Keys refused"); do
        set=$(printf '%s\n' $values | grep -F -- "$key=" | grep "^$key=")
        with "$set" <plain.rcg >more.rcg
        run more more.rcg "$@"
        grep -q '^status [12]$' more.said && [ ! -s more.out ] || { echo "$tool takes $set" >&2 && return 1; }
    done
}

while read -r tool frames command; do
    [ -x "$RC_BIN/$tool" ] || continue
    # shellcheck disable=SC2086
    claim "$tool uses and refuses the frames that the page says, and no other changes its results" frames_of "$tool" "$frames" $command
    # shellcheck disable=SC2086
    claim "  and the keys" keys_of "$tool" "$frames" $command
done < <(tools)
table rc-add "Frames refused" >add.txt
table rc-detrend "Frames refused" >detrend.txt
claim "rc-add refuses the frames that rc-detrend refuses" cmp add.txt detrend.txt
with 'layers=1e-6,4e11,0.2;inf,2e11,0.3' time=1 <pressure.rcg >relaxing.rcg
refuses 1 'viscoelastic \(time=1\)' "stresses in a coat that relaxes are refused" "rc-stress --depths 0,1um relaxing.rcg"
rc-solve --quiet --load 1mN --E1 200GPa --nu1 0.3 --E2 rigid --tilt free heights.rcg -o tilted.rcg
refuses 1 'free to tilt' "a contact of a body that tilts is not solved again without tilt" "rc-slip --mu 0.3 --tangential 0.1mN tilted.rcg"
rc-solve --quiet --load 1mN --E1 200GPa --nu1 0.3 --E2 rigid tilted.rcg -o again.rcg
claim "  one that was solved without tilt afterwards is" rc-slip --quiet --mu 0.3 --tangential 0.1mN --increments 2 --tol 0.3 -o /dev/null again.rcg
