/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The time that a thread waits before it sleeps reaches the libraries, and the environment is whole again in
 * main. The program starts itself with several environments, and looks into its own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/machine/waiting.h"

#if defined __GLIBC__ && !defined __SANITIZE_ADDRESS__
enum {
    SET = 1
};
#else
enum {
    SET = 0
};
#endif

static char **arguments;

/* The status of this program, which looks whether the libraries were told a time. */
static int
status(char *const *environment, const char *expected)
{
    char *const again[] = {arguments[0], (char *)(uintptr_t)expected, NULL};
    int s = -1;
    const pid_t child = fork();
    if (child == 0) {
        execve("/proc/self/exe", again, environment);
        _exit(99);
    }
    assert_true(child > 0);
    assert_int_equal(waitpid(child, &s, 0), child);
    return WEXITSTATUS(s);
}

static void
short_time_without_a_wish(void **state)
{
    (void)state;
    char *const usual[] = {"HOME=/root", "PWD=/tmp", "LANG=C", NULL};
    char *const shell[] = {"_=/usr/bin/rc-solve", NULL};
    assert_int_equal(status(usual, SET ? "1000" : "none"), 0);
    assert_int_equal(status(shell, SET ? "1000" : "none"), 0);
}

static void
the_wish_of_the_user_wins(void **state)
{
    (void)state;
    char *const count[] = {"PWD=/tmp", "GOMP_SPINCOUNT=77", NULL};
    char *const passive[] = {"PWD=/tmp", "OMP_WAIT_POLICY=passive", NULL};
    assert_int_equal(status(count, "77"), 0);
    assert_int_equal(status(passive, "none"), 0);
}

static void
an_empty_environment_stays_empty(void **state)
{
    (void)state;
    char *const empty[] = {NULL};
    char *const read_by_libraries[] = {"LANG=C", "OMP_NUM_THREADS=2", "PWDX=1", NULL};
    assert_int_equal(status(empty, "none"), 0);
    assert_int_equal(status(read_by_libraries, "none"), 0);
}

/* 0: the time was EXPECTED before waiting_restore, and after it the environment is that of the start. */
static int
look(const char *expected)
{
    const char *told = getenv("GOMP_SPINCOUNT");
    if (strcmp(told != NULL ? told : "none", expected) != 0)
        return 1;
    waiting_restore();
    told = getenv("GOMP_SPINCOUNT");
    if (strcmp(expected, "77") == 0 ? told == NULL : told != NULL)
        return 2;
    if (getenv("HOME") != NULL && (getenv("PWD") == NULL || strcmp(getenv("PWD"), "/tmp") != 0))
        return 3;
    if (strcmp(expected, "1000") == 0 && getenv("PWD") == NULL && getenv("_") == NULL)
        return 4;
    return 0;
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(short_time_without_a_wish),
        cmocka_unit_test(the_wish_of_the_user_wins),
        cmocka_unit_test(an_empty_environment_stays_empty),
    };
    arguments = argv;
    return argc > 1 ? look(argv[1]) : cmocka_run_group_tests(tests, NULL, NULL);
}
