/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "waiting.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* The constructors of shared libraries run before main, so that a variable set there comes too late for the
 * OpenMP library. The functions of .preinit_array run before them, but the environment cannot grow at that
 * time: the variable takes the place of another one that no library reads, until main puts it back. */
#if defined __GLIBC__ && !defined __SANITIZE_ADDRESS__

/* Some 10 microseconds on a core of 2020: longer than most gaps between parallel loops, shorter than it takes
 * to wake a thread. bench/README has the measured times of 300 to 100000. */
static char spin_count[] = "GOMP_SPINCOUNT=1000";

static char **borrowed; /* place in the environment, NULL: none */
static char *lent;      /* its variable */

static bool
names(const char *variable, const char *name)
{
    const size_t n = strlen(name);
    return strncmp(variable, name, n) == 0 && variable[n] == '=';
}

static void
borrow(int argc, char **argv, char **envp)
{
    static const char *const unread[] = {"_", "SHLVL", "OLDPWD", "PWD"};
    char **place = NULL;
    (void)argc, (void)argv;
    for (char **e = envp; e != NULL && *e != NULL; e++) {
        if (names(*e, "GOMP_SPINCOUNT") || names(*e, "OMP_WAIT_POLICY"))
            return;
        for (size_t k = 0; place == NULL && k < sizeof unread / sizeof unread[0]; k++)
            if (names(*e, unread[k]))
                place = e;
    }
    if (place != NULL) {
        borrowed = place;
        lent = *place;
        *place = spin_count;
    }
}

__attribute__((section(".preinit_array"),
               used)) static void (*const borrow_first)(int, char **, char **) = borrow;

void
waiting_restore(void)
{
    if (borrowed != NULL)
        *borrowed = lent;
    borrowed = NULL;
}

#else

void
waiting_restore(void)
{
}

#endif
