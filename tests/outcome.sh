#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Reads the output of the tests of a build, Testing/Temporary/LastTest.log, where also the output of passed tests
# stands: tests/outcome.sh LOG. It prints the tests, and parts of tests, that were skipped, with the reason, and
# fails if a test says "NOT OK" although it passed.
awk '
    function skips(why) { if (!told[name, why]++) skipped[++n] = name ": " why }
    /^[0-9]+\/[0-9]+ Testing: / { name = $3; bad = 0 }
    /^SKIPPED: / || /^NOT TRIED: / { sub(/^[A-Z ]*: /, ""); skips($0) }
    /^\[  SKIPPED \] [a-z_]+$/ { skips("its part " $NF) } # of a program, perhaps repeated in its summary
    /^NOT OK/ { said[++bad] = $0 }
    /^Test Passed\.$/ { for (k = 1; k <= bad; k++) wrong[++w] = name ": " said[k] }
    END {
        if (n > 0) print "Skipped:"
        for (k = 1; k <= n; k++) print "  " skipped[k]
        if (w > 0) print "Passed, although a claim failed:"
        for (k = 1; k <= w; k++) print "  " wrong[k]
        exit w > 0
    }' "$1"
