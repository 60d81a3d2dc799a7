#include "heights.h"

#include <math.h>
#include <string.h>

#include "maps.h"
#include "text.h"

struct rc_grid *
rc_heights_new(const struct rc_heights *h, const struct rc_file *file, const struct rc_wish *wish,
               double *metres, struct rc_notes *notes, struct rc_err *err)
{
    struct rc_shape shape = {.nx = h->nx, .ny = h->ny};
    struct rc_map other = {0};

    if (rc_map_fits(file, h->nx, h->ny, err) != RC_OK)
        return NULL;
    if (rc_spacing(wish, h->dx, h->dy, &shape, notes, err) != RC_OK) {
        if (isnan(h->dx) && *h->unit == '\0')
            rc_lacks_unit(wish, h->metres, err);
        return NULL;
    }
    if (h->name != NULL && isnan(h->metres) && isnan(wish->z_unit) && *h->unit != '\0') {
        rc_map_unit(&other, h->unit, strlen(h->unit));
        *metres = other.si;
        return rc_grid_new(&shape, h->name, other.unit, err);
    }
    if (rc_height_unit(wish, h->metres, h->unit, metres, notes, err) != RC_OK)
        return NULL;
    return rc_grid_new(&shape, "height", "m", err);
}

struct rc_channel
rc_heights_channel(const struct rc_heights *h, const char *name)
{
    struct rc_channel c = {.nx = h->nx, .ny = h->ny, .dx = h->dx, .dy = h->dy};
    struct rc_map other = {0};

    rc_text_clean(c.name, sizeof c.name, name, strlen(name));
    rc_map_unit(&other, h->unit, strlen(h->unit));
    strcpy(c.unit, isnan(h->metres) ? other.unit : "m");
    return c;
}

void
rc_heights_flip(struct rc_grid *g)
{
    for (size_t j = 0; j < g->ny / 2; j++)
        for (size_t i = 0; i < g->nx; i++) {
            double *a = &g->v[j * g->nx + i], *b = &g->v[(g->ny - 1 - j) * g->nx + i], kept = *a;
            *a = *b;
            *b = kept;
        }
}

enum rc_status
rc_heights_finite(struct rc_grid *g, struct rc_notes *notes, struct rc_err *err)
{
    size_t infinite = 0, finite = 0, first = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++) {
        finite += isfinite(g->v[k]) != 0;
        if (!isinf(g->v[k]))
            continue;
        if (infinite++ == 0)
            first = k;
        g->v[k] = NAN;
    }
    if (infinite > 0 && finite == 0)
        return rc_err_set(err, "every value that is there is infinite (%zu of %zu x %zu)", infinite,
                          g->nx, g->ny);
    if (infinite > 0)
        rc_note(notes,
                "%zu of %zu values %s infinite and read as missing, the first at column %zu, row "
                "%zu (from 0)",
                infinite, g->nx * g->ny, infinite == 1 ? "is" : "are", first % g->nx,
                first / g->nx);
    return RC_OK;
}
