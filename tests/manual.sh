# Sourced by the tests of the manual, after pipe.sh: what stands in a page is taken out of it.
pages=$RC_SOURCE/man

# blocks PAGE SECTION FOLDER: the literal displays of a section, as files 1, 2, ... in FOLDER.
blocks() {
    mkdir -p "$3"
    awk -v section="$2" -v folder="$3" '
        /^\.Sh / { inside = $0 == ".Sh " section; on = 0 }
        inside && /^\.Bd -literal/ { on = 1; file = folder "/" ++n; next }
        /^\.Ed/ { on = 0 }
        on {
            sub(/^\\&/, "")
            gsub(/\\-/, "-")
            gsub(/\\\(aq/, "\047")
            gsub(/\\e/, "\\")
            print > file
        }' "$1"
}

# program PAGE NAME: the C program that stands in a page, as NAME.
program() {
    local block
    blocks "$1" EXAMPLES "$2.blocks"
    for block in "$2.blocks"/*; do
        if grep -q '^main(' "$block"; then
            cp "$block" "$2"
            return
        fi
    done
    echo "$1: no program in EXAMPLES" >&2
    return 1
}
