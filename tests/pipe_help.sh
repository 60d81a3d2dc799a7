# The manual says what the tools do: every option of --help and no other, clean mdoc, no reference
# into the void, and examples that run as they are printed.
. "$(dirname "$0")/pipe.sh"
. "$RC_SOURCE/tests/manual.sh"

tools=
for source in "$RC_SOURCE"/tools/rc-*.c; do
    tools="$tools $(basename "$source" .c)"
done

# ---- options ----

help_options() {
    "$1" --help | grep -oE '^  --?[A-Za-z0-9-]+' | tr -d ' ' | sort
}

page_options() { # -h stands beside --help and is not listed
    awk '/^\.It Fl/ {
        for (i = 3; i <= NF && $i !~ /^(Ar|Cm|Ns|Op|Oo)$/; i++)
            if ($i != "," && $i != "|" && $i != "h" && $i != "Fl") print "-" $i
    }' "$1" | sort
}

same_options() {
    help_options "$1" >help.txt && page_options "$pages/$1.1" >page.txt &&
        diff help.txt page.txt >&2
}

for tool in $tools; do
    claim "$tool: the manual has the options of --help and no other" same_options "$tool"
done

# ---- pages ----

has_sections() {
    local page=$1
    shift
    for section in "$@"; do
        grep -q "^\.Sh $section$" "$page" || {
            echo "$page: no section $section" >&2
            return 1
        }
    done
}

references_exist() {
    awk '/^\.Xr (rc-|rcg|contact|libcontact)/ { print $2 "." $3 }' "$1" | sort -u |
        while read -r page; do
            [ -f "$pages/$page" ] || {
                echo "$1: refers to $page, which does not exist" >&2
                exit 1
            }
        done
}

for page in "$pages"/*.[1-9]; do
    name=$(basename "$page")
    case $name in
    *.7) claim "$name: NAME, EXAMPLES" has_sections "$page" NAME EXAMPLES ;;
    *) claim "$name: NAME, SYNOPSIS, EXAMPLES" has_sections "$page" NAME SYNOPSIS EXAMPLES ;;
    esac
    claim "$name: its references lead to pages" references_exist "$page"
    if command -v mandoc >/dev/null; then
        claim "$name: mandoc finds no fault" bash -c "mandoc -Tlint -Wwarning '$page' >&2"
    fi
done
if ! command -v mandoc >/dev/null; then
    echo "NOT OK: not checked: mandoc is missing"
    claims=$((claims + 1))
    failures=$((failures + 1))
fi

# ---- examples ----

# The files that examples name, in a folder of their own.
prepare() {
    mkdir "$1" && cd "$1" || return
    rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 20nm --rolloff 30um \
        --short-cut 5um --seed 3 -o surface.rcg
    rc-solve --quiet --radius 2mm --load 1N --estar 114GPa --hardness 6GPa surface.rcg -o result.rcg
    cp surface.rcg flat.rcg
    cp "$RC_SOURCE/sample_surfaces/rough-steel.x3p" surface.x3p
    cp surface.x3p bench.x3p
    printf '0 1 0\n1 3 1\n0 1 0\n' >heights.txt
    cd ..
}

run_in() {
    (cd "$1" && bash -e -u -o pipefail "$2" </dev/null)
}

for page in "$pages"/*.[157]; do
    name=$(basename "$page")
    blocks "$page" EXAMPLES "$scratch/$name.blocks"
    prepare "$scratch/$name.run"
    for block in "$scratch/$name.blocks"/*; do
        grep -q '^main(' "$block" && continue
        claim "$name: example $(basename "$block") runs" run_in "$name.run" "$block"
    done
done
for tool in $tools; do
    "$tool" --help | sed -n '/^Examples:/,/^$/s/^  //p' >"$scratch/$tool.help"
    prepare "$scratch/$tool.help.run"
    claim "$tool: the examples of --help run" run_in "$tool.help.run" "$scratch/$tool.help"
done

finish
