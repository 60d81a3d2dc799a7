/* The stress of plastic strain in slices: their mean over a slab is what the volume's sweeps, which know no slices,
 * have for that slab; it adds to that of the pressure; a section is a row of a map. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/volume/volume_case.h"

enum {
    NX = 18,
    NY = 15,
    NODES = NX * NY,
    SLABS = 5
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};
static const double thickness[SLABS] = {0.5e-6, 0.7e-6, 0.4e-6, 1e-6, 1.3e-6};
static const double e = 2e11, nu = 0.28;

struct strained {
    struct voxels e;
    const double *map[SLABS * STRAINS];
    struct rc_eigenstrain strain;
    double p[NODES];
};

static void
make(struct strained *s)
{
    uint64_t seed = 11;

    s->e = voxels_new(shape, SLABS);
    voxels_random(&s->e, 0x1b, &seed); /* one of them has none */
    for (size_t k = 0; k < SLABS; k++)
        for (size_t c = 0; c < STRAINS; c++)
            s->map[k * STRAINS + c] = k == 2 ? NULL : voxels_map(&s->e, k, strains[c]);
    s->strain = (struct rc_eigenstrain){.slabs = SLABS, .thickness = thickness, .map = s->map};
    for (size_t k = 0; k < NODES; k++)
        s->p[k] = 1e9 * (random_number(&seed) + 0.5);
}

static struct rc_stress_options
options_of(const struct strained *s, bool strain, unsigned wanted)
{
    return (struct rc_stress_options){.boundary = RC_PERIODIC,
                                      .body = {.e = e, .nu = nu},
                                      .wanted = wanted,
                                      .threads = 2,
                                      .strain = strain ? &s->strain : NULL};
}

/* All six, and Mises, of a depth. */
static void
slice(const struct strained *s, const double *p, bool strain, double depth, double (*to)[NODES])
{
    const struct rc_stress_options o = options_of(s, strain, (2U << RC_MISES) - 1);
    double *const at[RC_STRESSES] = {to[0], to[1], to[2], to[3], to[4], to[5], to[6]};
    struct rc_stress *stress;
    struct rc_err err;

    stress = rc_stress_new(&shape, p, &o, &err);
    assert_non_null(stress);
    assert_int_equal(rc_stress_slice(stress, depth, at, &err), RC_OK);
    rc_stress_free(stress);
}

/* Gauss's rule of five points over each slab. */
static void
slices_average_to_slabs(void **state)
{
    static const double place[] = {0, 0.5384693101056831, 0.9061798459386640};
    static const double weight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    static struct strained s;
    static double at[RC_COMPONENTS + 1][NODES];
    struct rc_slabs *v = volume_new(shape, (struct rc_slabs_options){.slabs = SLABS,
                                                                     .thickness = thickness,
                                                                     .shear = e / (2 * (1 + nu)),
                                                                     .nu = nu,
                                                                     .whole = true});
    struct voxels sum, known;
    double zero[NODES] = {0}, top = 0;

    (void)state;
    make(&s);
    sum = voxels_new(shape, SLABS);
    known = voxels_new(shape, SLABS);
    volume_apply(v, &s.e, NULL, NULL, NULL, &known);
    for (size_t k = 0; k < SLABS; k++) {
        for (int g = -2; g <= 2; g++) {
            size_t a = (size_t)abs(g);
            double side = g < 0 ? -place[a] : place[a];
            slice(&s, zero, true, top + thickness[k] * (1 + side) / 2, at);
            for (int c = 0; c < RC_COMPONENTS; c++)
                for (size_t i = 0; i < NODES; i++)
                    voxels_map(&sum, k, (enum rc_component)c)[i] += weight[a] / 2 * at[c][i];
        }
        top += thickness[k];
    }
    print_message("slices average to slabs within %.1e\n", voxels_apart(&sum, &known));
    assert_true(voxels_apart(&sum, &known) <
                2e-4); /* slices are thin slabs of a hundredth of a node */
    rc_slabs_free(v);
    free(s.e.v);
    free(sum.v);
    free(known.v);
}

