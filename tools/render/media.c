/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The materials of a section, from the key `layers`: for its lines, its legend and its values.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void
write_text(struct medium *m, const struct rc_layer *of, double residual)
{
    char what[TICKS_TEXT + 16] = "substrate";

    if (isfinite(of->thickness))
        snprintf(what, sizeof what, "layer of %s", scale_value(of->thickness, "m"));
    if (isinf(of->e))
        snprintf(m->text, sizeof m->text, "%.40s, rigid", what);
    else
        snprintf(m->text, sizeof m->text, "%.40s, E %.24s, \xce\xbd %.4g", what,
                 scale_value(of->e, "Pa"), of->nu);
    if (residual != 0)
        snprintf(m->text + strlen(m->text), sizeof m->text - strlen(m->text), ", residual %.24s",
                 scale_value(residual, "Pa"));
}

void
media_set(struct tool *t, const struct layers *c, struct figure *f)
{
    double bottom = 0;

    f->medium = NULL;
    f->media = c->layer == NULL ? 0 : c->body.layers + 1;
    if (f->media > 0)
        f->medium = tool_room(t, f->media, sizeof *f->medium, "the layers of a figure");
    for (size_t k = 0; k < f->media; k++) {
        f->medium[k].bottom = bottom += c->layer[k].thickness;
        write_text(&f->medium[k], &c->layer[k],
                   c->residual != NULL && k < c->body.layers ? c->residual[k] : 0);
    }
}

const char *
media_name(char text[MEDIA_NAME], const struct rc_grid *g)
{
    struct layers c;
    struct rc_err err;
    double number;
    bool last;

    if (!rc_grid_number(g, "material", &number) || !(number >= 1) ||
        layers_read(g, &c, &err) != RC_OK)
        return NULL;
    last = c.layer != NULL && number == (double)c.body.layers + 1;
    layers_free(&c);
    if (last)
        return "substrate";
    snprintf(text, MEDIA_NAME, "layer %.0f", number);
    return text;
}

double *
media_bottoms(const struct rc_grid *g, size_t *n)
{
    struct layers c;
    struct rc_err err;
    double *bottom = NULL;

    *n = 0;
    if (layers_read(g, &c, &err) != RC_OK || c.layer == NULL)
        return NULL;
    if ((bottom = malloc(c.body.layers * sizeof *bottom)) != NULL)
        for (*n = 0; *n < c.body.layers; ++*n)
            bottom[*n] = c.layer[*n].thickness + (*n == 0 ? 0 : bottom[*n - 1]);
    layers_free(&c);
    return bottom;
}
