/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The yield stress: a straight line, or straight lines between the points of a table. Beyond its last point
 * the last line continues.
 */
#include "law.h"

enum rc_status
rc_yield_law_check(const struct rc_yield_law *law, struct rc_err *err)
{
    if (law->points == 0 && (!(law->stress > 0) || isinf(law->stress)))
        return rc_err_set(err, "yield stress %g Pa: it must be positive and finite", law->stress);
    if (law->points == 0 && (!(law->modulus >= 0) || isinf(law->modulus)))
        return rc_err_set(err, "hardening modulus %g Pa: it must not be negative", law->modulus);
    for (size_t k = 0; k < law->points; k++) {
        double least = k > 0 ? law->stress_at[k - 1] : 0;
        if (k == 0 ? law->strain_at[0] != 0 : !(law->strain_at[k] > law->strain_at[k - 1]))
            return rc_err_set(err,
                              "hardening curve, point %zu: plastic strain %g: it must begin at 0 "
                              "and grow",
                              k + 1, law->strain_at[k]);
        if (!(law->stress_at[k] >= least) || !(law->stress_at[k] > 0) || isinf(law->stress_at[k]))
            return rc_err_set(err,
                              "hardening curve, point %zu: stress %g Pa: it must be positive and "
                              "must not fall",
                              k + 1, law->stress_at[k]);
    }
    return RC_OK;
}

/* A straight part of the law. */
struct part {
    double strain, stress, modulus, end; /* its start, its slope, and the strain at its end */
};

static struct part
part_at(const struct rc_yield_law *law, double strain)
{
    struct part p = {0, law->stress, law->modulus, INFINITY};
    size_t k = 0;

    if (law->points == 0)
        return p;
    while (k + 2 < law->points && strain >= law->strain_at[k + 1])
        k++;
    p = (struct part){law->strain_at[k], law->stress_at[k], 0, INFINITY};
    if (k + 1 < law->points) {
        p.modulus = (law->stress_at[k + 1] - p.stress) / (law->strain_at[k + 1] - p.strain);
        p.end = k + 2 < law->points ? law->strain_at[k + 1] : INFINITY;
    }
    return p;
}

double
rc_yield_law_stress(const struct rc_yield_law *law, double strain)
{
    struct part p = part_at(law, strain);

    return p.stress + p.modulus * (strain - p.strain);
}

double
rc_yield_law_work(const struct rc_yield_law *law, double strain)
{
    double work = 0, from = 0;

    while (from < strain) {
        struct part p = part_at(law, from);
        double to = fmin(p.end, strain), middle = (from + to) / 2;
        work += (to - from) * (p.stress + p.modulus * (middle - p.strain));
        from = to;
    }
    return work;
}

double
rc_yield_law_return(const struct rc_yield_law *law, double stiffness, double strain, double mises)
{
    double from = strain, grown = 0;

    for (;;) {
        struct part p = part_at(law, from);
        double above = mises - stiffness * grown - (p.stress + p.modulus * (from - p.strain));
        double by = above / (stiffness + p.modulus);
        if (!(above > 0))
            return grown;
        if (from + by <= p.end)
            return grown + by;
        grown = p.end - strain;
        from = p.end;
    }
}
