/*
 * Figures of results: each number is declared once, with its name, unit and title, in a table beside the struct that
 * holds it. Reports, titles of pictures and warnings are made from these tables. This header comes with contact.h.
 */
#ifndef RC_MODEL_H
#define RC_MODEL_H

#include <stdbool.h>
#include <stddef.h>

#include "grid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- figures: each number of a result, declared once ---- */

enum rc_figure_kind {
    RC_NUMBER, /* double; NAN: unknown */
    RC_COUNT,  /* size_t               */
    RC_YESNO,  /* bool                 */
    RC_WORD    /* const char *; NULL: unknown */
};
enum rc_figure_role {
    RC_FIGURE_RESULT,
    RC_FIGURE_ERROR, /* a part of the estimated error: `by` names the option that lowers it */
    RC_FIGURE_COST
};
/* A row of a table of figures; the last row of a table has no name. RC_FIGURE gives the first three. */
struct rc_figure {
    enum rc_figure_kind kind;
    size_t at;        /* offset of the member in its struct                                   */
    const char *name; /* of the column. "object.name" stands inside an object                 */
    const char *unit, *title; /* SI unit, NULL: a plain number; title of an axis              */
    const char *says;         /* what it is, a part of a sentence; NULL: the title says it    */
    enum rc_figure_role role;
    const char *by; /* the field of the problem that governs it                          */
    double limit;   /* the warning holds above it, or below it where `least`; 0: no limit */
    bool least;
    const char *warning; /* what is then wrong, without naming an option                      */
};
/* {RC_FIGURE(struct rc_leak_figures, mean_gap), "m", "Mean gap"}: the kind follows from the type of the
 * member, and a member that does not exist does not compile. RC_FIGURE_AS: the column has another name. */
#define RC_KIND_OF(type, member)                                                                   \
    _Generic(((type *)0)->member, double : RC_NUMBER, size_t : RC_COUNT, bool : RC_YESNO,          \
             const char * : RC_WORD, char * : RC_WORD)
#define RC_FIGURE_AS(column, type, member)                                                         \
    .kind = RC_KIND_OF(type, member), .at = offsetof(type, member), .name = column
#define RC_FIGURE(type, member) RC_FIGURE_AS(#member, type, member)

/* The value in the struct that `data` points to; counts and yes/no as numbers. NAN: unknown, a word, or data
 * NULL. */
RC_API double rc_figure_number(const struct rc_figure *figure, const void *data);
/* The word; NULL: unknown, a number, or data NULL. */
RC_API const char *rc_figure_word(const struct rc_figure *figure, const void *data);
/* The table of the figures of a struct of this library, by name: "contact" of struct rc_contact. NULL: there is
 * none. */
RC_API const struct rc_figure *rc_figures(const char *name);
/* The row of that name in any table of this library, for titles and units of a table read from a file; NULL:
 * none. */
RC_API const struct rc_figure *rc_figure_find(const char *name);

#ifdef __cplusplus
}
#endif

#endif
