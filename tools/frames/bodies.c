/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bodies.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"
#include "tools/text/text.h"

enum {
    MOST = 1000 /* most materials: enough for a graded one */
};

/* Reads "t,E,nu" at *text and moves *text behind it. */
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

static enum rc_status
read_residual(const struct rc_grid *p, struct layers *l, struct rc_err *err)
{
    const char *text = rc_grid_get(p, "layers.residual"), *s = text;

    if (text == NULL)
        return RC_OK;
    if ((l->residual = calloc(l->body.layers, sizeof *l->residual)) == NULL)
        return rc_err_set(err, "out of memory for %zu layers", l->body.layers);
    for (size_t k = 0; k < l->body.layers && s != NULL; k++) {
        s = k > 0 && *s++ != ';' ? NULL : rc_number_read(s, false, &l->residual[k]);
        s = s != NULL && isfinite(l->residual[k]) ? s : NULL;
    }
    if (s != NULL && *s == '\0')
        return RC_OK;
    layers_free(l);
    return rc_err_set(
        err,
        "its layers.residual is '%.200s': it must be a stress in Pa for each layer, the "
        "top first, joined by ;",
        text);
}

enum rc_status
layers_read(const struct rc_grid *p, struct layers *l, struct rc_err *err)
{
    const char *text = rc_grid_get(p, "layers"), *s = text;
    size_t most = 1;

    *l = (struct layers){.text = text};
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
            layers_free(l);
            return rc_err_set(
                err,
                "material %zu of its layers '%.200s' is impossible: thickness and Young's modulus "
                "must be above 0, Poisson's ratio above -1 and at most 0.5, and the substrate "
                "alone has t = inf and may be rigid, E = inf",
                k + 1, text);
        }
    l->body = (struct rc_body){.e = l->layer[most - 1].e,
                               .nu = l->layer[most - 1].nu,
                               .layers = most - 1,
                               .layer = l->layer};
    return read_residual(p, l, err);
wrong:
    layers_free(l);
    return rc_err_set(
        err,
        "its layers are '%.200s': they must be t,E,nu of each material in SI, the top "
        "first, joined by ;, the substrate last with t = inf",
        text);
}

void
layers_free(struct layers *l)
{
    free(l->layer);
    free(l->residual);
    *l = (struct layers){0};
}

/* ---- on a command line ---- */

enum rc_status
layer_read(const char *text, struct rc_layer *m, double *residual, double relaxes, bool *is,
           struct rc_err *err)
{
    static const enum unit units[] = {UNIT_M, UNIT_PA, UNIT_NONE, UNIT_PA};
    double *to[] = {&m->thickness, &m->e, &m->nu, residual};
    bool last = false;
    char word[64];

    *residual = 0;
    *is = false;
    for (int k = 0; k < 4 && !last; k++) {
        size_t n = strcspn(text, ",");
        last = text[n] == '\0';
        if (n == 0 || n >= sizeof word || (k < 2 && last) || (k == 3 && !last))
            return rc_err_set(err, "a layer is THICKNESS,E,NU or THICKNESS,E,NU,RESIDUAL, as in "
                                   "2um,300GPa,0.25 or 2um,300GPa,0.25,-3GPa");
        memcpy(word, text, n);
        word[n] = '\0';
        if (k == 1 && relaxes > 0 && strcmp(word, LAYER_RELAXES) == 0) {
            *is = true;
            m->e = relaxes;
        } else if (unit_number(word, units[k], to[k], err) != RC_OK) {
            return RC_FAIL;
        }
        text += n + 1;
    }
    if (!sensible(m, false))
        return rc_err_set(err,
                          "thickness and Young's modulus must be above 0, Poisson's ratio above "
                          "-1 and at most 0.5");
    return RC_OK;
}

/* ---- the pair ---- */

double
bodies_compliance(double e, double nu)
{
    return e == 0 || isinf(e) ? 0 : (1 - nu * nu) / e;
}

static double
estar_of(const struct rc_pair *p)
{
    return p->estar > 0 ? p->estar
                        : 1 / (bodies_compliance(p->one.e, p->one.nu) +
                               bodies_compliance(p->two.e, p->two.nu));
}

