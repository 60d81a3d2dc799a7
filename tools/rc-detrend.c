#include "tools/cli/cli.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "libcontact/contact.h"

static struct args {
    struct steps steps;
} args;

static const double filled_much = 0.05; /* part of the points beyond which filling is warned of */

/* clang-format off */
static const struct opt opts[] = {
    {.name = "plane", .type = OPT_STEP, .at = offsetof(struct args, steps), .result = true,
     .help = "subtract the least-squares plane"},
    {.name = "poly", .type = OPT_STEP, .at = offsetof(struct args, steps), .max = RC_DEGREE_MAX,
     .result = true, .arg = "N", .help = "subtract the polynomial of degree N (0: the mean)"},
    {.name = "fill", .type = OPT_STEP, .at = offsetof(struct args, steps), .result = true,
     .help = "fill missing points smoothly from around them"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-detrend",
    .summary = "Level height maps, remove their form, fill missing points",
    .operands = "[FILE...]",
    .examples = "  rc-import bench.x3p | rc-detrend --plane --fill > flat.rcg\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

/* A form that is taken off a periodic surface opens a step where the periods meet. */
static enum rc_status
remove_form(struct tool *t, struct rc_grid *g, size_t degree, struct rc_err *err)
{
    struct rc_shape shape = rc_grid_shape(g);
    const char *periodic = rc_grid_get(g, "periodic");
    char where[256];

    if (rc_detrend_poly(&shape, degree, g->v, err) != RC_OK)
        return RC_FAIL;
    if (degree == 0 || periodic == NULL || strcmp(periodic, "yes") != 0)
        return RC_OK;
    tool_warn(t, "%s: a periodic surface is not periodic without its form: periodic=no from here",
              tool_where(t, g, where, sizeof where));
    return rc_grid_set(g, "periodic", "no", err);
}

static size_t
count_missing(const struct rc_grid *g)
{
    size_t n = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++)
        n += isnan(g->v[k]) ? 1 : 0;
    return n;
}

/* A surface that was mostly made up is to be known for one. */
static enum rc_status
warn_of_holes(struct tool *t, const struct rc_grid *g, size_t missing, struct rc_err *err)
{
    struct rc_shape shape = rc_grid_shape(g);
    size_t nodes = g->nx * g->ny;
    char where[256], text[SHOWN_NUMBER];
    double width;

    if ((double)missing <= filled_much * (double)nodes || missing == nodes || t->quiet)
        return RC_OK;
    tool_demand_memory(t, g, nodes * (sizeof *g->v + sizeof(uint32_t)));
    if (rc_hole_width(&shape, g->v, &width, err) != RC_OK)
        return RC_FAIL;
    tool_warn(
        t,
        "%s: %.3g %% of the points were missing (%zu of %zu) and are filled from around them; the "
        "widest hole is %sm wide: what comes out there is a guess",
        tool_where(t, g, where, sizeof where), 100 * (double)missing / (double)nodes, missing,
        nodes, shown_number(text, width, 3, "m"));
    return RC_OK;
}

/* The key counts the points that were filled by all steps, those of earlier commands included. */
static enum rc_status
fill(struct tool *t, struct rc_grid *g, struct rc_err *err)
{
    struct rc_shape shape = rc_grid_shape(g);
    char where[256];
    double before = 0;
    size_t filled, nodes = g->nx * g->ny, missing = count_missing(g);

    tool_demand_memory(t, g, nodes * sizeof *g->v + rc_inpaint_memory(missing));
    if (warn_of_holes(t, g, missing, err) != RC_OK)
        return RC_FAIL;
    if (rc_inpaint(&shape, g->v, &filled, err) != RC_OK)
        return RC_FAIL;
    tool_note(t, "%s: %zu of %zu points filled", tool_where(t, g, where, sizeof where), filled,
              nodes);
    if (rc_grid_get(g, "filled") != NULL && !rc_grid_number(g, "filled", &before))
        return rc_err_set(err, "filled=%s is not a number", rc_grid_get(g, "filled"));
    return rc_grid_set_number(g, "filled", before + (double)filled, err);
}

static void
detrend(struct tool *t, struct rc_grid *g)
{
    struct rc_err err;
    enum rc_status status = RC_OK;

    for (size_t k = 0; k < args.steps.n && status == RC_OK; k++) {
        const struct step *step = &args.steps.step[k];
        if (strcmp(step->opt->name, "fill") == 0)
            status = fill(t, g, &err);
        else
            status = remove_form(t, g, step->opt->arg == NULL ? 1 : (size_t)step->value, &err);
    }
    if (status == RC_OK)
        status = rc_grid_history(g, tool_history(t), &err);
    if (status != RC_OK)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
}

static void
refuse_infinite(struct tool *t, const struct rc_grid *g)
{
    size_t count = 0, first = 0;

    for (size_t k = g->nx * g->ny; k-- > 0;)
        if (isinf(g->v[k])) {
            count++;
            first = k;
        }
    if (count > 0)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "%zu heights are infinite, the first at column %zu, row "
                    "%zu: a point without a measurement is NaN",
                    count, first % g->nx, first / g->nx);
}

int
main(int argc, char **argv)
{
    struct rc_grid *g;
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    if (args.steps.n == 0)
        tool_die(&t, EXIT_USAGE, "nothing to do: give --plane, --poly N or --fill");
    while ((g = tool_channel(&t, "height", true)) != NULL) {
        refuse_infinite(&t, g);
        detrend(&t, g);
        tool_write(&t, g);
        rc_grid_free(g);
    }
    return tool_finish(&t);
}
