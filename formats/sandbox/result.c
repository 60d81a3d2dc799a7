/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "result.h"

#include <string.h>

#include "formats/core/core.h"
#include "formats/rcg/rcg.h"

static bool
put(FILE *to, const void *from, size_t n)
{
    return fwrite(from, 1, n, to) == n;
}

bool
rc_result_receive(FILE *from, struct rc_result *r)
{
    struct rc_notes *noted = &r->noted;
    const size_t most = sizeof noted->text / sizeof *noted->text;

    if (fread(r, sizeof *r, 1, from) != 1)
        return false;
    r->said.text[sizeof r->said.text - 1] = '\0';
    noted->n = noted->n < most ? noted->n : most;
    for (size_t k = 0; k < most; k++)
        noted->text[k][sizeof noted->text[k] - 1] = '\0';
    return true;
}

/* ---- lists ---- */

bool
rc_result_send_list(FILE *to, const struct rc_result *r, const struct rc_maps *maps)
{
    const size_t sent = r->n < RC_MAPS_MOST ? r->n : RC_MAPS_MOST;
    RC_OWNED struct rc_channel *channel = calloc(sent + 1, sizeof *channel);

    if (channel == NULL)
        return false;
    rc_maps_list(maps, channel, sent);
    return put(to, r, sizeof *r) && put(to, channel, sent * sizeof *channel);
}

bool
rc_result_receive_list(FILE *from, const struct rc_result *r, struct rc_maps *maps)
{
    for (size_t k = 0; k < r->n && k < RC_MAPS_MOST; k++) {
        struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
        struct rc_channel c;

        if (fread(&c, sizeof c, 1, from) != 1)
            return false;
        c.name[sizeof c.name - 1] = c.unit[sizeof c.unit - 1] = '\0';
        strcpy(map->name, rc_text_harmless(c.name, ' ')); /* the names may come from the file */
        strcpy(map->unit, rc_text_harmless(c.unit, ' '));
        map->nx = c.nx;
        map->ny = c.ny;
        map->dx = c.dx;
        map->dy = c.dy;
        map->beside = c.beside;
    }
    maps->n = r->n;
    return true;
}

/* ---- grids ---- */

bool
rc_result_send_grid(FILE *to, const struct rc_result *r, struct rc_grid *g)
{
    RC_OWN(rc_writer, writer) = NULL;

    if (!put(to, r, sizeof *r) || r->n == 0)
        return r->n == 0;
    g->type = RC_F64;
    writer = rc_writer_new(to, NULL);
    return writer != NULL && rc_writer_put(writer, g, NULL) == RC_OK;
}

/* Checked before memory is allocated. */
static enum rc_status
fits(void *file, const struct rc_shape *shape, size_t bytes, struct rc_err *err)
{
    (void)bytes;
    return rc_map_fits(file, shape->nx, shape->ny, err);
}

struct rc_grid *
rc_result_receive_grid(FILE *from, const struct rc_file *file)
{
    struct rc_file of = *file;
    RC_OWN(rc_reader, reader) = rc_reader_new(from, 0, 0, NULL);
    struct rc_grid *g = NULL;

    if (reader == NULL)
        return NULL;
    rc_reader_ask(reader, fits, &of);
    if (rc_reader_next(reader, &g, NULL) != RC_MORE)
        g = NULL;
    return g;
}
