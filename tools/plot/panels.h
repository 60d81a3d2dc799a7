/* Several maps in one picture, with one colour bar and the axes of the outermost. */
#ifndef RC_PANELS_H
#define RC_PANELS_H

#include "figure.h"

struct panel {
    struct figure figure; /* all alike but for where they lie, zeros and missing */
    const struct rc_grid *grid;
    char label[256]; /* over it: "a) load 10 N" */
};

struct panels {
    const struct figure *figure; /* of the whole: title, subtitle, stamp, the colours, and how many
                                    nodes of all maps are missing or 0 */
    const struct panel *panel;
    size_t n, columns;
};

enum {
    PANELS_WIDTH = 1400 /* pixels where the figure asks for none */
};

/* Columns that give n panels of that aspect, width over height, a page of fair shape. */
size_t panels_columns(size_t n, double aspect);
/* NULL when memory is short or the width too small for so many columns. */
struct canvas *panels_draw(const struct panels *panels, struct rc_err *err);

#endif
