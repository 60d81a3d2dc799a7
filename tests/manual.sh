# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by the tests of the manual, after pipe.sh: functions that extract commands and outputs from a page,
# and words from --help.
pages=$RC_SOURCE/man
library_page=$(dirname "${RC_BIN-}")/man/libcontact.3 # made by the build

# head_program NAME: writes the example at the top of contact.h to NAME.
head_program() {
    sed -n '/^ \*     #include/,/^ \*     }$/s/^ \*\( \{5\}\)\{0,1\}//p' "$RC_SOURCE/libcontact/contact.h" >"$1" && grep -q '^main(' "$1"
}

# blocks PAGE SECTION FOLDER: writes the literal displays of a section, or of all sections with '', as files
# 1, 2, ... in FOLDER. After the comment "prints" a display is the output of the one before it: 1.prints;
# after the comment "not run: why" it is omitted. pipe_many_scans runs MANY SCANS, which '' leaves out.
blocks() {
    mkdir -p "$3"
    awk -v section="$2" -v folder="$3" '
        /^\.Sh / { inside = section == "" ? !/MANY SCANS/ : $0 == ".Sh " section; on = 0 }
        /^\.\\" / { mark = $2; next }
        inside && /^\.Bd -literal/ { on = mark != "not"; file = folder "/" (mark == "prints" ? n ".prints" : ++n) }
        /^\.Ed/ { on = 0 }
        /^\./ { mark = ""; next }
        on {
            sub(/^\\&/, "")
            gsub(/\\-/, "-")
            gsub(/\\\(aq/, "\047")
            gsub(/\\e/, "\\")
            print > file
        }' "$1"
}

# program PAGE NAME [WORD]: writes the first C program of a page, or the first one with this word, to NAME.
program() {
    local block
    blocks "$1" EXAMPLES "$2.blocks"
    for block in "$2.blocks"/*; do
        if grep -q '^main(' "$block" && grep -q "${3-}" "$block"; then
            cp "$block" "$2"
            return
        fi
    done
    echo "$1: no program in EXAMPLES" >&2
    return 1
}

# pictures PAGE: prints the files of its pictures.
pictures() {
    sed -n 's/^\.Lk \([^ ]*\.png\) .*/\1/p' "$1"
}

# ---- options and their help texts, in --help and in a page ----

help_options() {
    "$1" --help | grep -oE '^  --?[A-Za-z0-9-]+(, --[A-Za-z0-9-]+)*' | tr ',' '\n' | tr -d ' ' | sort
}

page_options() { # -h is another name of --help and is not listed
    awk '/^\.It Fl/ {
        for (i = 3; i <= NF && $i !~ /^(Ar|Cm|Ns|Op|Oo)$/; i++)
            if ($i != "," && $i != "|" && $i != "h" && $i != "Fl") print "-" $i
    }' "$1" | sort
}

# Prints the words that an option takes: "--method auto|pcg|pk99", or "..., of pcg,pk99 (default".
help_words() {
    "$1" --help | awk '
        /^  --/ { name = $1; sub(/,$/, "", name) }
        /^[^ ]/ { name = "" }
        name != "" {
            for (i = 1; i <= NF; i++) {
                if ($i ~ /^[a-z0-9]+([|][a-z0-9]+)+$/) n = split($i, word, "|")
                else if ($(i - 1) == "of" && $i ~ /^[a-z0-9-]+(,[a-z0-9-]+)+$/) n = split($i, word, ",")
                else continue
                for (k = 1; k <= n; k++) print name, word[k]
            }
        }' | sort -u
}

# Prints the words that the manual gives for the same options, and all other marked words of their paragraphs.
page_words() {
    awk '
        /^\.It/ || /^\.E[ld]/ || /^\.S[hs]/ { name = "" }
        /^\.It Fl -/ { name = "-" $3; start = 4 }
        name != "" && (/^\.It Fl/ || /^\.Cm/) {
            for (i = 2; i <= NF; i++) if ($i ~ /^[a-z0-9]+(-[a-z0-9]+)*$/) print name, $i
        }' "$1" | sort -u
}
