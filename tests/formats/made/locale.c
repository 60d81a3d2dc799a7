/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A locale with a decimal comma, to test that numbers in files have a point in every locale. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made.h"

static char locale_folder[] = "/tmp/made_locale.XXXXXX";

static void
remove_locale(void)
{
    char command[100];

    snprintf(command, sizeof command, "rm -r %s", locale_folder);
    if (system(command) != 0)
        perror(locale_folder);
}

bool
set_comma_locale(void)
{
    char command[400];

    if (setlocale(LC_NUMERIC, "comma") != NULL)
        return true;
    if (mkdtemp(locale_folder) == NULL)
        return false;
    atexit(remove_locale);
    /* its exit status is not 0 after warnings too; setlocale shows whether it worked */
    snprintf(
        command, sizeof command,
        "cd %s && printf 'LC_NUMERIC\\ndecimal_point \",\"\\nthousands_sep \"\"\\ngrouping -1\\n"
        "END LC_NUMERIC\\n' >source && localedef -c -i source ./comma >/dev/null 2>&1",
        locale_folder);
    if (system(command) < 0)
        return false;
    setenv("LOCPATH", locale_folder, 1);
    return setlocale(LC_NUMERIC, "comma") != NULL;
}

void
the_locale_has_a_comma(void **state)
{
    char text[8];

    (void)state;
    if (!set_comma_locale())
        skip();
    snprintf(text, sizeof text, "%.1f", 1.5);
    assert_string_equal(text, "1,5");
}
