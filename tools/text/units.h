/* Numbers as people write them on a command line: "240N", "6GPa", "1.1um", "0:50um:45". */
#ifndef RC_UNITS_H
#define RC_UNITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "libcontact/grid.h"

enum unit {
    UNIT_NONE,  /* a plain number           */
    UNIT_M,     /* metres; also inch, mil, microinch */
    UNIT_N,     /* newtons; also kgf                 */
    UNIT_PA,    /* pascals; also N/mm2, bar          */
    UNIT_S,     /* seconds; also min and h  */
    UNIT_BYTES, /* bytes: 512M, 4G, 2GiB    */
    UNIT_HARD,  /* the same; also 600HV              */
    UNIT_WORK,  /* joules per square metre; also N/m */
    UNIT_PAS,   /* pascal seconds; also cP           */
};

struct numbers {
    double *v;
    size_t n;
    bool per_metre; /* forces over a length, N/m instead of N                  */
    bool no_memory; /* it failed for want of memory, not because of the text */
};

const char *unit_name(enum unit unit);
/* What is usual on a command line, separated by blanks. */
const char *unit_usual(enum unit unit);

/* One number, with or without its unit, to SI. RC_FAIL says what was expected. */
enum rc_status unit_number(const char *text, enum unit unit, double *value, struct rc_err *err);

/* Whether a hardness is written after Vickers, 600HV or 600HV10: kilograms of force over square
 * millimetres of the sloping faces of the dent. As a pressure it is the mean over the area of the dent in
 * the plane, which is smaller by the sine of 68 degrees. */
bool unit_vickers(const char *text);

/* A whole number as a size; SIZE_MAX: more than the machine can count. */
static inline size_t
unit_size(double number)
{
    return number < (double)SIZE_MAX ? (size_t)number : SIZE_MAX;
}

/* The sum of two; SIZE_MAX: more than that. */
static inline size_t
size_sum(size_t a, size_t b)
{
    return b < SIZE_MAX - a ? a + b : SIZE_MAX;
}

/* `a,b,c`, `a:b:n` (n values, both ends included) or `a:b:log:n` (the same, by ratio). Numbers with
 * and without a unit in one list are an error, except 0. The caller frees list->v. */
enum rc_status unit_numbers(const char *text, enum unit unit, struct numbers *list,
                            struct rc_err *err);
/* The same of forces, which may all be given over a length, in N/m. */
enum rc_status unit_forces(const char *text, struct numbers *list, struct rc_err *err);
/* Whether a list looks as if it were one number with a decimal comma: two whole numbers without a
 * unit, of which none is ten times the other. */
bool unit_decimal_comma(const char *text);
/* "K1,K2" to W/(m K) or S/m, both above 0. *conductance: the unit of what conducts so, "W/K" or
 * "S"; NULL: neither has a unit. */
enum rc_status unit_conductivities(const char *text, double k[2], const char **conductance,
                                   struct rc_err *err);

#endif
