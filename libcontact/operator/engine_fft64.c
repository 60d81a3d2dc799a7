/* Fast Fourier transforms in double precision throughout: beside it one sees what
 * single precision, where `fft` takes it, saves and costs. */
#include "engine_fft.h"

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    return rc_engine_fft_new(sum, RC_DOUBLE, err);
}

static size_t
memory(const struct rc_sum *sum)
{
    return rc_engine_fft_memory(sum, RC_DOUBLE);
}

const struct rc_engine rc_engine_fft64 = {
    .name = "fft64",
    .summary = "fast Fourier transforms in double precision: exact to rounding, whatever error is "
               "asked for",
    .memory = memory,
    .new = plan_new,
    .apply = rc_engine_fft_apply,
    .error = rc_engine_fft_error,
    .free = rc_engine_fft_free,
};
