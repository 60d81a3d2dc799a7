/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: what the measurement of the map costs in accuracy. The command runs with the
 * map as it was measured, and with maps that differ from it as another measurement could. Each figure gets a
 * bar: the half width of an interval that should hold the value of the true surface in 90 % of the cases.
 */
#ifndef RC_SCAN_H
#define RC_SCAN_H

#include "tools/cost/cost.h"

enum scan_source {
    SCAN_NOISE,
    SCAN_GRID,
    SCAN_PATCH,
    SCAN_HOLES,
    SCAN_FILTER,
    SCAN_SOURCES
};

/* ---- maps.c: the maps ---- */

struct scan_options {
    struct numbers noise; /* m: standard deviation, and distance where the correlation is 1/e */
    const char *again;    /* --repeat: a second scan of the same place; NULL: none */
    size_t repeats, seed; /* noisy maps; of the first of them */
    bool resolution, patch, holes;
    const char *filter; /* options of rc-detrend, separated by ';'; NULL: none */
    bool filter_bar;    /* the filters count in the bar */
};

struct scan_variant {
    enum scan_source source;
    char name[COST_NAME]; /* "noise 1", "filter --lowpass 3um" */
    size_t number, trial; /* of those of its source, from 0 */
    const char *words;    /* options of rc-detrend */
};

struct scan_bar {
    const struct cost_figure *figure;
    const char *name;          /* with the number of the program where two have bars of one name */
    size_t line;               /* of the report, from 0: the case */
    double value, bar;         /* of the measured map; NAN: no bar */
    double part[SCAN_SOURCES]; /* NAN: not studied, or unknown */
    double bias, scatter;      /* of the noise; NAN: not studied */
    double coarse[2];          /* with half and a quarter of the nodes a side; NAN: unknown */
    bool unlimited;            /* it changes with a grid that does not resolve the map */
    bool here;                 /* it is a figure of this area: the patch gives no bar */
    enum scan_source dominant; /* SCAN_SOURCES: none */
    const char *note;          /* "" */
};

struct scan {
    struct cost_case *c;
    const struct scan_options *options;
    double sigma, length;        /* m: of the noise; 0: none, white */
    struct rc_boundary reflects; /* quarters are reflected: axes of --periodic, without --mirror */
    struct rc_grid **frame;
    size_t frames, frame_room;
    double slope[3]; /* of the map and of its means over 2 x 2 and 4 x 4 nodes, without noise */
    double noise_slope[3];
    double ratio;    /* of the changes of the slope; NAN: unknown */
    bool unlimited;  /* the waves do not end on this map */
    char note[128];  /* of its figures */
    size_t missing;  /* nodes of the first map */
    size_t noises;   /* that noise_slope is the mean square of */
    bool images[2];  /* the maps are reflected along x, y */
    double share;    /* area of a quarter over that of the map */
    uint64_t random; /* state of the generator */
    struct scan_variant *variant;
    size_t variants, room;
    struct scan_bar *bar;
    size_t bars, bar_room;
};

/* Studies the input that is in c->input: runs all maps, finds the bars. Ends the tool if the map as measured
 * fails. With `plans` it only makes the maps. */
void scan_study(struct scan *s, bool plans);
/* RMS slope of the means over coarse x coarse nodes. */
double scan_slope(const struct scan *s, const struct rc_shape *shape, const double *v,
                  unsigned coarse);

/* ---- bars.c: the rules ---- */

/* Of the changes of the slope when the grid is made coarser twice; sets slope, ratio and unlimited. */
void scan_judge_grid(struct scan *s);
/* Finds all bars from the reports of the runs. */
void scan_find_bars(struct scan *s);

/* ---- show.c ---- */

void scan_show_plan(const struct scan *s, FILE *out);
void scan_show_table(const struct scan *s, FILE *out);
void scan_report(const struct scan *s, struct report *out);

/* ---- plot.c ---- */

/* A picture of the bars of the last case in memory, which the caller frees. */
unsigned char *scan_plot(const struct scan *s, const char *ending, size_t *bytes,
                         struct rc_err *err);

#endif
