# SPDX-License-Identifier: GPL-3.0-or-later
# The dependencies of the folders have one direction. From other folders a file includes only the public
# header of a lower folder; it calls no function of a higher folder. Solver, stress, surface and tools do not
# name an engine, no file outside libcontact/body names a row of its list, and no file of rc-solve names the effect
# of another one.
. "$(dirname "$0")/pipe.sh"
. "$RC_SOURCE/tests/symbols.sh"

# ---- rules ----

# Columns: a folder, or one of its files; then the headers that it may include beside those of its own folder.
# The last column has the folders whose functions and data it may use. X=rc_y_: from X only names that begin
# with rc_y_, the rows of a list. %base: shared by all folders of libcontact. %public: headers for other
# folders of the project. %physics: the folders that define them. %reader, %formats: the same for readers of
# files.
cat >arrows.txt <<'END'
libcontact          | -                                        | -
libcontact/model    | %base %ranks                             | libcontact libcontact/ranks libcontact/solver=rc_figures_
libcontact/model    |                                          | libcontact/solver=rc_model_ libcontact/adhesion=rc_figures_ libcontact/adhesion=rc_model_ libcontact/leak=rc_figures_ libcontact/yield=rc_figures_
libcontact/model    |                                          | libcontact/friction=rc_figures_ libcontact/friction=rc_model_ libcontact/rolling=rc_figures_ libcontact/rolling=rc_model_ libcontact/wear=rc_figures_ libcontact/wear=rc_model_ libcontact/travel=rc_figures_ libcontact/travel=rc_model_ libcontact/viscoelastic=rc_figures_ libcontact/viscoelastic=rc_model_ libcontact/stress=rc_figures_ libcontact/fatigue=rc_figures_ libcontact/heat=rc_figures_ libcontact/surface/parameters=rc_figures_ libcontact/features=rc_figures_
libcontact/ranks    | libcontact/common.h libcontact/contact_mpi.h libcontact/memory.h | libcontact
libcontact/transform | %base                                   | libcontact
libcontact/body     | %base %ranks                             | libcontact libcontact/ranks
libcontact/operator | %base %ranks                             | libcontact libcontact/ranks
libcontact/operator | libcontact/transform/transform.h libcontact/transform/fourier.h libcontact/body/body.h libcontact/body/line.h | libcontact/transform libcontact/body
libcontact/operator |                                          | libcontact/operator/real_space=rc_engine_
libcontact/operator/real_space | %base libcontact/operator/engine.h | libcontact libcontact/ranks libcontact/operator
libcontact/solver   | %base libcontact/operator/operator.h     | libcontact libcontact/ranks libcontact/operator libcontact/body
libcontact/solver   | libcontact/model/row.h                   | libcontact/model
libcontact/solver   | libcontact/pyramid/pyramid.h             | libcontact/pyramid
libcontact/pyramid  | %base libcontact/operator/operator.h     | libcontact libcontact/ranks
libcontact/stress   | %base libcontact/operator/operator.h     | libcontact libcontact/ranks libcontact/operator
libcontact/stress   | libcontact/body/line.h libcontact/operator/waves.h                  | libcontact/transform libcontact/body
libcontact/stress   | libcontact/volume/volume.h               | libcontact/volume
libcontact/fatigue  | %base %ranks                             | libcontact libcontact/ranks libcontact/stress libcontact/body
libcontact/heat     | %base libcontact/operator/operator.h     | libcontact libcontact/ranks libcontact/operator libcontact/transform libcontact/body libcontact/surface/parameters
libcontact/heat     | libcontact/body/quadrature.h libcontact/body/line.h| libcontact/body
libcontact/heat     | libcontact/pyramid/pyramid.h             | libcontact/pyramid
libcontact/volume   | %base libcontact/operator/operator.h     | libcontact libcontact/ranks libcontact/operator libcontact/transform
libcontact/yield    | libcontact/model/row.h                   | libcontact/model
libcontact/yield    | %base libcontact/volume/volume.h         | libcontact libcontact/ranks libcontact/volume libcontact/solver libcontact/stress
libcontact/adhesion | %base libcontact/operator/operator.h     | libcontact libcontact/ranks libcontact/operator libcontact/body
libcontact/adhesion | libcontact/model/row.h                   | libcontact/model libcontact/solver=rc_figures_
libcontact/leak     | %base %ranks                             | libcontact libcontact/ranks
libcontact/scene    | %base libcontact/adhesion/adhesion.h     | %physics
libcontact/scene    | libcontact/transform/fourier.h           | libcontact/transform
libcontact/wear     | %base libcontact/model/row.h             | libcontact libcontact/ranks libcontact/model
libcontact/travel   | %base libcontact/model/row.h             | libcontact libcontact/ranks libcontact/model
libcontact/viscoelastic | %base libcontact/model/row.h             | libcontact libcontact/ranks libcontact/model
libcontact/viscoelastic | libcontact/solver/elastic.h libcontact/transform/fourier.h | libcontact/solver libcontact/operator libcontact/transform
libcontact/viscoelastic | libcontact/operator/operator.h libcontact/operator/waves.h libcontact/body/body.h libcontact/body/quadrature.h | libcontact/body
libcontact/friction | %base libcontact/operator/operator.h     | libcontact libcontact/ranks libcontact/operator libcontact/transform libcontact/body
libcontact/friction | libcontact/pyramid/pyramid.h libcontact/model/row.h | libcontact/pyramid libcontact/model libcontact/solver=rc_contact_apart
libcontact/rolling  | %base libcontact/friction/friction.h     | libcontact libcontact/ranks libcontact/friction
libcontact/rolling  | libcontact/friction/discs.h libcontact/model/row.h | libcontact/model libcontact/operator libcontact/body
libcontact/features | %base                                   | libcontact
libcontact/surface  | %base %ranks                             | libcontact libcontact/ranks
libcontact/surface  | libcontact/transform/transform.h libcontact/surface/parameters/measure.h | libcontact/transform libcontact/surface/parameters
libcontact/surface/parameters | %base %ranks                  | libcontact libcontact/ranks
libcontact/surface/parameters | libcontact/transform/transform.h | libcontact/transform
formats/core        | libcontact/grid.h                        | libcontact
formats/rcg         | libcontact/grid.h formats/core/core.h    | libcontact formats/core
formats/sandbox     | libcontact/grid.h formats/core/core.h formats/rcg/rcg.h | libcontact formats/core formats/rcg
formats/containers/packing | libcontact/grid.h formats/core/core.h | libcontact formats/core
formats/containers  | libcontact/grid.h formats/core/core.h    | libcontact formats/core
formats/containers  | formats/containers/packing/packing.h     | -
formats/readers/probes | %reader                               | %formats
formats/readers/profilers | %reader                            | %formats
formats/readers/exchange | %reader                             | %formats
formats/readers/exchange/x3p | %reader                         | %formats
formats/readers/exchange/xlsx | %reader                        | %formats
formats/readers/text | %reader                                 | %formats
formats/writers     | libcontact/grid.h formats/core/core.h    | libcontact formats/core
formats/writers     | formats/containers/containers.h formats/containers/hdf_id.h | formats/containers
formats/writers     | formats/export.h                         | formats
formats             | libcontact/grid.h formats/core/core.h formats/sandbox/sandbox.h | libcontact formats/core formats/sandbox
formats             |                                          | formats/readers/probes=rc_format_
formats             |                                          | formats/readers/profilers=rc_format_
formats             |                                          | formats/readers/exchange=rc_format_
formats             |                                          | formats/readers/exchange/x3p=rc_format_
formats             |                                          | formats/readers/exchange/xlsx=rc_format_
formats             |                                          | formats/readers/text=rc_format_
formats             |                                          | formats/writers=rc_export_
tools/text          | libcontact/grid.h formats/core/core.h    | libcontact formats/core
tools/machine       | -                                        | libcontact=rc_
tools/cli           | tools/text/text.h tools/machine/machine.h | tools/text tools/machine
tools/cli           | %public formats/rcg/rcg.h                | %physics formats/rcg
tools/cli           | formats/core/core.h                      | formats/core
tools/cli           | libcontact/contact_mpi.h                 | libcontact/ranks
tools/frames        | %public tools/cli/cli.h tools/text/text.h | %physics %cli
tools/frames        | formats/core/core.h                      | formats/core
tools/problem       | %public tools/cli/cli.h                  | %physics %cli
tools/problem       | tools/frames/frames.h                    | tools/frames
tools/materials     | tools/cli/cli.h                          | libcontact %cli
tools/journal       | tools/cli/cli.h                          | libcontact formats/rcg %cli
tools/model         | %public tools/cli/cli.h                  | %physics %cli
tools/model         | tools/frames/frames.h                    | tools/frames
tools/model         | formats/core/core.h tools/journal/journal.h | formats/core formats/rcg tools/journal
tools/canvas        | libcontact/grid.h formats/core/core.h    | libcontact formats/core
tools/plot          | libcontact/grid.h formats/core/core.h    | libcontact formats/core
tools/plot          | tools/canvas/canvas.h                    | tools/canvas
tools/cost          | %public tools/cli/cli.h tools/plot/plot.h | %physics %cli %plot
tools/cost          | formats/rcg/rcg.h                        | formats/rcg
tools/scan          | %public tools/cli/cli.h tools/cost/cost.h tools/plot/plot.h | %physics %cli tools/cost %plot
tools/scan          | formats/rcg/rcg.h                        | formats/rcg
tools/solve         | %public tools/cli/cli.h tools/plot/plot.h | %physics %cli %plot
tools/solve         | tools/frames/frames.h tools/materials/materials.h | tools/frames tools/materials
tools/solve         | formats/core/core.h                      | formats/core formats/rcg
tools/solve         | tools/model/model.h tools/problem/problem.h | tools/model tools/problem
tools/slip          | %public tools/cli/cli.h                  | %physics %cli
tools/slip          | tools/frames/frames.h                    | tools/frames
tools/slip          | tools/model/model.h tools/problem/problem.h | tools/model tools/problem
tools/slip          | formats/core/core.h                      | formats/core formats/rcg
tools/import        | libcontact/grid.h tools/cli/cli.h        | libcontact %cli
tools/import        | formats/core/core.h formats/format.h     | formats formats/core
tools/stress        | %public tools/cli/cli.h                  | %physics %cli
tools/stress        | tools/frames/frames.h                    | tools/frames
tools/fatigue       | %public tools/cli/cli.h                  | %physics %cli formats/rcg
tools/leak          | %public tools/cli/cli.h                  | %physics %cli
tools/scene         | %public tools/cli/cli.h                  | %physics %cli
tools/report        | %public tools/cli/cli.h tools/scene/scene.h | %physics %cli tools/scene
tools/report        | tools/problem/problem.h formats/core/core.h | tools/problem formats/core formats/rcg
tools/pick          | %public tools/cli/cli.h                  | %physics %cli
tools/pick          | tools/frames/frames.h                    | tools/frames
tools/synth         | %public tools/cli/cli.h                  | %physics %cli
tools/info          | %public tools/cli/cli.h                  | %physics %cli formats/rcg
tools/info          | tools/frames/frames.h                    | tools/frames
tools/render        | libcontact/grid.h libcontact/model.h tools/cli/cli.h | libcontact libcontact/body libcontact/model %cli
tools/render        | tools/frames/frames.h                    | tools/frames
tools/render        | tools/plot/plot.h                        | %plot
tools               | %public tools/cli/cli.h tools/plot/plot.h | %physics %cli %plot
tools               | tools/frames/frames.h                    | tools/frames
tools               | tools/cost/cost.h tools/solve/solve.h    | tools/cost tools/solve
tools               | tools/stress/stress.h tools/render/render.h | tools/stress tools/render
tools               | tools/scene/scene.h                      | tools/scene libcontact/scene
tools               | tools/scan/scan.h                        | tools/scan
tools               | tools/leak/leak.h tools/fatigue/fatigue.h | tools/leak tools/fatigue
tools               | tools/info/info.h tools/slip/slip.h      | tools/info tools/slip
tools               | tools/problem/problem.h tools/model/model.h | tools/problem tools/model
tools               | tools/materials/materials.h              | tools/materials
tools               | tools/import/import.h                    | tools/import
tools               | tools/pick/pick.h tools/synth/synth.h    | tools/pick tools/synth
tools               | tools/report/page.h                      | tools/report
tools               | formats/core/core.h formats/rcg/rcg.h    | formats/core formats/rcg
tools               | formats/format.h formats/export.h        | formats
tools               | formats/containers/containers.h          | formats/containers formats/containers/packing
END
base='libcontact/contact.h libcontact/grid.h libcontact/common.h libcontact/memory.h libcontact/expected.h libcontact/owned.h'
public='libcontact/contact.h libcontact/grid.h libcontact/surface.h libcontact/model.h'
physics='libcontact libcontact/body libcontact/operator libcontact/solver libcontact/stress libcontact/yield'
physics="$physics libcontact/pyramid libcontact/model libcontact/adhesion libcontact/leak libcontact/friction libcontact/rolling libcontact/wear libcontact/travel libcontact/viscoelastic libcontact/fatigue libcontact/heat libcontact/surface libcontact/surface/parameters libcontact/features"
cli='tools/cli tools/text tools/machine'
plot='tools/plot tools/canvas'
reader='libcontact/grid.h formats/core/core.h formats/format.h formats/containers/containers.h formats/sandbox/sandbox.h'
formats='libcontact formats formats/core formats/containers formats/containers/packing formats/sandbox'
sed -i "s!%base!$base!; s!%public!$public!; s!%physics!$physics!; s!%cli!$cli!; s!%plot!$plot!; s!%ranks!libcontact/ranks/ranks.h!
    s!%reader!$reader!; s!%formats!$formats!; s!libcontact/grid.h!& libcontact/owned.h!" arrows.txt

