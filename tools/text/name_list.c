/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "name_list.h"

#include <stdio.h>
#include <string.h>

enum {
    NAMED = 12,                  /* names that a message lists */
    NAMED_LEFT = NAME_MEANT + 40 /* bytes for the end of the text */
};

void
name_list_add(struct name_list *l, const char *name)
{
    size_t used = strlen(l->text);

    l->n++;
    if (l->asked != NULL)
        name_nearer(l->asked, name, l->nearest);
    if (l->named == NAMED || used + strlen(name) + NAMED_LEFT > sizeof l->text)
        return;
    l->named++;
    snprintf(l->text + used, sizeof l->text - used, "%s%s", used > 0 ? ", " : "", name);
}

const char *
name_list_end(struct name_list *l)
{
    size_t used = strlen(l->text);
    char meant[NAME_MEANT];

    if (l->n > l->named)
        used += (size_t)snprintf(l->text + used, sizeof l->text - used, ", ... (%zu in all)", l->n);
    snprintf(l->text + used, sizeof l->text - used, "%s", name_meant(l->nearest, meant));
    return l->text;
}
