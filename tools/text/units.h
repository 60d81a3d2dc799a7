/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as users write them on a command line: "240N", "6GPa", "1.1um", "0:50um:45". */
#ifndef RC_UNITS_H
#define RC_UNITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "libcontact/grid.h"

enum unit {
    UNIT_NONE,        /* a plain number                    */
    UNIT_M,           /* metres; also inch, mil, microinch */
    UNIT_N,           /* newtons; also kgf                 */
    UNIT_PA,          /* pascals; also N/mm2, bar          */
    UNIT_S,           /* seconds; also min and h           */
    UNIT_BYTES,       /* bytes: 512M, 4G, 2GiB             */
    UNIT_HARD,        /* pascals; also 600HV               */
    UNIT_WORK,        /* joules per square metre; also N/m */
    UNIT_PAS,         /* pascal seconds; also cP           */
    UNIT_K,           /* kelvins; also degC                */
    UNIT_SPEED,       /* metres per second; also km/h      */
    UNIT_DIFFUSIVITY, /* square metres per second          */
    UNIT_HEAT,        /* joules per cubic metre and kelvin */
    UNIT_HZ,          /* per second                        */
    UNIT_RAD_S,       /* radians per second                */
    UNIT_W_MK,        /* watts per metre and kelvin        */
    UNIT_S_M,         /* siemens per metre                 */
    UNIT_WEAR,        /* volume per force and distance     */
    UNIT_CREEP,       /* a plain number or a percentage    */
    UNIT_SPIN,        /* radians per metre; also 1/m       */
    UNIT_WEAR_ENERGY, /* volume per energy of friction     */
    UNIT_PER_PA,      /* pressure coefficient of viscosity */
    UNIT_MOLAR,       /* joules per mole                   */
    UNIT_ANGLE,       /* radians; also degrees             */
};

struct numbers {
    double *v;
    size_t n;
    bool per_metre; /* forces per length, N/m instead of N */
    bool no_memory; /* out of memory; the text is not at fault */
};

const char *unit_name(enum unit unit);
/* The usual units on a command line, separated by blanks. */
const char *unit_usual(enum unit unit);

/* Reads one number, with or without its unit, in SI. On RC_FAIL *err says what was expected. */
enum rc_status unit_number(const char *text, enum unit unit, double *value, struct rc_err *err);

/* True if a hardness is in Vickers units, 600HV or 600HV10: kilograms-force per square millimetre of the
 * sloping faces of the indentation. As a pressure it is the mean over the projected area, which is smaller by
 * the factor sin(68 degrees). */
bool unit_vickers(const char *text);
/* Pa: the mean over the sloping faces, HV times 9.80665 MPa, from this pressure. */
double unit_vickers_on_faces(double pressure);

/* A whole number as a size; SIZE_MAX if it is too large. */
static inline size_t
unit_size(double number)
{
    return number < (double)SIZE_MAX ? (size_t)number : SIZE_MAX;
}

/* The sum of two sizes; SIZE_MAX if it is too large. */
static inline size_t
size_sum(size_t a, size_t b)
{
    return b < SIZE_MAX - a ? a + b : SIZE_MAX;
}

/* `a,b,c`, where an entry may be a range: `a:b:n` (n values, both ends included) or `a:b:log:n` (the same
 * with equal ratios). Numbers with and without a unit in one list are an error, except 0. The caller frees
 * list->v. */
enum rc_status unit_numbers(const char *text, enum unit unit, struct numbers *list,
                            struct rc_err *err);
/* The same without units; a piece `A-B` has the whole numbers from A to B. */
enum rc_status unit_whole_numbers(const char *text, struct numbers *list, struct rc_err *err);
/* The same as unit_numbers for forces, which may all be forces per length, in N/m. */
enum rc_status unit_forces(const char *text, struct numbers *list, struct rc_err *err);
/* True if a list looks like one number with a decimal comma: two whole numbers without a unit, neither of
 * them ten times the other, or a 0 without a unit and a whole number that does not end with 0 (0,5m). */
bool unit_decimal_comma(const char *text);
/* Reads "K1,K2" in W/(m K) or S/m, both above 0. *conductance: the unit of the conductance, "W/K" or "S";
 * NULL: neither number has a unit. */
enum rc_status unit_conductivities(const char *text, double k[2], const char **conductance,
                                   struct rc_err *err);

#endif
