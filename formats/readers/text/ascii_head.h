/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header of a matrix of heights as text; see ascii.c. */
#ifndef RC_ASCII_HEAD_H
#define RC_ASCII_HEAD_H

#include "formats/core/core.h"

struct rc_ascii_head {
    bool known; /* at least one line is known */
    struct rc_piece channel;
    double width, height, pixel; /* m, NAN when not given                            */
    double step_x, step_y;       /* m, likewise                                      */
    double z;                    /* m per number, likewise                           */
    char unit[16];               /* unit of the numbers if it is not a length */
    size_t nx, ny;               /* 0 when not given                                 */
    char separator[2];           /* separator of a line `sep=;`, "" for none */
};

/* Reads the known lines, and moves `lines` behind them. */
void rc_ascii_read_head(struct rc_ascii_head *head, struct rc_lines *lines);

#endif
