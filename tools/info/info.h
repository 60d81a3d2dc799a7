/*
 * The face of this folder: what a surface, its waves and a contact are like, for rc-info.
 */
#ifndef RC_TOOL_INFO_H
#define RC_TOOL_INFO_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

#define INFO_2PI 6.28318530717958647692

enum {
    INFO_BINS = 50,
    INFO_HEIGHTS = 8 /* of --smr */
};

/* Which profiles of a map. */
struct info_line_wanted {
    const char *along; /* as on the line; NULL: none           */
    bool rows, columns;
    double angle; /* degrees; NAN: from one place to another */
    struct rc_place from, to;
};

/* Parameters of them: means, and standard deviations over the lines. */
struct info_profile {
    size_t lines, skipped; /* skipped: not measured whole */
    size_t points, sections, elements;
    double length; /* m */
    struct rc_profile mean, deviation;
};

struct info_wanted {
    bool areal, psd, patches;
    struct numbers smr;  /* heights above the mean, m      */
    const char *profile; /* as on the line; NULL: none     */
    size_t sections;     /* of a profile                   */
    const char *report;  /* a file, or NULL                */
    struct numbers fit;  /* shortest and longest wavelength, m; n = 0: to be found */
    const char *window;  /* of the spectrum; NULL: by the boundary                 */
    const char *psd_map; /* a file, or NULL                                        */
    /* set by the functions below */
    struct info_line_wanted line;
    char smr_name[INFO_HEIGHTS][40];
    struct report out;
    struct info_file *file;
    bool height, pressure; /* such a frame has come */
    struct name_list present;
};

/* Of one frame; what was not asked for, or does not go with its channel, is NULL. */
struct info_figures {
    const struct rc_grid *grid;
    const struct rc_grid *touch; /* what tells the contact of a pressure; NULL: nothing does */
    struct rc_areal *areal;
    struct rc_features *features; /* with areal, of a map */
    double smr[INFO_HEIGHTS];     /* fractions            */
    struct info_profile *profile;
    struct rc_psd *psd;
    struct rc_patches *patches;
    double *edges; /* of the histogram of pressures: INFO_BINS + 1, Pa; NULL without contact */
    size_t *counts;
};

/* Before the first frame: ends the tool for a range that is none, and a file that cannot be
 * written. */
void info_check(struct info_wanted *wanted, struct tool *tool);
/* Figures of a frame, which stays the caller's, as does `touch`, which tells its contact; ends the tool where
 * they cannot be had. */
void info_compute(struct info_wanted *wanted, struct tool *tool, const struct rc_grid *grid,
                  const struct rc_grid *touch, struct info_figures *figures);
void info_free(struct info_figures *figures);
/* After the last frame: ends the tool where the channel of what is wanted never came. */
void info_end(struct info_wanted *wanted, struct tool *tool);

void info_text(const struct info_wanted *wanted, const struct info_figures *figures, FILE *out);

/* parameters.c */
/* What ISO 21920-2 calls a parameter of the table of rc_areal; NULL: it has none. */
const char *info_profile_name(const struct rc_figure *areal);
const char *info_shown(char text[SHOWN_NUMBER], double value, const struct rc_figure *figure);

/* line.c: reads --profile, NULL for none; ends the tool where it is no line, or where it cannot
 * be measured. */
void info_line_read(struct tool *tool, const char *along, struct info_line_wanted *wanted);
void info_line_measure(struct tool *tool, const struct rc_grid *grid,
                       const struct info_line_wanted *wanted, size_t sections,
                       struct info_profile *profile);

/* report.c: a row of --report, and what --json adds to a frame. */
void info_report(struct report *report, const struct info_wanted *wanted,
                 const struct info_figures *figures, const struct rc_statistics *statistics);
void info_json(struct report *json, const struct info_wanted *wanted,
               const struct info_figures *figures);

/* map_file.c: frames of spectra, in a file that appears whole or not at all. */
struct info_file;
struct info_file *info_file_new(struct tool *tool, const char *option, const char *name);
void info_file_put(struct info_file *file, const struct rc_grid *grid);
void info_file_end(struct info_file *file);

#endif
