/*
 * Stress slices: the pressure is transformed once; each component and depth costs the evaluation of
 * its kernel, the transform of a quarter of it, one multiplication and one transform back.
 */
#include "fft.h"

#include <math.h>
#include <stdlib.h>

struct rc_stress {
    double nu;
    struct rc_fft *fft;
    struct rc_spectrum *kernel;
};

const char *const rc_component_names[RC_COMPONENTS] = {"sxx", "syy", "szz", "sxy", "sxz", "syz"};

struct rc_stress *
rc_stress_new(const struct rc_shape *shape, const double *p, double nu, size_t threads,
              struct rc_err *err)
{
    struct rc_stress *stress;

    if (!(nu > -1 && nu <= 0.5)) {
        rc_err_set(err, "Poisson's ratio %g: it must be above -1 and at most 0.5", nu);
        return NULL;
    }
    stress = calloc(1, sizeof *stress);
    if (stress == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    stress->nu = nu;
    if ((stress->fft = rc_fft_new(shape, RC_FREE, RC_DOUBLE, threads, err)) == NULL ||
        (stress->kernel = rc_spectrum_new(stress->fft, err)) == NULL ||
        rc_fft_load(stress->fft, p, err) != RC_OK) {
        rc_stress_free(stress);
        return NULL;
    }
    return stress;
}

enum rc_status
rc_stress_slice(struct rc_stress *stress, enum rc_component component, double depth, double *s,
                struct rc_err *err)
{
    struct rc_medium medium = {.nu = stress->nu, .depth = depth};

    if (!(depth >= 0) || isinf(depth))
        return rc_err_set(err, "depth %g m: it must be finite and not negative", depth);
    if (rc_spectrum_set(stress->kernel, stress->fft, &rc_kernel_stress, component, &medium, err) !=
        RC_OK)
        return RC_FAIL;
    rc_fft_field(stress->fft, stress->kernel, s);
    return RC_OK;
}

void
rc_stress_free(struct rc_stress *stress)
{
    if (stress == NULL)
        return;
    rc_fft_free(stress->fft);
    rc_spectrum_free(stress->kernel);
    free(stress);
}

size_t
rc_stress_memory(const struct rc_shape *shape)
{
    /* the plan, the whole transform of p (two quarters of complex numbers), the kernel's
     * table */
    return rc_fft_memory(shape, RC_FREE, RC_DOUBLE) +
           5 * rc_spectrum_memory(shape, RC_FREE, RC_DOUBLE);
}

void
rc_mises(size_t n, const double *const s[RC_COMPONENTS], double *mises)
{
    for (size_t k = 0; k < n; k++) {
        double a = s[RC_SXX][k] - s[RC_SYY][k];
        double b = s[RC_SYY][k] - s[RC_SZZ][k];
        double c = s[RC_SZZ][k] - s[RC_SXX][k];
        double t = s[RC_SXY][k] * s[RC_SXY][k] + s[RC_SXZ][k] * s[RC_SXZ][k] +
                   s[RC_SYZ][k] * s[RC_SYZ][k];
        mises[k] = sqrt((a * a + b * b + c * c) / 2 + 3 * t);
    }
}
