# libcontact(3) has the declarations of contact.h, contact_mpi.h and grid.h. It has every function with its
# arguments, every struct with its fields, and every constant with its value, and it describes each of them.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
. "$RC_SOURCE/tests/symbols.sh"

page=$pages/libcontact.3

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

# page_code: prints the page as a header: its displays before EXAMPLES, then a declaration of each .Ft with
# .Fn, or .Vt.
page_code() {
    printf '#include <std%s.h>\n' bool def int
    blocks "$page" DESCRIPTION described && cat described/*
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
seen() {
    headers "$RC_SOURCE/libcontact/contact_mpi.h" >all.h && declared all.h >declared.txt &&
        grep -qx rc_ranks_sent declared.txt && grep -qx rc_solver_new declared.txt && grep -qx rc_grid_new declared.txt &&
        sed -nE 's/^(function|object) [^(]*\b(rc_\w+).*/\2/p' headers.txt | sort | diff declared.txt - >&2
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
bare_fields() {
    awk '/^struct .*\{/ { inside = 1; next } /^\}/ { inside = 0 } inside && /^    [a-z].*;/ && !/;.*\/\*/' described/*
}
none() { "$1" >bare.txt && cat bare.txt >&2 && [ ! -s bare.txt ]; }
claim "each function has a line" none bare_items
claim "each field has its unit or meaning" none bare_fields
