#include "coating.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"
#include "tools/text/text.h"

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
coating_read(const struct rc_grid *p, struct coating *l, struct rc_err *err)
{
    const char *text = rc_grid_get(p, "layers"), *s = text;
    size_t most = 1;

    *l = (struct coating){.text = text};
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
            coating_free(l);
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
    coating_free(l);
    return rc_err_set(
        err,
        "its layers are '%.200s': they must be t,E,nu of each material in SI, the top "
        "first, joined by ;, the substrate last with t = inf",
        text);
}

void
coating_free(struct coating *l)
{
    free(l->layer);
    *l = (struct coating){0};
}

size_t
coating_material(const struct coating *l, double depth)
{
    return l->layer == NULL ? 0 : rc_coating_material(&l->coating, depth);
}

/* ---- the other way ---- */

enum rc_status
coating_layer(const char *text, struct rc_layer *m, struct rc_err *err)
{
    static const enum unit units[] = {UNIT_M, UNIT_PA, UNIT_NONE};
    double *to[] = {&m->thickness, &m->e, &m->nu};
    char word[64];

    for (int k = 0; k < 3; k++) {
        size_t n = strcspn(text, ",");
        if (n == 0 || n >= sizeof word || (text[n] == ',') == (k == 2))
            return rc_err_set(err, "a layer is THICKNESS,E,NU, as in 2um,300GPa,0.25");
        memcpy(word, text, n);
        word[n] = '\0';
        if (unit_number(word, units[k], to[k], err) != RC_OK)
            return RC_FAIL;
        text += n + 1;
    }
    if (!sensible(m, false))
        return rc_err_set(err,
                          "thickness and Young's modulus must be above 0, Poisson's ratio above "
                          "-1 and at most 0.5");
    return RC_OK;
}

enum rc_status
coating_set(struct rc_grid *g, const struct rc_coating *c, struct rc_err *err)
{
    size_t most = c == NULL ? 0 : (c->layers + 1) * (3 * RC_NUMBER_SIZE + 4), n = 0;
    char *text, t[RC_NUMBER_SIZE], e[RC_NUMBER_SIZE], nu[RC_NUMBER_SIZE];
    enum rc_status status;

    if (c == NULL)
        return rc_grid_set(g, "layers", NULL, err);
    if ((text = malloc(most)) == NULL)
        return rc_err_set(err, "out of memory for %zu layers", c->layers);
    for (size_t k = 0; k < c->layers; k++)
        n += (size_t)snprintf(text + n, most - n, "%s,%s,%s;",
                              rc_number_text(t, c->layer[k].thickness),
                              rc_number_text(e, c->layer[k].e), rc_number_text(nu, c->layer[k].nu));
    snprintf(text + n, most - n, "inf,%s,%s", rc_number_text(e, c->e), rc_number_text(nu, c->nu));
    status = rc_grid_set(g, "layers", text, err);
    free(text);
    return status;
}
