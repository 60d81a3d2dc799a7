/*
 * Words of options, from the tables in which the things stand. Each function gives word k = 0, 1,
 * ... and NULL past the last: what struct opt takes as .words.
 */
#ifndef RC_WORDS_H
#define RC_WORDS_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/contact.h"

const char *words_engine(size_t k);
const char *words_engine_or_auto(size_t k);
const char *words_method(size_t k);
const char *words_method_or_auto(size_t k);
const char *words_component(size_t k); /* of a stress, as in enum rc_component */

/* Engines for stresses: as these are in double precision anyway, without engines that differ only
 * in that. */
const char *words_stress_engine_or_auto(size_t k);

/* The engines that sum periodic maps, separated by blanks, but for those that differ only in
 * precision. */
const char *words_periodic_engines(char *list, size_t size);

/* Place of the row of that name; past the last one: there is none, as for "auto". */
size_t words_engine_place(const char *name);
/* The row itself; NULL: there is none. */
const struct rc_engine_info *words_engine_named(const char *name);

#endif
