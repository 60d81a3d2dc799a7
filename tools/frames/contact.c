/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The nodes in contact. A pressure determines them, except the net pressure of bodies that attract each
 * other. It is not 0 at almost all nodes, and may be negative where the gap is closed. rc-solve writes the
 * frame `contact` with it.
 */
#include "contact.h"

#include <math.h>
#include <string.h>

static const double rounding =
    1e-6; /* relative to the largest pressure: smaller negative values are rounding */

static const char remedy[] =
    "keep both frames, as in rc-pick --channel pressure,contact, or, if the stream has none, solve "
    "it again with this rc-solve";

/* True for a pressure of bodies that attract each other with negative values. */
static bool
is_net(const struct rc_grid *p, double negative)
{
    return negative > 0 && rc_grid_get(p, "adhesion") != NULL;
}

bool
contact_negative(double v, double most)
{
    return v < -rounding * most;
}

/* The number of nodes whose pressure is negative by more than rounding. */
static double
count_negative(const struct tool *t, const struct rc_grid *p)
{
    double most = 0;
    size_t negative = 0;

    for (size_t k = 0; k < rc_grid_nodes(p); k++)
        most = fmax(most, p->v[k]);
    most = ranks_most(t, most);
    for (size_t k = 0; k < rc_grid_nodes(p); k++)
        negative += contact_negative(p->v[k], most);
    return ranks_sum(t, (double)negative);
}

static size_t
count_wrong(const struct tool *t, const struct rc_grid *contact)
{
    size_t wrong = 0;

    for (size_t k = 0; k < rc_grid_nodes(contact); k++)
        wrong += contact->v[k] != 0 && contact->v[k] != 1;
    return (size_t)ranks_sum(t, (double)wrong);
}

static void
demand_states(struct tool *t, const struct rc_grid *contact, size_t wrong)
{
    if (wrong > 0)
        tool_refuse(t, contact,
                    "%zu of %zu values are neither 0 nor 1: a frame contact is 1 where the bodies "
                    "touch and 0 elsewhere",
                    wrong, contact->nx * contact->ny);
}

const struct rc_grid *
contact_counted(struct tool *t, const struct rc_grid *p, const struct rc_grid *contact,
                bool demanded, size_t wrong, double negative)
{
    const char *where = tool_where(t, p);

    if (contact != NULL) {
        if (p != NULL)
            tool_demand_grid_of(t, contact, p);
        demand_states(t, contact, wrong);
        return contact;
    }
    if (p == NULL || negative == 0)
        return p;
    if (is_net(p, negative) && demanded)
        tool_refuse(t, p,
                    "the net pressure of bodies that attract each other does not determine the "
                    "contact, and the case has no frame contact: %s",
                    remedy);
    if (is_net(p, negative)) {
        tool_warn(t,
                  "%s: the contact is unknown: the net pressure of bodies that attract each other "
                  "does not determine it, and the case has no frame contact: %s",
                  where, remedy);
        return NULL;
    }
    tool_warn(t,
              "%s: the pressure is negative at %.0f of %zu nodes: nodes with a pressure above 0 "
              "count as contact; with adhesion a frame contact is needed",
              where, negative, p->nx * p->ny);
    return p;
}

static const struct rc_grid *
find(struct tool *t, const struct rc_grid *p, const struct rc_grid *contact, bool demanded)
{
    return contact_counted(t, p, contact, demanded, contact == NULL ? 0 : count_wrong(t, contact),
                           contact != NULL || p == NULL ? 0 : count_negative(t, p));
}

const struct rc_grid *
contact_frame(struct tool *t, const struct rc_grid *p, const struct rc_grid *contact)
{
    return find(t, p, contact, false);
}

const struct rc_grid *
contact_demand(struct tool *t, const struct rc_grid *p, const struct rc_grid *contact)
{
    return find(t, p, contact, true);
}

/* ---- rolling ---- */

void
creep_judge(struct tool *t, const char *text, const double *v, size_t n)
{
    const double large = 0.05; /* friction limits the force at far less */
    size_t k = 0;

    while (k < n && fabs(v[k]) <= large)
        k++;
    if (k < n && strchr(text, '%') == NULL)
        tool_warn(t, "--creep %s: a creepage of %g is %g %%: write %g%% for %g percent", text, v[k],
                  100 * v[k], v[k], v[k]);
}

