/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Part of every program of a build with RC_COVERAGE. With RC_UNSANDBOXED in the environment the process
 * itself does the reading of the sandbox. The child of the sandbox may not write files and therefore cannot
 * record its coverage.
 */
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include "formats/sandbox/sandbox.h"

void __gcov_dump(void);

/* Damaged files make libhdf5 crash, at the latest during its cleanup: the counters are written before. */
static void
crashed(int number)
{
    (void)number;
    __gcov_dump();
    _exit(1);
}

__attribute__((constructor)) static void
begin(void)
{
    if (getenv("RC_UNSANDBOXED") == NULL)
        return;
    rc_sandbox_bypass(true);
    signal(SIGSEGV, crashed);
}
