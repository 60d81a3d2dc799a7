#include "name_list.h"

#include <stdio.h>
#include <string.h>

enum {
    NAMED = 12 /* things that a message names one by one */
};

void
name_list_add(struct name_list *l, const char *name)
{
    size_t used = strlen(l->text);

    l->n++;
    if (l->named == NAMED || used + strlen(name) + 8 > sizeof l->text)
        return;
    l->named++;
    snprintf(l->text + used, sizeof l->text - used, "%s%s", used > 0 ? ", " : "", name);
}

const char *
name_list_end(struct name_list *l)
{
    size_t used = strlen(l->text);

    if (l->n > l->named)
        snprintf(l->text + used, sizeof l->text - used, ", ... (%zu in all)", l->n);
    return l->text;
}
