/*
 * The face of this folder: which frame of a stream rc-render draws. It holds the best one so far
 * and no other.
 */
#ifndef RC_RENDER_H
#define RC_RENDER_H

#include "tools/cli/cli.h"

struct wish {
    const char *channel; /* NULL: mises, pressure, height, else the first there is    */
    const char *section; /* "x" or "y": a section across that axis; NULL: whatever    */
    double depth;        /* metres, met within a thousandth; NAN: whatever            */
    size_t number;       /* of the case; 0: the first                                 */
};

struct choice {
    const struct wish *wish;
    struct rc_grid *grid; /* the best so far; NULL: none matched                      */
    double size;          /* its largest |value|                                      */
    bool by_size;         /* settled: preferred to other depths for that              */
    struct seen *seen;    /* every frame that came by, without its values             */
    size_t n, capacity;
};

/* Keeps the frame when it is better than the one kept, or frees it. Of several depths the one with
 * the largest |value| is better, of several cases the first. */
void choice_offer(struct choice *choice, struct tool *tool, struct rc_grid *grid);
/* After the last frame: fails, naming what there is, when none matched, and says what was left out
 * where somebody might have meant that. */
void choice_settle(struct choice *choice, struct tool *tool);
void choice_free(struct choice *choice);

#endif