static void
adds_to_the_pressure(void **state)
{
    static struct strained s;
    static double both[RC_COMPONENTS + 1][NODES], alone[RC_COMPONENTS + 1][NODES];
    static double pressed[RC_COMPONENTS + 1][NODES];
    double zero[NODES] = {0};

    (void)state;
    make(&s);
    for (int q = 0; q < 3; q++) { /* the surface, a slab, below all */
        double depth = q == 0 ? 0 : q == 1 ? 1.3e-6 : 5e-6, most = 0;
        slice(&s, s.p, true, depth, both);
        slice(&s, zero, true, depth, alone);
        slice(&s, s.p, false, depth, pressed);
        for (int c = 0; c < RC_COMPONENTS; c++)
            for (size_t i = 0; i < NODES; i++)
                most = fmax(most, fabs(both[c][i] - alone[c][i] - pressed[c][i]));
        assert_true(most < 1e-3); /* Pa, of GPa */
        for (size_t i = 0; i < NODES; i++) {
            double xx = both[0][i], yy = both[1][i], zz = both[2][i], shear = 0;
            for (int c = RC_SXY; c <= RC_SYZ; c++)
                shear += both[c][i] * both[c][i];
            assert_true(
                fabs(sqrt(((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) /
                              2 +
                          3 * shear) -
                     both[RC_MISES][i]) < 1);
            if (q == 0) /* nothing pulls at the surface but the pressure; the slice is thin */
                assert_true(fabs(alone[RC_SZZ][i]) < 1e-2 * 1e-3 * e);
        }
    }
    free(s.e.v);
}

static void
sections(void **state)
{
    static struct strained s;
    static double map[RC_COMPONENTS + 1][NODES];
    double line[NX + NY], zero[NODES] = {0};
    struct rc_stress *stress;
    struct rc_err err;

    (void)state;
    make(&s);
    slice(&s, zero, true, 1.4e-6, map);
    for (int q = 0; q < 3; q++) { /* a row; a column; between two columns */
        struct rc_stress_options o = options_of(&s, true, 1U << RC_SXX);
        double *const to[RC_STRESSES] = {line};
        o.section = q == 0 ? 'y' : 'x';
        o.at = q == 0 ? 3 * shape.dy : q == 1 ? 1.5 * shape.dx : 2 * shape.dx;
        stress = rc_stress_new(&shape, zero, &o, &err);
        assert_non_null(stress);
        assert_int_equal(rc_stress_slice(stress, 1.4e-6, to, &err), RC_OK);
        for (size_t i = 0; i < (q == 0 ? NX : NY); i++) {
            const double *row = map[RC_SXX] + i * NX;
            double is = q == 0   ? map[RC_SXX][(NY / 2 + 3) * NX + i]
                        : q == 1 ? row[NX / 2 + 1]
                                 : (row[NX / 2 + 1] + row[NX / 2 + 2]) / 2;
            assert_true(fabs(line[i] - is) < 1e-3);
        }
        rc_stress_free(stress);
    }
    free(s.e.v);
}

static void
refused(void **state)
{
    static struct strained s;
    struct rc_stress_options o;
    struct rc_err err;

    (void)state;
    make(&s);
    for (int q = 0; q < 3; q++) {
        o = options_of(&s, true, 1);
        if (q == 0)
            o.body.e = INFINITY;
        else if (q == 1)
            o.body.e = 0;
        else
            s.strain.slabs = 0;
        assert_int_equal(rc_stress_check(&shape, &o, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "plastic strain"));
    }
    free(s.e.v);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slices_average_to_slabs),
        cmocka_unit_test(adds_to_the_pressure),
        cmocka_unit_test(sections),
        cmocka_unit_test(refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
