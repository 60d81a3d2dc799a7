# SPDX-License-Identifier: GPL-3.0-or-later
# The manual agrees with the tools. It has every option of --help and no other, correct mdoc, references to
# existing pages only, and examples that run as printed.
. "$(dirname "$0")/../pipe.sh"
. "$RC_SOURCE/tests/manual.sh"

tools=
for source in $(tool_sources); do
    tools="$tools $(basename "$source" .c)"
done

# ---- options ----

same_options() {
    help_options "$1" >help.txt && page_options "$pages/$1.1" >page.txt &&
        diff help.txt page.txt >&2
}

same_words() {
    help_words "$1" >help.txt && page_words "$pages/$1.1" >page.txt && comm -23 help.txt page.txt >missing.txt
    cat missing.txt >&2
    [ ! -s missing.txt ]
}

takes_words() {
    help_words "$1" >help.txt && cut -d ' ' -f 1 help.txt | uniq | tr '\n' ' ' >taking.txt && cat taking.txt >&2 &&
        [ "$(cat taking.txt)" = "$2" ]
}

for tool in $tools; do
    claim "$tool: the manual has exactly the options of --help" same_options "$tool"
    claim "$tool: the manual has the words of its options" same_words "$tool"
done

# ---- the pages of effects ----

# Prints each option of rc-solve(1) whose paragraph refers to the page of an effect, and this page.
effect_options() {
    awk '/^\.(It|El|S[hs])/ { name = "" }
        /^\.It Fl/ { name = "-" $3 }
        name != "" && /^\.Xr contact-[a-z]+ 7/ { print name, $2 }' "$pages/rc-solve.1" | sort
}
same_effects() {
    for page in $effects; do
        page_options "$pages/$page.7" | sed "s/$/ $page/"
    done | sort >pages.txt
    effect_options | grep -v ' contact-theory$' >effects.txt
    [ -s effects.txt ] && diff effects.txt pages.txt >&2
}
effect_words() {
    page_options "$pages/$1.7" >options.txt
    help_words rc-solve | grep -wFf options.txt >help.txt
    page_words "$pages/$1.7" >page.txt
    [ -z "$(comm -23 help.txt page.txt | tee /dev/stderr)" ]
}
# A page names the options that its options need (one of several), and those with which they do not work.
effect_rules() {
    page_options "$pages/$1.7" >options.txt
    rc-solve --completions json | perl -MJSON::PP -e '
        my ($own, $page, $json) = map { local $/; open my $f, "<", $_; <$f> } @ARGV;
        my %own = map { s/^-+//r => 1 } split /\n/, $own;
        sub named { my ($n) = @_; $own{$n} || $page =~ /^\.(It )?Fl .*-\Q$n\E( |$)/m }
        sub lacks { print STDERR "--$_[0]: the page does not name --$_[1]\n"; $bad++ }
        for my $o (@{decode_json($json)->{options}}) {
            for my $rule (@{$o->{needs}}) {
                my @with = map { $_->{name} } @{$rule->{options}};
                lacks($o->{name}, join " or --", @with) if $own{$o->{name}} && !grep { named($_) } @with;
            }
            for my $rule (@{$o->{against}}) {
                for my $n (map { $_->{name} } @{$rule->{options}}) {
                    lacks($o->{name}, $n) if $own{$o->{name}} && !named($n);
                    lacks($n, $o->{name}) if $own{$n} && !named($o->{name});
                }
            }
        }
        exit($bad > 0)' options.txt "$pages/$1.7" /dev/stdin
}
effects=$(cd "$pages" && grep -l '^\.Sh OPTIONS' contact-*.7 | sed 's/\.7$//')
claim "rc-solve(1) refers from each option of an effect to the page that has it, and each page has no other option" same_effects
for page in $effects; do
    claim "$page(7) has the words of its options" effect_words "$page"
    claim "$page(7) has the rules of its options" effect_rules "$page"
done

claim "rc-solve: the options that take words are found in --help" takes_words rc-solve '--along --kernel --method --output --tilt --track --type '

# ---- two names ----

rc-synth sphere --nx 33 --dx 5um --radius 7.5mm -o ball.rcg
rc-solve --load 2N --estar 114GPa --quiet -o pressed.rcg ball.rcg
# same_by ENGINES COMMAND...: the command gives the same result with --engine as with --kernel, and another
# one by default.
same_by() {
    local engines=$1
    shift
    "$@" --kernel "$engines" >kernel.out && "$@" --engine "$engines" >engine.out && "$@" >default.out &&
        cmp kernel.out engine.out && ! cmp -s kernel.out default.out
}
claim "rc-solve: --engine is --kernel" same_by mlms rc-solve --load 2N --estar 114GPa --quiet ball.rcg
claim "rc-stress: --engine is --kernel" same_by mlms rc-stress --tol 1e-2 --nu 0.3 --depths 5um pressed.rcg
claim "rc-deflect: --engine is --kernel" same_by mlms rc-deflect --tol 1e-2 pressed.rcg
refuses 2 'must be one of auto\|fft\|fft64\|mlms\|direct' "an engine that is none, naming those there are" \
    "rc-solve --load 2N --estar 114GPa --engine fast ball.rcg"

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
            [ -f "$pages/$page" ] || [ -f "$pages/$page.in" ] || {
                echo "$1: refers to $page, which does not exist" >&2
                exit 1
            }
        done
}

