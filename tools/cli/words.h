/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Words of options, from the tables of the library and the formats. Each function returns word k = 0, 1, ...,
 * and NULL past the last, as .words of struct opt requires.
 */
#ifndef RC_WORDS_H
#define RC_WORDS_H

#include <stddef.h>

#include "libcontact/contact.h"

const char *words_engine(size_t k);
const char *words_engine_or_auto(size_t k);
const char *words_method(size_t k);
const char *words_method_or_auto(size_t k);
const char *words_component(size_t k); /* components of a stress, as in enum rc_component */

/* Engines for stresses, which are always in double precision: without engines that differ only in
 * precision. */
const char *words_stress_engine_or_auto(size_t k);

/* The engines for periodic maps, separated by blanks, without those that differ only in precision. */
const char *words_periodic_engines(char *list, size_t size);

/* Index of the row with this name; past the last one for an unknown name, such as "auto". */
size_t words_engine_place(const char *name);
/* The row with this name; NULL: there is none. */
const struct rc_engine_info *words_engine_named(const char *name);

#endif
