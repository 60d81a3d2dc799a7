/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A list of names for a message: a dozen of them, and their number. */
#ifndef RC_NAME_LIST_H
#define RC_NAME_LIST_H

#include <stddef.h>

#include "names.h"

struct name_list {     /* initialise with {0}, or with `asked` */
    const char *asked; /* the user's word, perhaps a misspelt name of the list; NULL: none */
    char text[640], nearest[NAME_SIZE];
    size_t n, named;
};

/* Adds a name that is not yet in the list; beyond a dozen it is only counted. */
void name_list_add(struct name_list *list, const char *name);
/* The text with a suggestion of the intended name; afterwards no name may be added. */
const char *name_list_end(struct name_list *list);

#endif