enum rc_status
bodies_read(const struct rc_grid *g, const struct layers *l, struct rc_pair *p, struct rc_err *err)
{
    double estar = NAN, of_these;

    *p = (struct rc_pair){.one = l->body};
    if (rc_grid_get(g, "estar") != NULL && (!rc_grid_number(g, "estar", &estar) || !(estar > 0)))
        return rc_err_set(err, "its estar '%.40s' is not a modulus", rc_grid_get(g, "estar"));
    if (l->text == NULL) {
        p->estar = estar;
        return isnan(estar) ? rc_err_set(err, "E* is not in the stream: give it with --estar")
                            : RC_OK;
    }
    if (rc_grid_get(g, "e2") != NULL &&
        (!rc_grid_number(g, "e2", &p->two.e) || !rc_grid_number(g, "nu2", &p->two.nu)))
        return rc_err_set(err, "its e2 '%.40s' and nu2 '%.40s' are not a material",
                          rc_grid_get(g, "e2"),
                          rc_grid_get(g, "nu2") == NULL ? "" : rc_grid_get(g, "nu2"));
    of_these = estar_of(p);
    if (!isnan(estar) && !(fabs(of_these / estar - 1) < 1e-9))
        return rc_err_set(err,
                          "its substrate and body 2 (%s) have E* = %.9g Pa, but its estar is %.9g "
                          "Pa: the stream does not define body 2; solve the contact again",
                          p->two.e == 0 ? "rigid, because there is no e2" : "e2, nu2", of_these,
                          estar);
    return RC_OK;
}

void
bodies_demand_elastic(struct tool *t, const struct rc_grid *g, const char *remedy)
{
    static const char *const marks[] = {"time", "speed"};

    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++)
        if (rc_grid_get(g, marks[k]) != NULL)
            tool_refuse(
                t, g,
                "its body 1 is viscoelastic (%s=%s), and its moduli in the stream are those of "
                "fast loads: %s",
                marks[k], rc_grid_get(g, marks[k]), remedy);
}

/* Writes the key `layers` of a layered body. */
static void
set_layers(struct tool *t, struct rc_grid *g, const struct rc_body *b)
{
    size_t most = (b->layers + 1) * (3 * RC_NUMBER_SIZE + 4), n = 0;
    RC_OWNED char *text = tool_room(t, most, 1, "the layers");

    for (size_t k = 0; k < b->layers; k++)
        n += (size_t)snprintf(text + n, most - n, "%s,%s,%s;", rc_number(b->layer[k].thickness),
                              rc_number(b->layer[k].e), rc_number(b->layer[k].nu));
    snprintf(text + n, most - n, "inf,%s,%s", rc_number(b->e), rc_number(b->nu));
    tool_set(t, g, "layers", b->layers > 0 ? text : NULL);
}

static void
set_residual(struct tool *t, struct rc_grid *g, const struct rc_body *b, const double *residual)
{
    size_t most = (b->layers + 1) * (RC_NUMBER_SIZE + 1), n = 0;
    RC_OWNED char *text = tool_room(t, most, 1, "the layers");

    for (size_t k = 0; k < b->layers && residual != NULL; k++)
        n +=
            (size_t)snprintf(text + n, most - n, "%s%s", k == 0 ? "" : ";", rc_number(residual[k]));
    tool_set(t, g, "layers.residual", n > 0 ? text : NULL);
}

void
bodies_set(struct tool *t, struct rc_grid *g, const struct rc_pair *p, const double *residual)
{
    bool known = p->estar == 0, elastic = known && p->two.e > 0 && !isinf(p->two.e);

    tool_set_number(t, g, "estar", estar_of(p));
    tool_set_number(t, g, "e1", known ? p->one.e : NAN);
    tool_set_number(t, g, "nu", known ? p->one.nu : NAN);
    tool_set_number(t, g, "e2", elastic ? p->two.e : NAN);
    tool_set_number(t, g, "nu2", elastic ? p->two.nu : NAN);
    set_layers(t, g, &p->one);
    set_residual(t, g, &p->one, residual);
}
