# SPDX-License-Identifier: GPL-3.0-or-later
# rc-pick --crop, rc-add, rc-detrend --plane and rc-info of files need the memory of some rows, and write the bytes
# of a run with the maps in memory. A pipe cannot be read twice: rc-detrend, rc-info and the second surface of
# rc-add are then in memory. Damage in the last row of a map, after rows were written, leaves no file.
. "$(dirname "$0")/../pipe.sh"

rough="selfaffine --dx 1um --hurst 0.8 --rms-slope 0.1 --short-cut 6um"
rc-synth $rough --nx 61 --ny 47 --seed 2 | rc-pick --set periodic= -o one.rcg
rc-synth $rough --nx 58 --ny 52 --seed 3 | rc-pick --set periodic= -o other.rcg
rc-synth sphere --nx 61 --ny 47 --dx 1um --radius 1mm --type f32 -o single.rcg
rc-synth $rough --nx 190000 --ny 3 --seed 4 | rc-pick --set periodic= -o wide.rcg # one row exceeds a piece
rc-pick --crop 0,0,61,1 one.rcg -o line.rcg
# Points that were not measured: the first row, and a part of the others.
perl -0777 -pe 's/(\n\n)(.*)crc32 .{8}\n/my ($a, $v) = ($1, $2);
    for my $k (0 .. length($v) \/ 8 - 1) { substr($v, 8 * $k, 8) = "\0\0\0\0\0\0\xf8\x7f" if $k < 61 || $k % 7 == 3; }
    "$a${v}crc32 00000000\n"/se' one.rcg | reseal >holes.rcg

# values FILE: the values of all frames.
values() {
    rc-export --format csv "$1" | grep -v '^#'
}

# ---- equal bytes ----

