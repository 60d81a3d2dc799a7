/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "quadrature.h"

#include <math.h>

/* Distance over the half side of a cell from which a rule of this number of points in that direction is
 * used. */
static const struct rule {
    double from;
    int points;
} rules[] = {{3, 12}, {4, 9}, {6, 8}, {8, 7}, {10, 6}, {17, 5}, {38, 4}, {160, 3}};

enum {
    RULES = sizeof rules / sizeof *rules
};

/* Abscissas and weights of Gauss's rules on (-1, 1), the positive half of each (Abramowitz and
 * Stegun 1964, 25.4). */
static const struct rc_gauss gauss3[] = {{0, 0.888888888888888889},
                                         {0.774596669241483377, 0.555555555555555556}},
                             gauss4[] = {{0.339981043584856265, 0.652145154862546143},
                                         {0.861136311594052575, 0.347854845137453857}},
                             gauss5[] = {{0, 0.568888888888888889},
                                         {0.538469310105683091, 0.478628670499366468},
                                         {0.906179845938663993, 0.236926885056189088}},
                             gauss6[] = {{0.238619186083196909, 0.467913934572691047},
                                         {0.661209386466264514, 0.360761573048138608},
                                         {0.932469514203152028, 0.171324492379170345}},
                             gauss7[] = {{0, 0.417959183673469388},
                                         {0.405845151377397167, 0.381830050505118945},
                                         {0.741531185599394440, 0.279705391489276668},
                                         {0.949107912342758525, 0.129484966168869693}},
                             gauss8[] = {{0.183434642495649805, 0.362683783378361983},
                                         {0.525532409916328986, 0.313706645877887287},
                                         {0.796666477413626740, 0.222381034453374471},
                                         {0.960289856497536232, 0.101228536290376259}},
                             gauss9[] = {{0, 0.330239355001259763},
                                         {0.324253423403808929, 0.312347077040002840},
                                         {0.613371432700590397, 0.260610696402935462},
                                         {0.836031107326635794, 0.180648160694857404},
                                         {0.968160239507626090, 0.081274388361574412}},
                             gauss12[] = {{0.125233408511468916, 0.249147045813402785},
                                          {0.367831498998180194, 0.233492536538354809},
                                          {0.587317954286617447, 0.203167426723065922},
                                          {0.769902674194304687, 0.160078328543346226},
                                          {0.904117256370474857, 0.106939325995318431},
                                          {0.981560634246719251, 0.047175336386511827}};
static const struct rc_gauss *const halves[RC_GAUSS_MOST + 1] = {
    [3] = gauss3, [4] = gauss4, [5] = gauss5, [6] = gauss6,
    [7] = gauss7, [8] = gauss8, [9] = gauss9, [12] = gauss12};

struct rc_gauss
rc_gauss_point(int n, int k)
{
    int half = n / 2, from = k - half;
    struct rc_gauss g;

    if (n % 2 == 0)
        g = halves[n][from >= 0 ? from : -from - 1];
    else
        g = halves[n][from >= 0 ? from : -from];
    if (from < 0)
        g.x = -g.x;
    return g;
}

int
rc_gauss_points(double distance, double half_side, double *low, double *high)
{
    int k = -1;

    while (k + 1 < RULES && distance >= rules[k + 1].from * half_side)
        k++;
    if (k >= 0)
        *low = fmax(*low, rules[k].from * half_side);
    if (k + 1 < RULES)
        *high = fmin(*high, rules[k + 1].from * half_side);
    return k < 0 ? 0 : rules[k].points;
}

/* f + d2/24 - 17 d4/5760 + 367 d6/967680, with the central differences d2, d4, d6. */
const double rc_mean_of[RC_MEAN_REACH + 1] = {
    1 - 2 / 24.0 - 6 * 17 / 5760.0 - 20 * 367 / 967680.0,
    1 / 24.0 + 4 * 17 / 5760.0 + 15 * 367 / 967680.0,
    -17 / 5760.0 - 6 * 367 / 967680.0,
    367 / 967680.0,
};