# ---- files of the tree ----

# includes TREE: "file header" of every quoted include of the code.
includes() {
    (cd "$1" && find libcontact formats tools -name '*.[ch]' -exec \
        sed -n 's/^ *# *include *"\(.*\)".*/& \1/; T; F; s/.* //p' {} +) | paste -d ' ' - -
}

# include_faults TREE: the includes that the table does not allow.
include_faults() {
    includes "$1" | awk -v tree="$1" '
        function exists(file) { return system("test -f \"" tree "/" file "\"") == 0 }
        NR == FNR { split($0, part, "|"); gsub(/ /, "", part[1])
            may[part[1]] = may[part[1]] " " part[2] " "; next }
        {
            folder = $1; sub(/\/[^\/]*$/, "", folder)
            place = $1 in may ? $1 : folder
            if (!(place in may)) print "include", $1, "(a folder without a row)"
            else if ($2 !~ /\// ? !exists(folder "/" $2) : index(may[place], " " $2 " ") == 0)
                print "include", $1, $2
        }' arrows.txt - | sort
}

# symbols BUILD: "D source name" for each definition, "U source name" for each use.
symbols() {
    objects "$1" libcontact formats tools >sources.txt
    cut -d ' ' -f 1 sources.txt | xargs nm -gA | awk '
        FILENAME == "sources.txt" { source[$1] = $2; next }
        { object = $1; sub(/\.o:.*/, ".o", object) }
        $1 !~ /:$/ && $2 ~ /^[TDBRVWC]$/ { print "D", source[object], $3 }
        $2 == "U" { print "U", source[object], $3 }' sources.txt - | sort -u
}

# call_faults SYMBOLS: the calls that the table does not allow.
call_faults() {
    awk '
        FILENAME == "arrows.txt" { split($0, part, "|"); gsub(/ /, "", part[1])
            may[part[1]] = may[part[1]] " " part[3]; next }
        { folder = $2; sub(/\/[^\/]*$/, "", folder); place = $2 in may ? $2 : folder }
        $1 == "D" { where[$3] = place; home[$3] = folder; next }
        $3 in where && folder != home[$3] {
            n = split(may[place], list, " "); found = 0
            for (k = 1; k <= n; k++) {
                split(list[k], pair, "=")
                found = found || pair[1] == where[$3] && (pair[2] == "" || index($3, pair[2]) == 1)
            }
            if (!found) print "call", place, where[$3], $3
        }' arrows.txt "$1" | sort -u
}

# private_faults SYMBOLS: names of libcontact that formats and tools use although the public headers do not
# declare them.
private_faults() {
    declared "$RC_SOURCE/libcontact/contact.h" >public.txt
    if with_mpi; then
        CC=mpicc declared "$RC_SOURCE/libcontact/contact_mpi.h" >>public.txt
    fi
    awk '
        FILENAME == "public.txt" { public[$1] = 1; next }
        $1 == "D" { if ($2 ~ /^libcontact\//) where[$3] = 1; next }
        $2 !~ /^libcontact\// && $3 in where && !($3 in public) && $3 !~ /^rc_(malloc|calloc|realloc|aligned_alloc|free)$/ { sub(/\/.*/, "", $2); print "private", $2, $3 }' \
        public.txt "$1" | sort -u
}

# names TREE: counts how often each file names an engine or a body in code, by its row, or an engine as a
# quoted word.
names() {
    local words bodies
    words=$(cd "$1" && sed -n 's/.*\.name = "\([a-z0-9_]*\)".*/\1/p' libcontact/operator/engine_*.c libcontact/operator/real_space/engine_*.c |
        paste -s -d '|')
    bodies=$(sed -n 's/^RC_BODY(\(.*\))/\1/p' "$1/libcontact/body/bodies.list" | paste -s -d '|')
    (cd "$1" && find libcontact tools -name '*.[ch]') |
        grep -v '^libcontact/operator/\(engine_fft\|conv\|real_space/.*\)\.[ch]$\|^libcontact/body/' |
        sort |
        while read -r file; do
            perl -0777 -ne '
                BEGIN { ($words, $bodies, $name) = splice @ARGV, 0, 3 }
                s#/\*.*?\*/##gs;
                my $n = () = /"(?:$words)"|\brc_engine_(?:$words)\b|\brc_body_(?:$bodies)\b/g;
                print "name $name $n\n" if $n > 0' "$words" "$bodies" "$file" "$1/$file"
        done
}

# reaches TREE: counts the places where a file calls a function of the row of a model itself, or a room of a
# model names the solver of elastic contacts. An outer model drives its inner one by verbs only.
reaches() {
    (cd "$1" && find libcontact -mindepth 2 -name '*.[ch]' ! -path 'libcontact/model/*' ! -path 'libcontact/solver/*') | sort |
        while read -r file; do
            perl -0777 -ne '
                BEGIN { $name = shift @ARGV; $verbs = join "|", qw(go step look fill state free keep heights compliance
                    accuracy start respond progress plan solver) }
                s#/\*.*?\*/##gs;
                my $n = () = /->row->(?:$verbs)\b/g;
                $n += () = /\bstruct rc_solver\b/g if $name !~ m#^libcontact/yield/#;
                print "reach $name $n\n" if $n > 0' "$file" "$1/$file"
        done
}

# effects TREE: names of effects of rc-solve in code outside of the file with their row, and options of another
# file that code asks for. Names that every contact has are allowed.
effects() {
    (cd "$1" && cat tools/solve/*.c | sed -n 's/^const struct effect solve_effect_\([a-z]*\) .*/\1/p') |
        grep -vxE 'layers|hardness|sphere|cylinder|padding|approach|history|sequence|time|stiffness' | paste -s -d '|' >effects.txt
    (cd "$1" && ls tools/rc-solve.c tools/solve/*.[ch]) | while read -r file; do
        perl -0777 -ne '
            BEGIN { ($words, $name) = splice @ARGV, 0, 2 }
            my %own = map { $_ => 1 } /\.name = "([^"]*)"/g, /solve_effect_(\w+) =/g;
            my ($given) = grep { !$own{$_} && $_ !~ /^(history|output)$/ } /tool_given\([^"]*"([^"]*)"/g;
            print "effect $name asks for --$given\n" if $given;
            s#/\*.*?\*/##gs; s/"(?:[^"\\]|\\.)*"//g;
            my %seen;
            print "effect $name names $_\n" for grep { !$own{$_} && !$seen{$_}++ } /\b(?:solve_effect_)?($words)\b/g' \
            "$(cat effects.txt)" "$file" "$1/$file"
    done | sort -u
}

# none FAULTS: succeeds without faults; otherwise prints them.
none() {
    ! grep . "$1" >&2
}

# ---- the tree ----

include_faults "$RC_SOURCE" >include.txt
claim "every include names the public header of a folder that the table allows" none include.txt
claim "  the check has seen includes" test "$(includes "$RC_SOURCE" | wc -l)" -gt 200
claim "  every header of the table exists" bash -c '
    cut -d "|" -f 2 arrows.txt | tr " " "\n" | grep / | sort -u | while read -r header; do
        [ -f "$RC_SOURCE/$header" ] || { echo "$header" >&2; exit 1; }
    done'
# The map in CONTRIBUTING.md: each folder has a row in the table of its tree, which names its subfolders.
# Every folder with a row in the map exists.
mapped() {
    awk '/^## The map/ { on = 1; next } /^## / { on = 0 } on && /^\| [a-z]*\/ / { tree = $2 } on && /^\| `/ { print tree $0 }' \
        "$RC_SOURCE/CONTRIBUTING.md" >map.txt
    (cd "$RC_SOURCE" && find libcontact formats tools -mindepth 1 -type d) | while read -r folder; do
        below=${folder#*/}
        case $below in
        */*/*) below=$(basename "$(dirname "$folder")") ;; # of one format
        esac
        grep -qE "^${folder%%/*}/.*\`$(basename "$below")/?\`" map.txt || { echo "not in the map: $folder" >&2; exit 1; }
    done || return
    cut -d '|' -f 1,2 map.txt | tr -d '`|,' | while read -r tree names; do
        for name in $names; do
            [ "$name" = 'rc-*.c' ] || [ -d "$RC_SOURCE/$tree$name" ] || { echo "no folder: $tree$name" >&2; exit 1; }
        done
    done
}
claim "the map in CONTRIBUTING.md lists exactly the folders of the tree" mapped
names "$RC_SOURCE" >name.txt
claim "only the folder of operators names engines, and only the folder of bodies names bodies" none name.txt
reaches "$RC_SOURCE" >reach.txt
claim "outer models drive their inner models by verbs, and only yield has a solver of its own" none reach.txt

effects "$RC_SOURCE" >effect.txt
claim "only the file of an effect of rc-solve names it" none effect.txt
claim "  the check knows the effects" grep -q 'yield.*|.*travel\|travel.*|.*yield' effects.txt

if command -v nm >/dev/null; then
    symbols "$(dirname "$RC_BIN")" >symbols.txt
    call_faults symbols.txt >call.txt
    claim "every call goes to a folder that the table allows" none call.txt
    claim "  the check has seen calls" test "$(grep -c '^U.* rc_' symbols.txt)" -gt 500
    private_faults symbols.txt >private.txt
    claim "formats and tools use only functions of the public headers of libcontact" none private.txt
else
    untried "what is called, because nm is not here"
fi

# ---- a tree where each rule is broken: every fault is seen ----

mkdir -p bad/libcontact/{body,operator/real_space,solver,stress,surface,other} bad/formats/core bad/tools
cp "$RC_SOURCE"/libcontact/operator/engine_*.c bad/libcontact/operator
cp "$RC_SOURCE"/libcontact/operator/real_space/engine_*.c bad/libcontact/operator/real_space
cp "$RC_SOURCE"/libcontact/body/*.{c,list} bad/libcontact/body
printf '#include "libcontact/solver/solver.h"\n#include "nowhere.h"\n' >bad/libcontact/operator/engine_up.c
printf '#include "libcontact/operator/operator.h"\n#include "libcontact/operator/fft.h"\n' >bad/libcontact/solver/deep.c
printf '#include "libcontact/grid.h"\n' >bad/libcontact/other/new.c
printf '  #  include "libcontact/contact.h"\n' >bad/formats/core/core.c
include_faults bad | grep -v '/body/\|/engine_[^u]' >seen.txt
claim "the check finds wrong includes: of other folders, missing files, private headers" diff - seen.txt <<'END'
include formats/core/core.c libcontact/contact.h
include libcontact/operator/engine_up.c libcontact/solver/solver.h
include libcontact/operator/engine_up.c nowhere.h
include libcontact/other/new.c (a folder without a row)
include libcontact/solver/deep.c libcontact/operator/fft.h
END
printf '/* "mlms" */ a = "fft64"; b = &rc_engine_direct; c = "uniform"; d = "ffts";\n' >bad/tools/rc-x.c
printf 'e = &rc_body_layered; f = rc_body_type(b)->name;\n' | tee bad/libcontact/stress/s.c >bad/libcontact/operator/s.c
names bad >seen.txt
claim "the check finds names in quotes and in rows, but not in comments" diff - seen.txt <<'END'
name libcontact/operator/s.c 1
name libcontact/stress/s.c 1
name tools/rc-x.c 2
END
printf '/* m->row->go */ m->row->start(m); x = v->row->n; struct rc_solver *s; struct rc_solver_found f;\n' >bad/libcontact/other/reach.c
reaches bad >seen.txt
claim "the check finds a call of a row, and the solver in another room" diff - seen.txt <<'END'
reach libcontact/other/reach.c 2
END
mkdir -p bad/tools/solve
printf 'const struct effect solve_effect_glow = {.name = "glow"};\nif (tool_given(t, "glow") || tool_given(t, "speed"))\n' >bad/tools/solve/glow.c
printf '/* glow */ warn("--glow"); if (run->glow.on)\n' >bad/tools/solve/case.c
printf 'x = &solve_effect_glow;\n' >bad/tools/rc-solve.c
effects bad >seen.txt
claim "the check finds names of effects, but not in words for the user" diff - seen.txt <<'END'
effect tools/rc-solve.c names glow
effect tools/solve/case.c names glow
effect tools/solve/glow.c asks for --speed
END
cat >bad-symbols.txt <<'END'
D libcontact/common.c rc_common
D libcontact/operator/conv.c rc_conv_apply
D libcontact/operator/conv.c rc_hidden
D libcontact/solver/solver.c rc_solver_new
D libcontact/stress/stress.c rc_stress_new
U libcontact/operator/conv.c rc_common
U libcontact/operator/conv.c rc_solver_new
U libcontact/solver/solver.c rc_conv_apply
U tools/rc-solve.c rc_hidden
U tools/rc-solve.c rc_solver_new
U formats/core/text.c rc_conv_apply
END
{ call_faults bad-symbols.txt && private_faults bad-symbols.txt; } >seen.txt
claim "the check finds wrong calls: of other folders, of private functions" diff - seen.txt <<'END'
call formats/core libcontact/operator rc_conv_apply
call libcontact/operator libcontact/solver rc_solver_new
private tools rc_hidden
END
refuses 1 '^private tools rc_hidden' "a fault is told" "$(declare -f none); none seen.txt"
