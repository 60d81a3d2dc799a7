/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the two forms of SDF (ISO 25178-71). */
#ifndef RC_SDF_HEAD_H
#define RC_SDF_HEAD_H

#include "formats/export.h"

enum {
    RC_SDF_DATE = 13
};
/* DDMMYYYYhhmm */
static inline void
sdf_date(char date[RC_SDF_DATE], const struct rc_grid *g, const struct rc_export_wish *wish)
{
    char iso[RC_DATE];

    rc_export_date(iso, g, wish);
    snprintf(date, RC_SDF_DATE, "%.2s%.2s%.4s%.2s%.2s", iso + 8, iso + 5, iso, iso + 11, iso + 14);
}

/* The creator of the data in ten characters. */
static inline const char *
sdf_maker(const struct rc_grid *g)
{
    const char *maker = rc_grid_get(g, "file.manufacturer");

    for (const char *s = maker; s != NULL && *s != '\0'; s++)
        if (*s <= ' ' || *s > '~')
            maker = NULL;
    return maker == NULL || *maker == '\0' ? "libcontact" : maker;
}

#endif
