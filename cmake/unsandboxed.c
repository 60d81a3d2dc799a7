/* Part of every program of a build with RC_COVERAGE: where RC_UNSANDBOXED is in the environment,
 * what else a sandbox reads is read in the process itself. A child of the sandbox may write no file,
 * and so not which lines it has run. */
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include "formats/sandbox/sandbox.h"

void __gcov_dump(void);

/* Damaged files bring libhdf5 to end so, at the latest when it clears up: the counters are kept. */
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