refuses_lines() { ! grep -nE "$1" "$2" >&2; }
for page in "$pages"/*.[1-9] "$library_page"; do
    name=$(basename "$page")
    case $name in
    *.7) claim "$name: NAME, SEE ALSO" has_sections "$page" NAME "SEE ALSO" ;;
    *) claim "$name: NAME, SYNOPSIS, EXAMPLES" has_sections "$page" NAME SYNOPSIS EXAMPLES ;;
    esac
    claim "$name: its references lead to pages" references_exist "$page"
    # groff takes the word for a macro and ends the page there
    claim "$name: no title of a paper begins with the name of a macro" refuses_lines '^[.]%[A-Z] ([A-Z][a-z]) ' "$page"
    if command -v mandoc >/dev/null; then
        claim "$name: mandoc finds no fault" bash -c "mandoc -Tlint -Wwarning '$page' >&2"
    fi
done
for page in $effects; do
    claim "$page.7: the chapters of an effect" has_sections "$pages/$page.7" DESCRIPTION "THE REPORT" ACCURACY COST EXAMPLES LIMITS
done
# The overview describes each tool and each effect, and refers to its page.
overview() {
    for name in $(printf '%s.1 ' $tools) $(printf '%s.7 ' $effects); do
        for line in ".It Xr ${name%.*} ${name##*.}" ".Xr ${name%.*} ${name##*.}( ,)?"; do
            grep -qxE "$line" "$pages/contact.7" || {
                echo "contact.7: no line '$line'" >&2
                return 1
            }
        done
    done
}
claim "contact.7: it names each tool and each effect" overview
if ! command -v mandoc >/dev/null; then
    failed "the pages cannot be checked: mandoc is missing"
fi

# ---- examples ----

# sample NAME FILE WIDTH,HEIGHT: a sample surface, with every commit only a part of it.
sample() {
    if before_release; then
        cp "$RC_SOURCE/sample_surfaces/$1.x3p" "$2"
    else
        rc-import --quiet "$RC_SOURCE/sample_surfaces/$1.x3p" |
            rc-pick --crop 70,60,$3 |
            rc-export --format x3p -o "$2"
    fi
}

# The files of the examples; each page gets a copy of its own.
make_files() {
    mkdir "$1" && cd "$1" || return
    rc-synth selfaffine --nx 64 --dx 1um --hurst 0.8 --rms-height 20nm --rolloff 30um \
        --short-cut 5um --seed 3 -o surface.rcg
    rc-solve --quiet --radius 2mm --load 1N --estar 114GPa --hardness 6GPa surface.rcg -o result.rcg
    cp surface.rcg flat.rcg
    cp surface.rcg new.rcg
    cp surface.rcg worn.rcg
    sample rough-steel surface.x3p 96,96
    sample rough-sphere rough-sphere.x3p 242,206
    cp surface.x3p bench.x3p
    printf '0 1 0\n1 3 1\n0 1 0\n' >heights.txt
    cd ..
}
claim "the files of the examples can be made" make_files "$scratch/files"

run_in() {
    (cd "$1" && bash -e -u -o pipefail "$2" </dev/null)
}

# pipe_tutorial runs the examples of contact(7), the tutorial.
for page in "$pages"/*.[15] $(printf "$pages/%s.7 " contact-mpi $effects); do
    name=$(basename "$page")
    blocks "$page" EXAMPLES "$scratch/$name.blocks"
    cp -r "$scratch/files" "$scratch/$name.run"
    for block in $(find "$scratch/$name.blocks" -type f | sort -V); do
        grep -q '^main(' "$block" && continue
        # many solutions each; those of 400 x 400 nodes run as printed in pipe_coated_case
        ! before_release && grep -q 'rc-cost\|--yield\|selfaffine --nx 400' "$block" && continue
        claim "$name: example $(basename "$block") runs" run_in "$name.run" "$block"
    done
done
for tool in $tools; do
    # those of rc-report's page, with other names of files; many solutions each
    ! before_release && [[ $tool = rc-report || $tool = rc-cost ]] && continue
    "$tool" --help | sed -n '/^Examples:/,/^$/s/^  //p' >"$scratch/$tool.help"
    cp -r "$scratch/files" "$scratch/$tool.help.run"
    claim "$tool: the examples of --help run" run_in "$tool.help.run" "$scratch/$tool.help"
done
