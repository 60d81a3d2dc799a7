# SPDX-License-Identifier: GPL-3.0-or-later
# A gzip file of any format is unpacked while it is read, and a decompression bomb takes no memory.
. "$(dirname "$0")/../pipe.sh"

printf '# Channel: Topo\n# Width: 6 um\n# Height: 5 um\n# Value units: nm\n1 2 3\n4 5 NaN\n' >map.txt
rc-synth sphere --nx 33 --ny 47 --dx 1.1um --dy 1um --radius 1mm -o ball.rcg

# same_as PLAIN PACKED: both give the same stream except for the name of the source.
same_as() {
    rc-import --dx 1um --z-unit nm --quiet "$1" | sed 's/^source=.*//; s/crc32 [0-9a-f]*$//' >plain.out &&
        rc-import --dx 1um --z-unit nm --quiet "$2" | sed 's/^source=.*//; s/crc32 [0-9a-f]*$//' >packed.out &&
        grep -aq '^channel=height' plain.out && cmp plain.out packed.out
}

for format in x3p sdf gsf npy sur gwy h5 xyz; do
    rc-export -o "ball.$format" ball.rcg
    gzip -k "ball.$format"
    claim "$format: the compressed file gives the same frame as the plain one" same_as "ball.$format" "ball.$format.gz"
done
gzip -k map.txt
claim "compressed text too" same_as map.txt map.txt.gz
claim "  with its numbers" bash -c '
    rc-import --quiet map.txt.gz | rc-export --format csv | grep -v "^#" | tr , "\n" |
        awk "{ d = \$1 * 1e9 - NR } NR < 6 && d * d > 1e-24 { bad = 1 } END { exit bad || NR != 6 || tolower(\$1) != \"nan\" }"'
claim "standard input too" bash -c 'rc-import - <map.txt.gz | cmp - <(rc-import - <map.txt)'
claim "the source is the name of the compressed file" says '^source=map.txt.gz$' rc-import map.txt.gz
claim "the suffix is not needed" bash -c 'cp map.txt.gz packed && rc-import packed | grep -a ^nx=3'
claim "--list names the file and its format" says '^map.txt.gz: ascii$' rc-import --list map.txt.gz

# two columns are a profile or a list of points only by the name of the file
printf '0 0 1\n1 0 2\n2 0 3\n' >line.xyz
gzip -k line.xyz
cp line.xyz.gz line.gz
claim "the suffix before .gz selects the format" says 'line.xyz.gz: xyz$' rc-import --list line.xyz.gz
claim "without it the content does" bash -c '! rc-import --list line.gz 2>&1 | grep ": xyz$"'

# ---- members, padding, damage ----

(head -n 4 map.txt | gzip; tail -n 2 map.txt | gzip) >members.txt.gz
claim "several members form one file" same_as map.txt members.txt.gz
(gzip -c map.txt; head -c 700 /dev/zero) >padded.txt.gz
claim "zeros after the last member are ignored" same_as map.txt padded.txt.gz
(gzip -c map.txt; printf 'more') >more.txt.gz
refuses 1 "more.txt.gz: after its gzip data the file has 4 further bytes that are not gzip data" "other bytes are" 'rc-import more.txt.gz'
size=$(wc -c <ball.sdf.gz)
for n in 2 3 9 10 11 100 $((size / 2)) $((size - 9)) $((size - 8)) $((size - 1)); do
    head -c "$n" ball.sdf.gz >cut.sdf.gz
    refuses 1 "cut.sdf.gz: its gzip data are cut short" "cut after $n of $size bytes" 'rc-import cut.sdf.gz'
done
perl -e 'local $/; $_ = <>; substr($_, length() / 2, 1) ^= "\x10"; print' ball.sdf.gz >damaged.sdf.gz
refuses 1 "damaged.sdf.gz: its gzip data are (damaged after [0-9]+ unpacked bytes|cut short)" "damage inside" \
    'rc-import damaged.sdf.gz'
perl -e 'local $/; $_ = <>; substr($_, -8, 1) ^= "\x10"; print' ball.sdf.gz >sum.sdf.gz
refuses 1 "sum.sdf.gz: its gzip data are damaged after [0-9]+ unpacked bytes \(incorrect data check\)" \
    "a checksum that is not that of the bytes" 'rc-import sum.sdf.gz'
refuses 1 "packed with gzip twice: unpack it once" "packed twice" 'gzip -c map.txt.gz | rc-import -'
refuses 1 "the file is empty" "nothing, packed" 'gzip -c </dev/null | rc-import -'
refuses 1 "it is a grid stream already" "a packed stream" 'gzip -c ball.rcg | rc-import -'

# ---- bombs ----

head -c 128M /dev/zero | gzip -1 >bomb.gz
refuses 1 "bomb.gz: its [0-9]+ bytes of gzip data unpack to more than 7[0-9] MiB, the limit for a file of this size: --memory LIMIT" \
    "a bomb is refused (tests/formats/format_gzip.c measures the memory)" 'rc-import bomb.gz'
refuses 1 "bomb.gz: its [0-9]+ bytes of gzip data unpack to more than [123]?[0-9] MiB" "by --memory too" \
    'rc-import --memory 40M bomb.gz'
refuses 1 "bomb.gz: not recognised" "--memory may also allow it" 'rc-import --memory 200M bomb.gz'
