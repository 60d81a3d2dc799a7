/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the tests of leakage: a complete solution of a flow, with its maps. */
#ifndef LEAK_CASE_H
#define LEAK_CASE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact.h"
#include "tests/exact.h"

struct leak_flow {
    struct rc_leak_figures f;
    double *pressure, *flux, *channel; /* freed by leak_flow_free */
};

static inline struct leak_flow
leak_flow(struct rc_shape s, const double *p, const double *g, char direction, bool around)
{
    const struct rc_leak_options options = {.direction = direction, .around = around};
    size_t n = s.nx * s.ny;
    struct leak_flow flow = {.pressure = malloc(n * sizeof(double)),
                             .flux = malloc(n * sizeof(double)),
                             .channel = malloc(n * sizeof(double))};
    struct rc_err err = {""};
    struct rc_leak *leak = rc_leak_new(&s, p, g, &options, &err);
    enum rc_status status;

    if (leak == NULL) {
        fprintf(stderr, "%s\n", err.text);
        abort();
    }
    while ((status = rc_leak_step(leak, &err)) == RC_MORE)
        continue;
    if (status != RC_OK) {
        fprintf(stderr, "%s\n", err.text);
        abort();
    }
    flow.f = *rc_leak_result(leak);
    rc_leak_pressure(leak, flow.pressure);
    rc_leak_flux(leak, flow.flux);
    rc_leak_channel(leak, flow.channel);
    rc_leak_free(leak);
    return flow;
}

static inline void
leak_flow_free(struct leak_flow *flow)
{
    free(flow->pressure);
    free(flow->flux);
    free(flow->channel);
}

static inline struct rc_leak_figures
leak_figures(struct rc_shape s, const double *p, const double *g, char direction, bool around)
{
    struct leak_flow flow = leak_flow(s, p, g, direction, around);

    leak_flow_free(&flow);
    return flow.f;
}

/* A random number from 0 up to 1. */
static inline double
leak_random(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

#endif
