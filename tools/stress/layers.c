/* What a coated body is made of, from the key `layers` of a pressure. */
#include "stress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST = 1000 /* materials: enough for one that changes gradually */
};

/* "t,E,nu" at *text, which goes to what follows it. */
static bool
read_material(const char **text, struct rc_layer *m)
{
    double *to[] = {&m->thickness, &m->e, &m->nu};
    const char *s = *text;

    for (int k = 0; k < 3; k++) {
        if ((k > 0 && *s++ != ',') || (s = rc_number_read(s, true, to[k])) == NULL)
            return false;
    }
    *text = s;
    return true;
}

static bool
sensible(const struct rc_layer *m, bool last)
{
    bool rigid = last && isinf(m->e);

    return m->thickness > 0 && !isinf(m->thickness) == !last && m->e > 0 &&
           (rigid || !isinf(m->e)) && m->nu > -1 && m->nu <= 0.5;
}

enum rc_status
stress_layers_read(const struct rc_grid *p, struct stress_layers *l, struct rc_err *err)
{
    const char *text = rc_grid_get(p, "layers"), *s = text;
    size_t most = 1;

    *l = (struct stress_layers){.text = text};
    if (text == NULL)
        return RC_OK;
    for (; *s != '\0'; s++)
        most += *s == ';';
    if (most < 2)
        goto wrong;
    if (most > MOST)
        return rc_err_set(err, "its layers are of %zu materials: at most %d are taken", most, MOST);
    if ((l->layer = calloc(most, sizeof *l->layer)) == NULL)
        return rc_err_set(err, "out of memory for %zu layers", most - 1);
    s = text;
    for (size_t k = 0; k < most; k++)
        if ((k > 0 && *s++ != ';') || !read_material(&s, &l->layer[k]))
            goto wrong;
    if (*s != '\0')
        goto wrong;
    for (size_t k = 0; k < most; k++)
        if (!sensible(&l->layer[k], k + 1 == most)) {
            stress_layers_free(l);
            return rc_err_set(
                err,
                "material %zu of its layers '%.200s' cannot be: thickness and Young's "
                "modulus must be above 0, Poisson's ratio above -1 and at most 0.5, "
                "and the substrate alone has t = inf and may be rigid, E = inf",
                k + 1, text);
        }
    l->coating = (struct rc_coating){.layers = most - 1,
                                     .layer = l->layer,
                                     .e = l->layer[most - 1].e,
                                     .nu = l->layer[most - 1].nu};
    return RC_OK;
wrong:
    stress_layers_free(l);
    return rc_err_set(
        err,
        "its layers are '%.200s': they must be t,E,nu of each material in SI, the top "
        "first, joined by ;, the substrate last with t = inf",
        text);
}

void
stress_layers_free(struct stress_layers *l)
{
    free(l->layer);
    *l = (struct stress_layers){0};
}

size_t
stress_materials(const struct rc_stress_options *o)
{
    return o->coating == NULL ? 1 : o->coating->layers + 1;
}

size_t
stress_material(const struct rc_stress_options *o, double depth)
{
    return o->coating == NULL ? 0 : rc_coating_material(o->coating, depth);
}
