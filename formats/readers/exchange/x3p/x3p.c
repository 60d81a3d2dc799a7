/*
 * X3P, ISO 25178-72 (earlier ISO 5436-2): a ZIP archive that holds
 *
 *     main.xml           what was measured and how, and the heights themselves when they are few
 *     bindata/data.bin   else the heights: little-endian, row 0 first, x fastest
 *     bindata/valid.bin  one bit a point, lowest bit first, 1 where the height is valid
 *     md5checksum.hex    MD5 checksum of main.xml
 *
 * A height is number * increment + offset of the axis CZ, in metres. Damage that reaches a height (a wrong
 * checksum of data.bin or valid.bin) refuses the file. A wrong one of main.xml is noted only, because
 * programs that edit the header are known to leave the old checksum behind.
 */
#include <stdlib.h>
#include <string.h>

#include "x3p_internal.h"
#include "formats/format.h"

/* ---- the archive ---- */

/* main.xml at the top, or under one folder there; macOS adds a folder of its own to archives. */
static bool
find_main(const struct rc_zip_read *a, size_t *member, char prefix[RC_X3P_NAME])
{
    static const char name[] = "main.xml";
    size_t n = rc_zip_read_members(a);

    if (rc_zip_read_find(a, name, member, NULL) == RC_OK) {
        prefix[0] = '\0';
        return true;
    }
    for (size_t k = 0; k < n; k++) {
        const char *path = rc_zip_read_name(a, k), *slash = strchr(path, '/');
        size_t folder = slash == NULL ? 0 : (size_t)(slash - path) + 1;

        if (folder == 0 || folder >= RC_X3P_NAME || strcmp(slash + 1, name) != 0 ||
            strncmp(path, "__MACOSX/", 9) == 0)
            continue;
        memcpy(prefix, path, folder);
        prefix[folder] = '\0';
        *member = k;
        return true;
    }
    return false;
}

static void
x3p_close(struct rc_x3p *x)
{
    rc_zip_read_free(x->archive);
    free(x->list);
    for (size_t f = 0; f < RC_X3P_FIELDS; f++)
        free(x->text[f]);
}

static enum rc_status
x3p_open(struct rc_x3p *x, const struct rc_file *file, bool wants_list, struct rc_err *err)
{
    char quote[RC_SHOWN];

    *x = (struct rc_x3p){.wants_list = wants_list};
    if ((x->archive = rc_zip_read_new(file, err)) == NULL)
        return RC_FAIL;
    if (!find_main(x->archive, &x->main, x->prefix))
        return rc_err_set(
            err,
            "a ZIP archive, but no X3P: it has no main.xml (the first of its %zu members is '%s')",
            rc_zip_read_members(x->archive), rc_word_shown(quote, rc_zip_read_name(x->archive, 0)));
    return rc_x3p_head(x, err);
}

static struct rc_grid *
make_grid(struct rc_x3p *x, const struct rc_file *file, const struct rc_wish *wish, double *metres,
          struct rc_notes *notes, struct rc_err *err)
{
    const struct rc_heights h = {x->nx, x->ny, x->dx, x->dy, 1, "m", NULL};
    struct rc_grid *g = rc_heights_new(&h, file, wish, metres, notes, err);

    if (g == NULL)
        return NULL;
    for (size_t f = RC_X3P_FIRST_KEY; f < RC_X3P_FIELDS; f++)
        if (x->text[f] != NULL && rc_word_keep(g, rc_x3p_key(f), x->text[f], err) != RC_OK) {
            rc_grid_free(g);
            return NULL;
        }
    return g;
}

/* ---- what it is ---- */

static int
x3p_score(const struct rc_file *file)
{
    struct rc_zip_read *archive;
    char prefix[RC_X3P_NAME];
    bool named = rc_file_named(file, ".x3p"), has_main;
    size_t member;

    if (!rc_file_holds(file, 0, "PK", 2))
        return 0;
    /* Another kind of archive gets a low score, so that its refusal names the missing member. */
    if ((archive = rc_zip_read_new(file, NULL)) == NULL)
        return named ? 50 : 5;
    has_main = find_main(archive, &member, prefix);
    rc_zip_read_free(archive);
    return has_main ? (named ? 95 : 80) : 5;
}

/* ---- profiles with positions ---- */

/* Lays even nodes along a profile whose points have positions of their own. Sets x->nx and the spacings, and
 * returns the heights at the nodes, which the caller frees. NULL with the reason. */
