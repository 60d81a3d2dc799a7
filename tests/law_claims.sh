# SPDX-License-Identifier: GPL-3.0-or-later
# The harness of the shell tests, pipe.sh: a script passes only if it ends with status 0, has made a claim, and no
# claim has failed. It is skipped only with a reason and before its first claim. No test puts a part of the
# harness out of use.
. "$(dirname "$0")/pipe.sh"

# ends STATUS "pattern" "sentence" < SCRIPT: a test of these lines ends with this status, and its output matches
# the pattern.
ends() {
    {
        echo '. "$RC_SOURCE/tests/pipe.sh"'
        cat
    } >inner.sh
    bash inner.sh >inner.out 2>&1
    local got=$?
    if [ "$got" = "$1" ] && grep -qE -- "$2" inner.out; then
        passed "$3"
    else
        failed "$3: exit status $got (expected $1), output:"
        sed 's/^/    | /' inner.out
    fi
}

ends 0 '^1 claims, 0 failed$' "a claim that holds" <<'END'
claim "true" true
END
ends 1 '^NOT OK: false' "a claim that fails" <<'END'
claim "false" false
END
ends 1 '^2 claims, 1 failed$' "a claim that fails before one that holds" <<'END'
claim "false" false
claim "true" true
END
ends 1 '^NOT OK: another' "a command that is not refused" <<'END'
refuses 1 '' "another" 'exit 0'
END
ends 1 '^NOT OK: not refused so' "another message" <<'END'
refuses 1 'disk' "not refused so" 'echo memory >&2; exit 1'
END
ends 1 '^NOT OK: a number' "a number that is not near" <<'END'
near 1.1 1 0.09 "a number"
END
ends 1 '^NOT OK: a number' "a missing number" <<'END'
near "" 1 0.09 "a number"
END
ends 1 '^NOT OK: a word' "a word between numbers" <<'END'
between 0 nan 1 "a word"
END
ends 1 'makes no claim' "a script without a claim" <<'END'
true
END
ends 1 'makes no claim' "one that has left before its claims" <<'END'
exit 0
claim "true" true
END
ends 1 'ended early, with status 5' "an exit status of its own" <<'END'
claim "true" true
exit 5
END
ends 1 'unbound variable' "an unset variable" <<'END'
claim "true" true
echo "$nothing"
claim "true" true
END
ends 1 'unexpected' "an error of syntax" <<'END'
claim "true" true
if then
END
ends 1 'command not found' "a last command that is not there" <<'END'
claim "true" true
no-such-command
END
ends 1 '1 claims in a subshell' "a claim in a pipeline, which cannot be counted" <<'END'
claim "true" true
echo 1 | while read -r line; do claim "lost" false; done
true
END
ends 1 'ended early, with status 77' "the status of skipped tests without a reason" <<'END'
exit 77
END
ends 1 'ended early, with status 77' "and after a claim" <<'END'
claim "false" false
skip "it is tired"
END
ends 77 '^SKIPPED: no disk$' "a test that is skipped" <<'END'
skip "no disk"
claim "true" true
END
ends 0 '^NOT TRIED: the disk$' "a part that is skipped" <<'END'
untried "the disk"
claim "true" true
END
ends 0 'folder /' "its folder" <<'END'
claim "a folder" test -d "$scratch"
echo "folder $scratch"
END
claim "  is removed" test ! -e "$(sed -n 's/^folder //p' inner.out)"

# ---- the log of a run ----

# log LINE... : of a passed test
log() {
    printf '1/2 Testing: pipe_one\n1/2 Test: pipe_one\nOutput:\n'
    printf '%s\n' "$@"
    printf '<end of output>\nTest Passed.\n2/2 Testing: pipe_two\nNOT OK: two\nTest Failed.\n'
}
outcome=$RC_SOURCE/tests/outcome.sh
log 'ok: one' >whole.log
log 'ok: one' 'NOT OK: one fails' 'ok: one' >bad.log
log 'SKIPPED: no disk' '[  SKIPPED ] part' '[  SKIPPED ] 1 test(s), listed below:' '[  SKIPPED ] part' 'NOT TRIED: fish' >skipped.log
claim "a log without a failed claim in a passed test" bash -c '"$1" whole.log >said && [ ! -s said ]' - "$outcome"
claim "a failed claim in a passed test is named, and fails" bash -c \
    '! "$1" bad.log >said && grep -qx "  pipe_one: NOT OK: one fails" said && ! grep pipe_two said' - "$outcome"
claim "skipped tests are listed" bash -c '"$1" skipped.log | cmp - <(printf "%s\n" Skipped: "  pipe_one: no disk" "  pipe_one: its part part" "  pipe_one: fish")' - "$outcome"

# ---- the scripts ----

scripts() { find "$RC_SOURCE/tests" -name 'pipe_*.sh' -o -name 'law_*.sh'; }
scripts >scripts
claim "every script has the harness" bash -c '[ "$(wc -l <scripts)" -gt 100 ] && ! xargs grep -LE "^\. .*/pipe\.sh\"" <scripts | grep . >&2'
# none PATTERN: no line of a script matches, except of this one.
none() { ! grep -v /law_claims.sh scripts | xargs grep -nE -- "$1" >&2; }
claim "  and its trap" none '^ *trap .*(EXIT| 0)'
claim "  and its way to be skipped" none '\bexit 77\b'
functions=$(sed -nE 's/^([a-z_]+)\(\) .*/\1/p' "$RC_SOURCE/tests/pipe.sh" | paste -sd '|')
claim "  and its functions" none "^ *($functions)\(\)"
claim "  and its counters" none '^ *(claims|failures|skipped)='
