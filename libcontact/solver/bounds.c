/*
 * What the bounds of the pressure are, and what they can carry.
 */
#include "bounds.h"

#include <float.h>
#include <math.h>

struct rc_bounds
rc_bounds_of(const struct rc_problem *problem, size_t nodes)
{
    const double low = 0, high = problem->hardness == 0 ? INFINITY : problem->hardness;

    return (struct rc_bounds){.box = {.low = low, .high = high},
                              .unit = high - low,
                              .highest = isinf(high) ? low : high,
                              .open = isinf(high),
                              .floor = low * (double)nodes,
                              .full = high * (double)nodes};
}

void
rc_bounds_pose(const struct rc_bounds *b, struct rc_problem *problem)
{
    problem->hardness = b->box.high;
}

enum rc_status
rc_bounds_carry(const struct rc_bounds *b, double load, double cell, size_t nodes,
                struct rc_err *err)
{
    double area = cell * (double)nodes, most = b->box.high * area;

    if (load > most * (1 + 4 * DBL_EPSILON))
        return rc_err_set(err,
                          "load %.9g N is above hardness times area, %.9g Pa x %.9g m2 = "
                          "%.9g N, where every node yields: no solution exists; lower the "
                          "load or raise the hardness",
                          load, b->box.high, area, most);
    return RC_OK;
}