/* ---- the boundary ---- */

/* The words of the option --periodic, and the boundary of each. */
static const struct {
    const char *axes;
    struct rc_boundary boundary;
} axes[] = {{"", {.x = true, .y = true}},
            {"xy", {.x = true, .y = true}},
            {"x", {.x = true}},
            {"y", {.y = true}}};

struct rc_boundary
boundary_asked(const struct boundary_args *asked)
{
    struct rc_boundary boundary = {.datum = isnan(asked->datum) ? 0 : asked->datum};

    for (size_t k = 0; k < sizeof axes / sizeof *axes && asked->periodic != NULL; k++)
        if (strcmp(axes[k].axes, asked->periodic) == 0) {
            boundary.x = axes[k].boundary.x;
            boundary.y = axes[k].boundary.y;
        }
    return boundary;
}

/* The key `boundary` of a result; false when there is none. */
static bool
own_boundary(const struct rc_grid *g, struct rc_boundary *boundary)
{
    const char *word = rc_grid_get(g, "boundary");

    if (word == NULL || !rc_boundary_named(word, boundary))
        return false;
    (void)rc_grid_number(g, "datum", &boundary->datum);
    return true;
}

struct rc_boundary
map_repeats(const struct rc_grid *g)
{
    const bool both = map_says(g, "periodic", "yes");

    return (struct rc_boundary){.x = both || map_says(g, "periodic", "x"),
                                .y = both || map_says(g, "periodic", "y")};
}

void
map_set_repeats(struct tool *t, struct rc_grid *g, struct rc_boundary repeats)
{
    tool_set(t, g, "periodic", rc_repeats_word(repeats));
}

const char *
map_end_period(struct tool *t, struct rc_grid *g, struct rc_boundary ends)
{
    const struct rc_boundary was = map_repeats(g);
    const struct rc_boundary is = rc_boundary_of(was.x && !ends.x, was.y && !ends.y);

    if (rc_same_boundary(was, is))
        return NULL;
    map_set_repeats(t, g, is);
    return is.x ? " along y" : is.y ? " along x" : "";
}

struct rc_boundary
map_boundary(const struct rc_grid *g)
{
    struct rc_boundary boundary = RC_FREE;

    return own_boundary(g, &boundary) ? boundary : map_repeats(g);
}

void
map_set_boundary(struct tool *t, struct rc_grid *g, struct rc_boundary boundary)
{
    const struct rc_shape shape = rc_grid_shape(g);

    tool_set(t, g, "boundary", rc_boundary_word(boundary));
    tool_set_number(t, g, "datum",
                    rc_repeats(boundary) == 1 ? rc_boundary_on(&shape, boundary).datum : NAN);
}

struct rc_boundary
contact_boundary(struct tool *tool, const struct rc_grid *p, const struct boundary_args *asked)
{
    const struct rc_boundary wanted = boundary_asked(asked);
    struct rc_boundary own = RC_FREE;

    if (!own_boundary(p, &own))
        return wanted;
    if (asked->periodic != NULL && !rc_same_boundary(own, wanted))
        tool_refuse(tool, p,
                    "its boundary is %s, which contradicts --periodic%s%s: leave out --periodic",
                    rc_boundary_word(own), *asked->periodic == '\0' ? "" : "=", asked->periodic);
    if (!isnan(asked->datum))
        own.datum = asked->datum;
    return own;
}

void
boundary_report(struct report *r, const struct rc_grid *g, struct rc_boundary boundary)
{
    const struct rc_shape shape = rc_grid_shape(g);

    report_text(r, "boundary", rc_boundary_word(boundary));
    if (rc_repeats(boundary) == 1)
        report_number(r, "datum", rc_boundary_on(&shape, boundary).datum, "m");
}

const char *
boundary_padding(struct rc_boundary boundary)
{
    return rc_repeats(boundary) == 0   ? "on"
           : rc_repeats(boundary) == 2 ? "left out: the map is periodic"
           : boundary.x                ? "on: along y only, the map repeats along x"
                                       : "on: along x only, the map repeats along y";
}
