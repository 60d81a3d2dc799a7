# The manual of every tool knows just the options that its --help knows, and its examples run.
. "$(dirname "$0")/pipe.sh"
# With the leak sanitizer: fontconfig keeps what it has read of the fonts.
echo 'leak:libfontconfig' >leaks
export LSAN_OPTIONS=suppressions=$PWD/leaks:print_suppressions=0

helped() {
    "$1" --help | grep -oE '^  --?[A-Za-z0-9-]+' | tr -d ' ' | sed 's/^-*//' | sort -u
}

# Options stand as ".It Fl -name Ar WHAT" in the manual, or several with " , " between.
manual() {
    sed -n 's/^\.It Fl //p' "$1" | sed 's/ , /\n/g' | sed 's/^Fl //' | grep -E '^(-|o )' |
        sed 's/^-*//; s/ .*//' | sort -u
}

# The literal blocks of the section EXAMPLES, as they are typed.
examples() {
    awk '/^\.Sh/ { on = /EXAMPLES/ } !on { next }
         /^\.Ed/ { print ""; inside = 0 } inside { gsub(/\\e/, "\\"); print }
         /^\.Bd/ { inside = 1 }' "$1"
}

same_options() {
    helped "$1" >helped.txt
    manual "$2" >manual.txt
    diff helped.txt manual.txt >&2
}

run_examples() {
    examples "$1" >example.sh
    [ -s example.sh ] && bash -o pipefail -e example.sh
}

for page in "$RC_SOURCE"/man/rc-*.1; do
    tool=$(basename "$page" .1)
    [ -x "$RC_BIN/$tool" ] || continue
    claim "$tool: the manual and --help have the same options" same_options "$tool" "$page"
    claim "$tool: the examples of the manual run" run_examples "$page"
    if command -v mandoc >/dev/null; then
        claim "$tool: the manual is good mdoc" mandoc -Tlint -Wwarning "$page"
    fi
done

finish
