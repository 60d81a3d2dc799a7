/*
 * Part of every program of a build with RC_COVERAGE. With RC_UNSANDBOXED in the environment the
 * process itself reads what a sandbox reads otherwise: a child of the sandbox may write no file, and
 * so cannot record the lines that it has run.
 */
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include "formats/sandbox/sandbox.h"

void __gcov_dump(void);

/* Damaged files make libhdf5 crash, at the latest when it clears up: the counters are written before
 * that ends. */
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
