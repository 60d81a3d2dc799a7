/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: parameters of surfaces, spectra and contacts, for rc-info.
 */
#ifndef RC_TOOL_INFO_H
#define RC_TOOL_INFO_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"
#include "tools/frames/frames.h"

#define INFO_2PI 6.28318530717958647692

enum {
    INFO_BINS = 50,
    INFO_HEIGHTS = 8 /* info heights of --smr */
};

/* The profiles of a map to evaluate. */
struct info_line_wanted {
    const char *along; /* the text on the command line; NULL: none           */
    bool rows, columns;
    double angle; /* degrees; NAN: from one point to another */
    struct rc_place from, to;
};

/* Parameters of the profiles. They are means and standard deviations over the lines. */
struct info_profile {
    size_t lines, skipped; /* skipped: lines with missing points */
    size_t points, sections, elements;
    double length; /* m */
    struct rc_profile mean, deviation;
};

struct info_wanted {
    bool areal, psd, patches;
    struct numbers smr;  /* heights above the mean, m      */
    const char *profile; /* the text on the command line; NULL: none     */
    size_t sections;     /* sections of a profile */
    const char *report;  /* a file, or NULL                */
    struct numbers fit;  /* shortest and longest wavelength, m; n = 0: automatic */
    const char *window;  /* window of the spectrum; NULL: from the boundary        */
    const char *psd_map; /* a file, or NULL                                        */
    /* set by the functions below */
    struct info_line_wanted line;
    char smr_name[INFO_HEIGHTS][40];
    struct report out;
    struct info_file *file;
    bool height, pressure; /* such a frame was read */
    struct name_list present;
};

/* The figures of one frame; NULL if not requested or not defined for its channel. */
struct info_figures {
    const struct rc_grid *grid;
    const struct rc_grid *touch; /* the frame that determines the contact of a pressure; NULL:
                                    unknown */
    struct rc_areal *areal;
    struct rc_features *features; /* with areal parameters, for a map */
    double smr[INFO_HEIGHTS];     /* fractions            */
    struct info_profile *profile;
    struct rc_psd *psd;
    struct rc_patches *patches;
    double *edges; /* edges of the histogram of pressures: INFO_BINS + 1, Pa; NULL without
                      contact */
    size_t *counts;
};

/* Before the first frame: ends the tool for an invalid range, and for a file that cannot be written. */
void info_check(struct info_wanted *wanted, struct tool *tool);
/* Computes the figures of a frame; `touch` is the frame that determines its contact; the caller keeps both.
 * Ends the tool on failure. */
void info_compute(struct info_wanted *wanted, struct tool *tool, const struct rc_grid *grid,
                  const struct rc_grid *touch, struct info_figures *figures);
void info_free(struct info_figures *figures);
/* After the last frame: ends the tool if no frame had the channel of a requested option. */
void info_end(struct info_wanted *wanted, struct tool *tool);

void info_text(const struct info_wanted *wanted, const struct info_figures *figures, FILE *out);

/* parameters.c */
/* The name in ISO 21920-2 of a parameter of rc_areal; NULL: it has none. */
const char *info_profile_name(const struct rc_figure *areal);
const char *info_shown_to(char text[SHOWN_NUMBER], double value, const struct rc_figure *figure);
#define info_shown(value, figure) info_shown_to((char[SHOWN_NUMBER]){""}, value, figure)

/* line.c: reads --profile, NULL for none; ends the tool if it is not a line, or if it cannot be measured. */
void info_line_read(struct tool *tool, const char *along, struct info_line_wanted *wanted);
void info_line_measure(struct tool *tool, const struct rc_grid *grid,
                       const struct info_line_wanted *wanted, size_t sections,
                       struct info_profile *profile);

/* report.c: a row of --report, and the objects that --json adds to a frame. */
void info_report(struct report *report, const struct info_wanted *wanted,
                 const struct info_figures *figures, const struct rc_statistics *statistics);
void info_json(struct report *json, const struct info_wanted *wanted,
               const struct info_figures *figures);

/* True if no figure of the requested options is defined for the frame. */
bool info_has_no_row(const struct info_wanted *wanted, const struct info_figures *figures);

/* spread.c: mean, standard error and standard deviation of each figure over the frames of a channel. */
enum {
    INFO_SPREAD = 256
};
struct info_spread {
    struct info_spread_row {
        char channel[32], name[40], unit[16];
        size_t n;
        double mean, squares, least, most; /* squares: sum of squared deviations */
    } row[INFO_SPREAD];
    size_t n;
};
void info_spread_take(struct info_spread *spread, const struct info_wanted *wanted,
                      const struct info_figures *figures, const struct rc_statistics *statistics);
void info_spread_text(const struct info_spread *spread, FILE *out);
void info_spread_json(const struct info_spread *spread, struct report *json);

/* map_file.c: frames of spectra, in a file that appears whole or not at all. */
struct info_file;
struct info_file *info_file_new(struct tool *tool, const char *option, const char *name);
void info_file_put(struct info_file *file, const struct rc_grid *grid);
void info_file_end(struct info_file *file);

#endif
