/* Part of every program of a build with RC_COVERAGE: where RC_UNSANDBOXED is in the environment,
 * what else a sandbox reads is read in the process itself. A child of the sandbox may write no file,
 * and so not which lines it has run. */
#include <stdlib.h>

#include "formats/sandbox/sandbox.h"

__attribute__((constructor)) static void
begin(void)
{
    if (getenv("RC_UNSANDBOXED") != NULL)
        rc_sandbox_bypass(true);
}