static double *
lay_nodes(struct rc_x3p *x, const struct rc_file *file, const struct rc_wish *wish,
          struct rc_notes *notes, struct rc_err *err)
{
    double *points = NULL, *v = NULL;
    struct rc_even even;

    if (x->n < 2) {
        rc_err_set(err, "a profile of one point with a position has no spacing");
        return NULL;
    }
    if (rc_map_fits(file, x->n, 16, err) != RC_OK ||
        (points = rc_x3p_profile(x, notes, err)) == NULL ||
        rc_even_new(points, x->n, 1, file, wish, &even, err) != RC_OK)
        goto done;
    if ((v = malloc(even.n * sizeof *v)) == NULL) {
        rc_err_set(err, "out of memory for %zu nodes", even.n);
        goto done;
    }
    rc_even_heights(&even, points, points + x->n, x->n, v, notes);
    x->nx = even.n;
    x->dx = x->dy = even.step;
done:
    free(points);
    return v;
}

static struct rc_grid *
read_profile(struct rc_x3p *x, const struct rc_file *file, const struct rc_wish *wish,
             struct rc_notes *notes, struct rc_err *err)
{
    double *v = lay_nodes(x, file, wish, notes, err), metres;
    struct rc_grid *g = v == NULL ? NULL : make_grid(x, file, wish, &metres, notes, err);
    bool good = g != NULL;

    for (size_t k = 0; good && k < g->nx; k++)
        g->v[k] = v[k] * metres;
    good = good && rc_heights_finite(g, notes, err) == RC_OK;
    free(v);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

/* ---- the entry in formats.list ---- */

static size_t
x3p_list(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
         size_t most, struct rc_err *err)
{
    struct rc_x3p x;
    enum rc_status status = x3p_open(&x, file, false, err);
    double *v = NULL;
    size_t n = 0;

    if (status == RC_OK && x.absolute) {
        x3p_close(&x);
        status = x3p_open(&x, file, true, err);
    }
    if (status == RC_OK && (x.absolute_x || x.absolute_y))
        status = rc_x3p_axes(&x, file, NULL, NULL, err);
    if (status == RC_OK && (!x.absolute || (v = lay_nodes(&x, file, wish, NULL, err)) != NULL)) {
        if (most > 0)
            *channel = (struct rc_channel){
                .name = "height", .unit = "m", .nx = x.nx, .ny = x.ny, .dx = x.dx, .dy = x.dy};
        n = 1;
    }
    free(v);
    x3p_close(&x);
    return n;
}

static struct rc_grid *
x3p_read(const struct rc_file *file, const struct rc_wish *wish, size_t index,
         struct rc_notes *notes, struct rc_err *err)
{
    struct rc_grid *g = NULL;
    struct rc_x3p x;
    size_t points = 0;
    double metres;
    bool good = false;

    if (x3p_open(&x, file, true, err) != RC_OK)
        goto done;
    if (index != 0) {
        rc_err_set(err, "an X3P file has one channel, not %zu", index + 1);
        goto done;
    }
    if (!x.absolute && ((x.binary && rc_x3p_find_points(&x, &points, err) != RC_OK) ||
                        rc_map_fits(file, x.nx, x.ny, err) != RC_OK))
        goto done;
    if ((x.absolute_x || x.absolute_y) && rc_x3p_axes(&x, file, NULL, NULL, err) != RC_OK)
        goto done;
    rc_x3p_check_main(&x, notes);
    if (x.old_root)
        rc_note(notes, "the root of its main.xml is ISO5436, where the standard has ISO5436_2: it "
                       "is read as if it were that");
    if (x.turned)
        rc_note(notes, "the file turns its axes by a rotation matrix: it is not applied");
    if (x.absolute) {
        g = read_profile(&x, file, wish, notes, err);
        good = g != NULL;
        goto done;
    }
    if ((g = make_grid(&x, file, wish, &metres, notes, err)) == NULL)
        goto done;
    good = rc_x3p_values(&x, file, points, metres, g, notes, err) == RC_OK;
done:
    x3p_close(&x);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

const struct rc_format rc_format_x3p = {
    .name = "x3p",
    .suffixes = ".x3p",
    .summary = "ISO 25178-72 (ISO 5436-2): maps and profiles",
    .score = x3p_score,
    .list = x3p_list,
    .read = x3p_read,
};
