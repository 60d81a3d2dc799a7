/* A list of names for a message: a dozen of them, and how many there are. */
#ifndef RC_NAME_LIST_H
#define RC_NAME_LIST_H

#include <stddef.h>

#include "names.h"

struct name_list {     /* starts as {0}, or with what was asked for */
    const char *asked; /* of which the list may hold a misspelt one; NULL: nothing */
    char text[640], nearest[NAME_SIZE];
    size_t n, named;
};

/* Adds a name that is not in the list yet; past a dozen they are only counted. */
void name_list_add(struct name_list *list, const char *name);
/* The text, and a guess at what was meant; after this nothing may be added. */
const char *name_list_end(struct name_list *list);

#endif
