/* Stresses in the half-space under a pressure map, slice by slice. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../libcontact/contact.h"
#include "tool.h"

static struct args {
    struct numbers depths;
    double nu;
    size_t components; /* bits of enum rc_component and MISES */
} args = {.nu = NAN, .components = ~(size_t)0};

#define AT(field) .at = offsetof(struct args, field)
static const struct opt opts[] = {
    {.name = "depths", .type = OPT_NUMBERS, .unit = UNIT_M, AT(depths), .min = 0,
     .max = INFINITY, .result = true, .arg = "LIST",
     .help = "depths of the slices: a,b,c or a:b:n (n depths from a to b)"},
    {.name = "components", .type = OPT_WORDS, AT(components), .result = true,
     .words = "sxx|syy|szz|sxy|sxz|syz|mises", .arg = "LIST",
     .help = "of sxx,syy,szz,sxy,sxz,syz,mises (default: all)"},
    {.name = "nu", .type = OPT_NUMBER, AT(nu), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio (default: the stream's own)"},
    {.name = NULL},
};

static const struct tool_info info = {
    .name = "rc-stress",
    .summary = "Stresses in an elastic half-space under a pressure map, slice by slice",
    .operands = "[FILE...]",
    .examples = "  rc-solve --load 240N --estar 114GPa surface.rcg |\n"
                "      rc-stress --nu 0.3 --depths 0:50um:26 --components mises -o mises.rcg\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
};

enum {
    MISES = RC_COMPONENTS, /* follows the six */
    CHANNELS
};

struct run {
    struct tool t;
    struct rc_grid *slice[CHANNELS];
};

static const char *
channel_name(int c)
{
    return c == MISES ? "mises" : rc_component_names[c];
}

static bool
wanted(int channel)
{
    return args.components >> channel & 1;
}

/* Mises needs all six; they are then computed but not written. */
static bool
needed(int channel)
{
    return wanted(channel) || (channel != MISES && wanted(MISES));
}

static size_t
count(bool (*which)(int channel))
{
    size_t n = 0;

    for (int c = 0; c < CHANNELS; c++)
        n += which(c);
    return n;
}

static double
poisson(struct run *run, const struct rc_grid *p)
{
    double nu;

    if (!isnan(args.nu))
        return args.nu;
    if (!rc_grid_number(p, "nu", &nu))
        tool_die_at(&run->t, p, EXIT_USAGE,
                    "Poisson's ratio is not in the stream: give it with --nu");
    return nu;
}

static void
check_pressure(struct run *run, const struct rc_grid *p)
{
    const char *boundary = rc_grid_get(p, "boundary");

    tool_demand_finite(&run->t, p, "a pressure map has none; make it again");
    if (boundary != NULL && strcmp(boundary, "free") != 0)
        tool_die_at(&run->t, p, EXIT_IMPOSSIBLE,
                    "its boundary is %s: stresses are computed for the free half-space only",
                    boundary);
}

static void
allocate(struct run *run, const struct rc_grid *p, double nu)
{
    struct rc_err err;

    for (int c = 0; c < CHANNELS; c++) {
        if (!needed(c))
            continue;
        run->slice[c] = rc_grid_like(p, channel_name(c), "Pa", &err);
        if (run->slice[c] == NULL ||
            rc_grid_set_number(run->slice[c], "nu", nu, &err) != RC_OK ||
            rc_grid_set_number(run->slice[c], "frames",
                               (double)(count(wanted) * args.depths.n), &err) != RC_OK ||
            rc_grid_history(run->slice[c], tool_history(&run->t), &err) != RC_OK)
            tool_die_at(&run->t, p, EXIT_IMPOSSIBLE, "%s", err.text);
    }
}

static void
do_depth(struct run *run, struct rc_stress *stress, double depth)
{
    const double *s[RC_COMPONENTS] = {NULL};
    struct rc_err err;

    for (int c = 0; c < RC_COMPONENTS; c++) {
        if (!needed(c))
            continue;
        if (rc_stress_slice(stress, (enum rc_component)c, depth, run->slice[c]->v, &err) != RC_OK)
            tool_die(&run->t, EXIT_IMPOSSIBLE, "%s", err.text);
        s[c] = run->slice[c]->v;
    }
    if (wanted(MISES))
        rc_mises(run->slice[MISES]->nx * run->slice[MISES]->ny, s, run->slice[MISES]->v);
    for (int c = 0; c < CHANNELS; c++) {
        if (!wanted(c))
            continue;
        if (rc_grid_set_number(run->slice[c], "depth", depth, &err) != RC_OK)
            tool_die(&run->t, EXIT_IMPOSSIBLE, "%s", err.text);
        tool_write(&run->t, run->slice[c]);
    }
}

static void
do_case(struct run *run, const struct rc_grid *p)
{
    struct rc_shape shape = rc_grid_shape(p);
    double nu = poisson(run, p);
    struct rc_stress *stress;
    struct rc_err err;

    check_pressure(run, p);
    tool_demand_memory(&run->t, p, rc_stress_memory(&shape) +
                                       (count(needed) + 1) * p->nx * p->ny * sizeof(double));
    stress = rc_stress_new(&shape, p->v, nu, run->t.threads, &err);
    if (stress == NULL)
        tool_die_at(&run->t, p, EXIT_IMPOSSIBLE, "%s", err.text);
    allocate(run, p, nu);
    for (size_t k = 0; k < args.depths.n; k++) {
        tool_progress(&run->t, "depth %zu of %zu", k + 1, args.depths.n);
        do_depth(run, stress, args.depths.v[k]);
    }
    for (int c = 0; c < CHANNELS; c++) {
        rc_grid_free(run->slice[c]);
        run->slice[c] = NULL;
    }
    rc_stress_free(stress);
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct rc_grid *p;

    tool_start(&run.t, &info, argc, argv, &args);
    if (args.depths.n == 0)
        tool_die(&run.t, EXIT_USAGE, "give the depths of the slices with --depths, as in "
                                     "--depths 0,1um,5um or --depths 0:50um:26");
    while ((p = tool_channel(&run.t, "pressure", false)) != NULL) {
        do_case(&run, p);
        rc_grid_free(p);
    }
    free(args.depths.v);
    return tool_finish(&run.t);
}
