/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Results in a case with the height from which they were computed.
 */
#include "results.h"

#include <string.h>

#include "libcontact/contact.h"

/* True if frames of this channel are results, computed from a height. */
static bool
computed(const char *channel)
{
    static const char *const solved[] = {"pressure",
                                         "gap",
                                         "displacement",
                                         "plastic",
                                         "traction-x",
                                         "traction-y",
                                         "fluid-pressure",
                                         "flux",
                                         "channel",
                                         "slip-x",
                                         "slip-y",
                                         "traction",
                                         "state",
                                         "contact",
                                         "adhesion",
                                         "residual",
                                         "exx",
                                         "eyy",
                                         "exy",
                                         "exz",
                                         "eyz",
                                         "peeq",
                                         "slip",
                                         "dissipation",
                                         "wear",
                                         "temperature-1",
                                         "temperature-2",
                                         "heat-1",
                                         "heat-2",
                                         "crossland",
                                         "dangvan",
                                         "papadopoulos",
                                         "findley",
                                         "shakedown",
                                         "amplitude"};

    for (size_t k = 0; k < sizeof solved / sizeof *solved; k++)
        if (strcmp(channel, solved[k]) == 0)
            return true;
    for (size_t k = 0; k < RC_STRESSES; k++)
        if (strcmp(channel, rc_component_names[k]) == 0)
            return true;
    return false;
}

/* Adds a channel to a list unless it is in it already. */
static void
add_name(char *list, size_t size, const char *name)
{
    size_t n = strlen(name), used = strlen(list);

    for (const char *s = list; (s = strstr(s, name)) != NULL; s += n)
        if ((s == list || s[-1] == ' ') && (s[n] == ',' || s[n] == '\0'))
            return;
    snprintf(list + used, size - used, "%s%s", used == 0 ? "" : ", ", name);
}

/* If the height came first, the message names the later results too. */
static _Noreturn void
refuse(struct tool *t, const struct rc_grid *g)
{
    struct rc_grid *next;
    const char *where = tool_where(t, g);

    while (computed(g->channel) && (next = tool_read(t)) != NULL &&
           rc_grid_case(next) == rc_grid_case(g))
        if (computed(next->channel))
            add_name(t->results.names, sizeof t->results.names, next->channel);
    tool_die(t,
             "%s: the case contains a height and results computed from it (%s), which the changed "
             "height would contradict: take the height alone with rc-pick --channel height",
             where, t->results.names);
}

void
results_demand_none(struct tool *t, const struct rc_grid *g)
{
    if (rc_grid_case(g) != t->results.number) {
        t->results.number = rc_grid_case(g);
        t->results.names[0] = '\0';
        t->results.height = false;
    }
    if (computed(g->channel))
        add_name(t->results.names, sizeof t->results.names, g->channel);
    else if (strcmp(g->channel, "height") == 0)
        t->results.height = true;
    if (t->results.height && t->results.names[0] != '\0')
        refuse(t, g);
}
