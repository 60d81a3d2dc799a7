# SPDX-License-Identifier: GPL-3.0-or-later
# libcontact(3), which man/library.awk makes from the headers, has every function with its arguments, every struct with
# its fields, every constant with its value, and every comment. Every function has a description. Members of structs are
# declared in one line each, with comments either above all of them or at the ends of lines.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/symbols.sh"

page=$library_page

# Prints the declarations in preprocessed C from standard input. The lines are "function TYPE
# NAME(ARGUMENTS)", "object TYPE NAME", "struct NAME: FIELD" for each field, and "constant ENUM PLACE: NAME =
# VALUE". Only names that begin with rc_ or RC_ are printed.
cat >declarations.pl <<'END'
my $round;
$round = qr/\((?:[^()]++|(??{ $round }))*\)/;
sub plain { # one blank where one is needed
    my $text = join " ", split " ", $_[0];
    $text =~ s/ ?([*(),\[\]]) ?/$1/g;
    $text =~ s/(\w)\*/$1 */g;
    $text =~ s/\*const/* const/g;
    return $text;
}
undef $/;
$_ = <STDIN>;
s/__attribute__\s*$round//g;
s/extern\s+"C"\s*\{//g;
s/\bstatic\s+inline\b([^(;]*$round)\s*\{[^{}]*\}/$1;/g;
while (/\benum\s*(\w*)\s*\{([^{}]*)\}/g) {
    my ($name, $place) = ($1, 0);
    for (split /,/, $2) {
        print "constant $name ", $place++, ": ", plain($_), "\n" if /^\s*RC_/;
    }
}
while (/\bstruct\s+(rc_\w+)\s*\{([^{}]*)\}/g) {
    my ($name, $fields) = ($1, $2);
    for (split /;/, $fields) {
        my ($first, @more) = split /,/;
        next unless defined $first && $first =~ /^\s*(\S.*?)\s*(\**\s*\w+\s*(?:\[[^\]]*\])*)\s*$/s;
        print "struct $name: ", plain("$1 $_"), "\n" for $2, @more;
    }
}
s/\{[^{}]*\}//g while /\{[^{}]*\}/;
for (split /;/) {
    next if /\btypedef\b/;
    if (/^([^(]*?\brc_\w+)\s*($round)\s*$/s) { print "function ", plain("$1$2"), "\n" }
    elsif (/\bextern\b[^(]*\brc_\w+/) { print "object ", plain($_), "\n" }
}
END
mkdir mpi # one type of MPI: the page is the same for a build without MPI
echo 'typedef struct mpi_comm *MPI_Comm;' >mpi/mpi.h
headers() { ${CC:-cc} -E -P -std=c17 -I "$RC_SOURCE" -I mpi "$1"; }
declarations() { headers "$1" | perl declarations.pl | sort -u; }

# page_code: prints the page as a header: its structs and constants, then a declaration of each .Ft with .Fn, or
# .Vt.
page_code() {
    printf '#include <std%s.h>\n' bool def int
    blocks "$page" "" described && awk 'FNR == 1 { code = /^(struct|enum)[^;=(]*\{/ } code' described/*
    perl -ne '
        next unless /^\.It (Ft|Vt) (.*)/;
        my ($kind, @word) = ("$1", map { s/^"|"$//gr } $2 =~ /"[^"]*"|\S+/g);
        if ($kind eq "Vt") { print "$word[0];\n"; next }
        print "$word[0] $word[2](", join(", ", @word[3 .. $#word]), ");\n"' "$page"
}

declarations "$RC_SOURCE/libcontact/contact_mpi.h" >headers.txt
page_code >page.h
declarations page.h >page.txt

# same_of KIND PAGE: the page has the declarations of the headers and no others.
same_of() {
    grep "^$1 " headers.txt >kind.headers && grep "^$1 " "$2" >kind.page && diff kind.headers kind.page >&2
}
claim "the page has the functions with their arguments" same_of function page.txt
claim "the objects" same_of object page.txt
claim "the structs with their fields" same_of struct page.txt
claim "the constants with their values" same_of constant page.txt
sed -n '/^static inline/,/^{/s/^\(rc_[a-z_]*\)(.*/\1/p' "$RC_SOURCE"/libcontact/{grid,surface,model,contact,contact_mpi}.h >inline.txt
seen() {
    headers "$RC_SOURCE/libcontact/contact_mpi.h" >all.h && declared all.h >declared.txt &&
        grep -qx rc_ranks_sent declared.txt && grep -qx rc_solver_new declared.txt && grep -qx rc_grid_new declared.txt &&
        sed -nE 's/^(function|object) [^(]*\b(rc_\w+).*/\2/p' headers.txt | grep -vxf inline.txt | sort | diff declared.txt - >&2
}
claim "  the check finds every declaration of the headers" seen
lacking() {
    sed "$1" page.h >without.h && ! cmp -s page.h without.h && declarations without.h >without.txt && ! same_of "$2" without.txt
}
claim "  the check finds a missing field" lacking 's/double mu;//' struct
claim "  a missing argument" lacking 's/double depth, //' function
claim "  a missing function of contact_mpi.h" lacking '/rc_ranks_rows(/d' function
claim "  a wrong value" lacking 's/RC_SHORT = 2/RC_SHORT = 3/' constant
claim "  a function that does not exist any more" lacking 's/double mu;/double mu, m;/' struct

# The descriptions.
bare_items() { awk '/^\.It (Ft|Vt)/ { item = $0; next } item != "" { if (/^\.(It|El)/) print item; item = "" }' "$page"; }
none() { "$@" >bare.txt && cat bare.txt >&2 && [ ! -s bare.txt ]; }
claim "each function has a description" none bare_items
sources=("$RC_SOURCE"/libcontact/{grid,surface,model,contact,contact_mpi}.h)
# lost PAGE: prints the comments of the headers that the page does not have, word for word.
lost() {
    perl -0777 -e '
        my $page = shift;
        open my $in, "<", $page or die; $_ = <$in>;
        s/^\.(?!Ss).*$//mg; s/\\f[IR]//g; s/\\&//g; s/\\\(aq/\x27/g; s/\\e/\\/g;
        (my $all = $_) =~ s/[^A-Za-z0-9]//g;
        for my $file (@ARGV) {
            open my $header, "<", $file or die; $_ = <$header>;
            while (m#/\*(.*?)\*/#sg) {
                my $text = $1;
                next if $text =~ /^ The names that the shared library offers|^ processes that share the map: contact\.h|^ NULL is|^ SPDX/;
                (my $bare = $text) =~ s/[^A-Za-z0-9]//g;
                print "$file: $text\n" if index(lc $all, lc $bare) < 0;
            }
        }' "$1" "${sources[@]}"
}
claim "the page has each comment of the headers" none lost "$page"
sed '/what the caller keeps/d; /is the one that stresses/d' "$page" >less.3
sees() { lost less.3 >less.txt && grep -q stresses less.txt; }
claim "  the check finds a missing line" sees

# broken FILE...: prints members that are not in one line, and structs with comments of both kinds.
broken() {
    perl -0777 -e '
        for my $file (@ARGV) {
            open my $in, "<", $file or die; $_ = <$in>;
            while (/^(struct|enum)\b([^;{}()]*)\{[^\n]*\n(.*?)^\}/msg) {
                my ($kind, $name, $body) = ($1, $2, $3);
                my $above = () = $body =~ m#^\s*/\*#mg;
                my $beside = () = $body =~ m#^\s*[a-zA-Z][^\n]*/\*#mg;
                print "$file: $kind$name: comments above and beside members\n" if $above && $beside;
                $body =~ s#/\*.*?\*/##sg;
                for (split /\n/, $body) {
                    next if /^\s*$/ || /;\s*$/ || $kind eq "enum" && /^\s*\w+( = [^,]*)?,?\s*$/;
                    print "$file: $kind$name: $_\n";
                }
            }
        }' "$@"
}
claim "each member is declared in one line, with comments of one kind" none broken "${sources[@]}"
printf 'struct rc_a {\n    double k\n        [2];\n};\nstruct rc_b {\n    /* m */\n    double x;\n    double y; /* m */\n};\n' >bad.h
sees() { broken bad.h >bad.txt && grep -q 'rc_a : *double k' bad.txt && grep -q 'rc_b : comments' bad.txt; }
claim "  the check finds both faults" sees

# The page is read in 80 columns, and has no fault of style.
wide() { mandoc -Tascii "$page" | col -bx | awk 'length > 80'; }
faults() { mandoc -Tlint -Wstyle "$page" | grep -v 'referenced manual not found'; true; }
claim "no line is wider than a terminal" none wide
claim "mandoc finds no fault, and none of style" none faults
# model.h names the tables of figures.
tables() { sed -n 's/^RC_FIGURES(\(.*\))/\1/p' "$RC_SOURCE/libcontact/model/figures.list" | sort; }
named() { sed -n '/The names are:/,/rc_figures(/p' "$RC_SOURCE/libcontact/model.h" | grep -v : | grep -o '\b[a-z]\+\b' | grep -vx 'const\|struct\|char\|name' | sort; }
claim "model.h names each table of figures.list" diff <(tables) <(named)
