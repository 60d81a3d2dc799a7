#include "result.h"

#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "child_memory.h"
#include "formats/core/core.h"

enum {
    TEXT_MOST = 65536, /* bytes of a key's value */
    KEYS_MOST = 256,
    COPIED = 1, /* reply: the parent has copied the values, */
    WANTED      /* or they are to come through the pipe     */
};

static bool
put(FILE *to, const void *from, size_t n)
{
    return fwrite(from, 1, n, to) == n;
}

static bool
get(FILE *from, void *to, size_t n)
{
    return fread(to, 1, n, from) == n;
}

static bool
get_err(FILE *from, struct rc_err *said)
{
    bool good = get(from, said, sizeof *said);

    said->text[sizeof said->text - 1] = '\0';
    return good;
}

/* ---- lists ---- */

bool
rc_result_send_list(struct rc_pipes *p, const struct rc_channel *channel, size_t n, size_t most,
                    const struct rc_err *said)
{
    return put(p->result, &n, sizeof n) && put(p->result, said, sizeof *said) &&
           put(p->result, channel, (n < most ? n : most) * sizeof *channel);
}

bool
rc_result_receive_list(struct rc_pipes *p, struct rc_channel *channel, size_t *n, size_t most,
                       struct rc_err *said)
{
    size_t shown;

    if (!get(p->result, n, sizeof *n) || !get_err(p->result, said))
        return false;
    shown = *n < most ? *n : most;
    if (!get(p->result, channel, shown * sizeof *channel))
        return false;
    for (size_t k = 0; k < shown; k++) {
        channel[k].name[sizeof channel->name - 1] = '\0';
        channel[k].unit[sizeof channel->unit - 1] = '\0';
        rc_text_harmless(channel[k].name, ' '); /* the names may come from the file */
        rc_text_harmless(channel[k].unit, ' ');
    }
    return true;
}

/* ---- grids ---- */

/* A text as its length and its bytes. */
static bool
put_text(FILE *to, const char *text)
{
    size_t n = strlen(text);

    return put(to, &n, sizeof n) && put(to, text, n);
}

static char *
get_text(FILE *from)
{
    char *text = NULL;
    size_t n;

    if (!get(from, &n, sizeof n) || n >= TEXT_MOST || (text = malloc(n + 1)) == NULL)
        return NULL;
    text[n] = '\0';
    if (get(from, text, n))
        return text;
    free(text);
    return NULL;
}

static bool
put_values(struct rc_pipes *p, const struct rc_grid *g)
{
    uint64_t at = (uintptr_t)g->v;
    unsigned char reply;

    if (!put(p->result, &at, sizeof at) || fflush(p->result) != 0 || read(p->reply, &reply, 1) != 1)
        return false;
    return reply == COPIED || put(p->result, g->v, g->nx * g->ny * sizeof *g->v);
}

static bool
get_values(struct rc_pipes *p, struct rc_grid *g)
{
    size_t bytes = g->nx * g->ny * sizeof *g->v;
    uint64_t at;
    unsigned char reply;

    if (!get(p->result, &at, sizeof at))
        return false;
    reply = rc_child_memory_copy(p->child, at, g->v, bytes) ? COPIED : WANTED;
    p->held = rc_child_memory_held(p->child);
    if (send(p->reply, &reply, 1, MSG_NOSIGNAL) != 1)
        return false;
    return reply == COPIED || get(p->result, g->v, bytes);
}

bool
rc_result_send_grid(struct rc_pipes *p, const struct rc_grid *g, const struct rc_notes *noted,
                    const struct rc_err *said)
{
    unsigned char good = g != NULL;
    struct rc_shape shape;
    bool whole;

    if (!put(p->result, &good, 1) || !put(p->result, noted, sizeof *noted) ||
        !put(p->result, said, sizeof *said) || g == NULL)
        return g == NULL;
    shape = rc_grid_shape(g);
    whole = put(p->result, &shape, sizeof shape) && put_text(p->result, g->channel) &&
            put_text(p->result, g->unit) && put(p->result, &g->keys, sizeof g->keys);
    for (size_t k = 0; whole && k < g->keys; k++)
        whole = put_text(p->result, g->key[k].name) && put_text(p->result, g->key[k].value);
    return whole && put_values(p, g);
}

static bool
get_key(FILE *from, struct rc_grid *g)
{
    char *name = get_text(from), *value = name == NULL ? NULL : get_text(from);
    bool good = value != NULL && rc_grid_set(g, name, value, NULL) == RC_OK;

    free(name);
    free(value);
    return good;
}

/* The shape and the keys are bounded before memory is taken for them. */
static struct rc_grid *
get_grid(struct rc_pipes *p, const struct rc_file *file)
{
    char *channel = NULL, *unit = NULL;
    struct rc_grid *g = NULL;
    struct rc_shape shape;
    bool good = false;
    size_t keys;

    if (!get(p->result, &shape, sizeof shape) ||
        rc_map_fits(file, shape.nx, shape.ny, NULL) != RC_OK ||
        (channel = get_text(p->result)) == NULL || (unit = get_text(p->result)) == NULL ||
        !get(p->result, &keys, sizeof keys) || keys > KEYS_MOST ||
        (g = rc_grid_new(&shape, channel, unit, NULL)) == NULL)
        goto done;
    for (good = true; good && keys > 0; keys--)
        good = get_key(p->result, g);
    good = good && get_values(p, g);
done:
    free(channel);
    free(unit);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

bool
rc_result_receive_grid(struct rc_pipes *p, const struct rc_file *file, struct rc_grid **g,
                       struct rc_notes *noted, struct rc_err *said)
{
    const size_t most = sizeof noted->text / sizeof *noted->text;
    unsigned char good;

    *g = NULL;
    if (!get(p->result, &good, 1) || !get(p->result, noted, sizeof *noted) ||
        !get_err(p->result, said))
        return false;
    noted->n = noted->n < most ? noted->n : most;
    for (size_t k = 0; k < most; k++)
        noted->text[k][sizeof noted->text[k] - 1] = '\0';
    return good == 0 || (*g = get_grid(p, file)) != NULL;
}