# held OPTIONS -- FILE: rc-detrend of the file and of a pipe write the same.
held() {
    local file=${!#}
    rc-detrend --quiet "${@:1:$#-1}" "$file" -o by-rows.rcg && rc-detrend --quiet "${@:1:$#-1}" <(cat "$file") -o held.rcg &&
        cmp by-rows.rcg held.rcg
}
for map in one holes single wide line; do
    claim "rc-detrend --plane, $map" held --plane $map.rcg
    claim "  of degree 0" held --poly 0 $map.rcg
done
claim "rc-detrend --poly 5, with threads" held --poly 5 --threads 3 holes.rcg
claim "  of degree 14, by the factorisation" held --poly 14 holes.rcg
cat one.rcg holes.rcg >both.rcg
perl -0777 -pe 's/(\n\n)(.*)crc32 .{8}\n/my ($a, $v) = ($1, $2);
    for my $k (0 .. length($v) \/ 8 - 1) { substr($v, 8 * $k, 8) = "\0\0\0\0\0\0\xf8\x7f" if int($k \/ 61) != $k % 61; }
    "$a${v}crc32 00000000\n"/se' one.rcg | reseal >diagonal.rcg
refuses 1 'do not determine a polynomial of degree 1' "  not of points on one line" "rc-detrend --plane diagonal.rcg -o no.rcg"
claim "  two maps of a file" held --plane both.rcg
claim "  standard input that is a file" bash -c 'rc-detrend --plane <one.rcg | cmp - <(rc-detrend --plane one.rcg)'
claim "  other frames of a case pass" bash -c '
    rc-solve --quiet --estar 1GPa --load 1mN --output height one.rcg | rc-pick --set note=x -o solved.rcg &&
    rc-detrend --plane solved.rcg | cmp - <(cat solved.rcg | rc-detrend --plane)'
# added OPTIONS A B: rc-add of files, and with B from a pipe, give the same values.
added() {
    rc-add --quiet "$@" -o files.rcg && rc-add --quiet "${@:1:$#-1}" <(cat "${!#}") -o piped.rcg &&
        cmp <(values files.rcg) <(values piped.rcg)
}
claim "rc-add" added one.rcg other.rcg
claim "  the other way round" added other.rcg one.rcg
claim "  the difference" added --subtract holes.rcg one.rcg
claim "  of long rows" added wide.rcg wide.rcg
claim "  one surface for two" added both.rcg other.rcg
claim "  two for two" added both.rcg both.rcg
# By its definition: the value of column i is that of A plus that of column n - 1 - i of B, middles together.
claim "the sum is that of its definition" bash -c '
    rc-add --quiet one.rcg other.rcg | rc-export --format csv | grep -v "^#" >sum.csv
    rc-export --format csv one.rcg | grep -v "^#" >a.csv; rc-export --format csv other.rcg | grep -v "^#" >b.csv
    perl -e "use strict; my @m = map { open my \$f, q(<), \$_; [map { chomp; [split /,/] } <\$f>] } @ARGV; my (\$a, \$b, \$s) = @m;
        for my \$j (0 .. 46) { for my \$i (0 .. 57) { my \$w = \$a->[\$j][\$i + 1] + \$b->[\$j + 2][57 - \$i];
        die \"\$i \$j\" unless abs(\$w - \$s->[\$j][\$i]) <= 1e-15 * (abs(\$w) + 1e-6) } }" a.csv b.csv sum.csv'

# cut X Y W H FILE: --crop writes these values.
cut() {
    rc-pick --quiet --crop "$1,$2,$3,$4" "$5" | rc-export --format csv | grep -v '^#' |
        cmp - <(values "$5" | sed -n "$(($2 + 1)),$(($2 + $4))p" | command cut -d, -f"$(($1 + 1))-$(($1 + $3))")
}
claim "rc-pick --crop" cut 3 5 20 11 one.rcg
claim "  of the last row and column" cut 60 46 1 1 one.rcg
claim "  of single precision" cut 0 1 61 46 single.rcg
claim "  of long rows" cut 1000 1 100000 2 wide.rcg
claim "  twice" bash -c 'rc-pick --crop 3,5,20,11 --crop 2,1,4,5 one.rcg | rc-export --format csv | grep -v "^#" |
    cmp - <(rc-pick --crop 5,6,4,5 one.rcg | rc-export --format csv | grep -v "^#")'
refuses 1 'columns 0 to 60 and rows 0 to 46' "  beyond the map" "rc-pick --crop 50,0,20,4 one.rcg -o no.rcg"

# shown FILE: rc-info of the file and of a pipe print the same.
shown() {
    local option
    for option in --quiet --json; do
        rc-info $option <"$1" >by-rows.txt && rc-info $option < <(cat "$1") | cmp by-rows.txt - || return
    done
}
rc-solve --quiet --estar 1GPa --load 0.2mN --hardness 1MPa --type f32 single.rcg -o hard.rcg
rc-solve --quiet --estar 1GPa --load 0.2mN --adhesion 50mJ/m2 single.rcg -o stuck.rcg
rc-pick --channel pressure -o net.rcg stuck.rcg
for map in one holes single wide line both hard stuck net; do
    claim "rc-info, $map" shown $map.rcg
done
claim "  the plastic area and the contact" grep -q 'reached on' <(rc-info hard.rcg)
claim "  a net pressure" grep -q 'contact *unknown' <(rc-info --quiet net.rcg)
claim "  with patches, the map is in memory" bash -c 'cmp <(rc-info --patches stuck.rcg) <(cat stuck.rcg | rc-info --patches)'

# ---- damage ----

perl -0777 -pe 's/.(?=crc32)/X/s' one.rcg >damaged.rcg
head -c 20000 one.rcg >short.rcg
for command in "rc-pick --crop 0,0,4,4" "rc-pick --set a=b" "rc-detrend --plane" "rc-add one.rcg" "rc-add --subtract other.rcg"; do
    refuses 1 'frame 1: the checksum is' "$command: a damaged last value" "$command damaged.rcg -o no.rcg"
    refuses 1 'frame 1: the stream stops' "  a map that is cut off" "$command short.rcg -o no.rcg"
done
refuses 1 'frame 1: the checksum is' "rc-info: a damaged last value" "rc-info damaged.rcg"
refuses 1 'frame 1: the stream stops' "  a map that is cut off" "rc-info short.rcg"
claim "no file is left" bash -c '! ls no.rcg* 2>/dev/null'
claim "  in a pipe the next tool fails too" bash -c '! rc-pick --crop 0,0,4,4 damaged.rcg 2>/dev/null | rc-info >/dev/null 2>&1'
perl -0777 -pe 's/.{8}(?=crc32)/\0\0\0\0\0\0\xf0\x7f/s' one.rcg | reseal >infinite.rcg
for command in "rc-detrend --plane" "rc-add one.rcg" "rc-add --subtract other.rcg"; do
    refuses 1 '1 heights are infinite, the first in column 60 of row 46' "$command: an infinite last height" \
        "$command infinite.rcg -o no.rcg"
done
refuses 1 '1 of 16 values of height are too large for single precision' "values beyond single precision" "
    perl -0777 -pe 's/\n\n.{8}/\n\n\0\0\0\0\0\0\0\x7f/s' one.rcg | reseal | rc-pick --crop 0,0,4,4 --type f32 -o no.rcg"

# ---- memory ----

rc-synth sphere --nx 2000 --ny 2000 --dx 1um --radius 10m -o large.rcg # 32 MB
# little "sentence" command: works in 12 MiB, and with its code takes less than the map.
little() {
    local sentence=$1
    shift
    claim "$sentence in 12 MiB" "$@" --memory 12M --debug -o little.rcg
    between 1 "$(sed -n 's/.*counted, \([0-9.]*\) MiB taken.*/\1/p' claim.err)" 20 "  taken, MiB"
}
if ! with_address_sanitizer; then
    little "rc-pick --crop" rc-pick --crop 100,100,1500,1500 large.rcg
    little "rc-pick of a channel" rc-pick --channel height large.rcg
    little "rc-detrend --plane" rc-detrend --plane --threads 2 large.rcg
    little "rc-add" rc-add large.rcg large.rcg
    claim "rc-info in 12 MiB" rc-info --memory 12M --debug large.rcg
    between 1 "$(sed -n 's/.*counted, \([0-9.]*\) MiB taken.*/\1/p' claim.err)" 20 "  taken, MiB"
    refuses 1 'memory allows' "rc-info --areal needs the map" "rc-info --areal --memory 12M large.rcg"
    refuses 1 'memory allows' "rc-detrend --lowpass needs the map" "rc-detrend --lowpass 9um --memory 12M large.rcg -o no.rcg"
    refuses 1 'memory allows' "rc-detrend --plane of a pipe, too" "cat large.rcg | rc-detrend --plane --memory 12M -o no.rcg"
fi
