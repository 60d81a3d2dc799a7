/* The header of a matrix of heights as text; see ascii.c. */
#ifndef RC_ASCII_HEAD_H
#define RC_ASCII_HEAD_H

#include "formats/core/core.h"

/* Reads one `# key: value` line, by the form of its value. */
struct rc_ascii_comment {
    struct rc_piece value;
    double length; /* a number with a unit of length, in m; NAN: something else  */
};

struct rc_ascii_unit {
    bool given;
    double metres; /* NAN: no length */
};

struct rc_ascii_head {
    bool known; /* at least one line is known */
    struct rc_piece channel;
    double width, height, pixel; /* m, NAN when not given                            */
    double step_x, step_y;       /* m, likewise                                      */
    double z, factor;            /* m per number, by unit and by factor; NAN likewise */
    char unit[16];               /* unit of the numbers if it is not a length */
    size_t nx, ny;               /* 0 when not given                                 */
    char separator[2];           /* separator of a line `sep=;`, "" for none */
    size_t comments;
    struct rc_ascii_comment comment[4];
    bool any_line; /* up to `Start of Data` all lines belong to the header */
    struct {
        double x_length, y_length, x_step, y_step; /* numbers without a unit, NAN when not given */
        struct rc_ascii_unit x_unit, y_unit;
        double bit, scale; /* nm per count; factor of the numbers */
        bool scaled;
    } as_given;
};

/* Reads the known lines, and moves `lines` behind them. */
void rc_ascii_read_head(struct rc_ascii_head *head, struct rc_lines *lines);

#endif
