# SPDX-License-Identifier: GPL-3.0-or-later
# bash, zsh and fish complete the options and words of --help and of the manual. These are every option of
# every tool and every word that an option takes. They also complete units after a number, files, and the
# channels of the file on the line.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"
completions=$RC_BIN/completions
mkdir empty streams

tools=
for source in $(tool_sources); do
    tools="$tools $(basename "$source" .c)"
done

# ---- completions of each shell ----

# in_bash TOOL WORD...: prints the completions of bash for the last word of this line, which may be empty.
in_bash() {
    bash -c '. "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); "_${1//-/_}"
        [ ${#COMPREPLY[@]} = 0 ] || printf "%s\n" "${COMPREPLY[@]}"' "$completions/bash/$1" "$@"
}
# options_in_SHELL TOOL, words_in_SHELL TOOL: "--option", "--option word".
options_in_bash() { in_bash "$1" - | sort; }
# One shell completes after all options of a tool.
words_in_bash() {
    options_in_bash "$1" | (cd empty && bash -c '. "$0"
        offered() {
            COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
            "_${1//-/_}"
            [ ${#COMPREPLY[@]} = 0 ] || printf "%s\n" "${COMPREPLY[@]}"
        }
        operands=$(offered "$1" "")
        while read -r option; do
            words=$(offered "$1" "$option" "")
            # an operand may follow an option without a value
            [ -z "$words" ] || [ "$words" = "$operands" ] || printf -- "$option %s\n" $words
        done' "$completions/bash/$1" "$1")
}

# zsh and fish, from the content of their files.
options_in_zsh() { sed -n "s/^    '\*\(--*[A-Za-z0-9-]*\)[+=]*\[.*/\1/p" "$completions/zsh/_$1" | sort; }
words_in_zsh() {
    sed -n "s/^    '\*\(--*[A-Za-z0-9-]*\)[+=]*\[.*\]:[^:]*:\(.*\)'\$/\1 \2/p" "$completions/zsh/_$1" |
        sed -n -e 's/ (\(.*\))$/ \1/p' -e 's/ _sequence compadd - / /p' -e 's/  _[a-z_]* "\(.*\)".*/ \1/p' |
        one_a_line
}
options_in_fish() {
    sed -n "s/^complete -c $1 -\([sl] [^ ]*\( -l [^ ]*\)*\).*/\1/p" "$completions/fish/$1.fish" |
        awk '{ for (i = 1; i < NF; i += 2) print ($i ~ /s$/ ? "-" : "--") $(i + 1) }' | sort
}
words_in_fish() {
    awk -v tool="$1" '$3 == tool && ($4 == "-l" || $4 == "-s") {
        name = ($4 == "-s" ? "-" : "--") $5; alias = $6 == "-l" ? "--" $7 : ""
        if (!match($0, / -a \047[^\047]*\047/)) next
        text = substr($0, RSTART + 5, RLENGTH - 6)
        gsub(/\(__fish_append ,|\(__[a-z_]*_number[^)]*\)|\(__[a-z_]*_channels\)|\)/, "", text)
        print name, text; if (alias != "") print alias, text }' "$completions/fish/$1.fish" | one_a_line
}
one_a_line() { awk '{ for (i = 2; i <= NF; i++) print $1, $i }'; }

# ---- comparison with --help and the manual ----

same_options() {
    help_options "$1" >help.txt && "options_in_$2" "$1" >there.txt && diff help.txt there.txt >&2
}

# The words of --format are in a separate table of the tool.
format_words() {
    if says "^--formats\$" help_options "$1"; then
        "$1" --formats | awk 'NR > 1 || !/^(name|format)/ { print "--format", $1 }'
    fi
}
# So are the materials.
material_words() {
    if says "^--materials\$" help_options "$1"; then
        rc-solve --materials | awk 'NR > 1 { sub(/[ |].*/, ""); print "--body1", $1; print "--body2", $1 }'
    fi
}
# The words of --help are completed, and completed words are in the manual.
same_words() {
    "words_in_$2" "$1" | sort -u >there.txt
    help_words "$1" | comm -23 - there.txt >missing.txt
    { page_words "$pages/$1.1" && format_words "$1" && material_words "$1"; } | sort -u >known.txt
    # the second name of an option takes the same words
    "$1" --help | sed -n 's/^  \(--[A-Za-z0-9-]*\), \(--[A-Za-z0-9-]*\).*/\2 \1/p' >alias.txt
    awk 'FILENAME == "alias.txt" { of[$1] = $2; next } { print ($1 in of ? of[$1] : $1), $2 }' alias.txt there.txt |
        sort -u | comm -23 - known.txt >>missing.txt
    cat missing.txt >&2
    [ ! -s missing.txt ]
}

for tool in $tools; do
    for shell in bash zsh fish; do
        claim "$tool, $shell: the options are exactly those of --help" same_options "$tool" "$shell"
        claim "$tool, $shell: the words are those of --help, and the manual has all of them" same_words "$tool" "$shell"
    done
done
words_in_bash rc-solve | sort >words.txt
for shell in zsh fish; do
    words_in_$shell rc-solve | sort >"words.$shell"
    claim "rc-solve: $shell completes the same words as bash" cmp words.txt words.$shell
done
for word in '--E2 rigid' '--engine mlms' '--kernel mlms' '--method pcg' '--output gap' '--type f32'; do
    claim "  $word is a completion" grep -qxe "$word" words.txt
done
rc-import --formats >formats.txt
claim "rc-import: --format has every format" test \
    "$(words_in_bash rc-import | grep -c '^--format ')" -ge "$(($(grep -c . formats.txt) - 2))"

# ---- at work ----

cd streams || exit 1
rc-synth sphere --nx 9 --dx 1um --radius 1mm -o 'one ball.rcg'
rc-solve --quiet --load 1 --estar 1GPa -o two.rcg 'one ball.rcg'
cd ..

# at_work SHELL: makes the claims `offers "LINE" WORD...` for this shell; complete_SHELL prints its
# completions.
offers() {
    local line=$1 words=$2
    (cd streams && "complete_$shell" "$line") | sort | tr '\n' ' ' >offered.txt
    cat offered.txt >&2
    [ "$(cat offered.txt)" = "$words" ]
}
at_work() {
    shell=$1
    claim "$shell: words of an option are completed" offers 'rc-solve --method p' 'pcg pk99 '
    claim "$shell:   for the other name of the option too" offers 'rc-solve --engine m' 'mlms '
    claim "$shell:   after a comma too" offers 'rc-solve --output gap,pr' 'gap,pressure '
    claim "$shell: a word that replaces a number is completed" offers 'rc-solve --E2 r' 'rigid '
    claim "$shell: units are completed after a number" offers 'rc-solve --load 1.5' '1.5N 1.5kN 1.5mN '
    claim "$shell:   without a number there are none" offers 'rc-solve --tol ' ''
    claim "$shell: shapes are completed" offers 'rc-synth se' 'selfaffine '
    claim "$shell: options are completed" offers 'rc-solve --mean' '--mean-pressure '
    claim "$shell: files are completed for options with a file" offers 'rc-synth --like tw' 'two.rcg '
    claim "$shell:   and for operands" offers 'rc-solve tw' 'two.rcg '
    claim "$shell: channels of the named stream are completed" offers 'rc-pick two.rcg --channel ' 'displacement gap height pressure '
}

complete_bash() { # shellcheck disable=SC2086
    case $1 in
    *' ') in_bash $1 '' ;;
    *) in_bash $1 ;;
    esac
}
at_work bash
claim "bash:   words after an equals sign are completed" test "$(in_bash rc-solve --method = pk)" = pk99
claim "bash:   words at the equals sign are completed" test "$(in_bash rc-solve --method = | wc -l)" = 3
claim "bash: units after a colon are completed" test "$(in_bash rc-stress --depths 0 : 20 | head -n 1)" = 20nm
claim "bash:   no unit directly at the colon" test -z "$(in_bash rc-stress --depths 0 : | grep -v auto)"
claim "bash: file names with blanks are completed" test "$(cd streams && in_bash rc-info one)" = 'one ball.rcg'

if command -v fish >/dev/null; then
    complete_fish() {
        fish --no-config -c 'source $argv[1]; complete -C $argv[2]' "$completions/fish/${1%% *}.fish" "$1" | cut -f 1
    }
    at_work fish
else
    untried "fish at work, which is not here"
fi

if command -v zsh >/dev/null; then
    # A shell on a pseudo-terminal, which records its completions.
    mkdir zsh
    cat >zsh/.zshrc <<'END'
PROMPT= RPS1=
fpath=($FOLDER $fpath)
autoload -Uz compinit
compinit -u -D
bindkey '^I' complete-word
noted() { print -r -- "end of what is offered" >>$OFFERED }
comppostfuncs=(noted)
compadd() {
    local -a found
    if [[ "${@[1,(i)(-|--)]}" != *-[OAD]\ * ]]; then
        builtin compadd -A found "$@"
        (( $#found )) && print -rl -- $IPREFIX$^found >>$OFFERED
    fi
    builtin compadd "$@"
}
print -r -- "ready" >>$OFFERED
END
    cat >typed.zsh <<'END'
zmodload zsh/zpty zsh/zselect
export FOLDER=$1 OFFERED=$3/offered ZDOTDIR=$3/zsh
rm -f $OFFERED
zpty -b z zsh -i
wait_for() {
    repeat 200; do
        grep -qs $1 $OFFERED && return
        zpty -r -t z shown
        zselect -t 5
    done
    print -r -- "no $1 in 10 s" >&2
    exit 1
}
wait_for ready
zselect -t 20
zpty -w -n z "$2"$'\t'
wait_for end
grep -v -e '^ready$' -e '^end of' $OFFERED
END
    complete_zsh() { zsh -f "$scratch/typed.zsh" "$completions/zsh" "$1" "$scratch"; }
    at_work zsh
    for tool in $tools; do
        claim "zsh: zsh accepts the file of $tool" zsh -n "$completions/zsh/_$tool"
    done
else
    untried "zsh at work, which is not here"
fi

refuses 2 'unknown option --completions' "another shell is none" 'rc-solve --completions csh'
