/*
 * The face of this folder: what a surface, its waves and a contact are like, for rc-info.
 */
#ifndef RC_TOOL_INFO_H
#define RC_TOOL_INFO_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

#define INFO_2PI 6.28318530717958647692

struct info_wanted {
    bool areal, psd, patches;
    struct numbers fit;  /* shortest and longest wavelength, m; n = 0: to be found */
    const char *window;  /* of the spectrum; NULL: by the boundary                 */
    const char *psd_map; /* a file, or NULL                                        */
    /* set by the functions below */
    struct info_file *file;
    bool height, pressure; /* such a frame has come */
    struct name_list present;
};

/* Of one frame; what was not asked for, or does not go with its channel, is NULL. */
struct info_figures {
    const struct rc_grid *grid;
    struct rc_areal *areal;
    struct rc_psd *psd;
    struct rc_patches *patches;
    double *edges; /* of the histogram of pressures: INFO_BINS + 1, Pa; NULL without contact */
    size_t *counts;
};

enum {
    INFO_BINS = 50
};

/* Before the first frame: ends the tool for a range that is none, and a file that cannot be
 * written. */
void info_check(struct info_wanted *wanted, struct tool *tool);
/* Figures of a frame, which stays the caller's; ends the tool where they cannot be had. */
void info_compute(struct info_wanted *wanted, struct tool *tool, const struct rc_grid *grid,
                  struct info_figures *figures);
void info_free(struct info_figures *figures);
/* After the last frame: ends the tool where the channel of what is wanted never came. */
void info_end(struct info_wanted *wanted, struct tool *tool);

void info_json(const struct info_figures *figures, struct json *json);
void info_text(const struct info_figures *figures, FILE *out);

/* map_file.c: frames of spectra, in a file that appears whole or not at all. */
struct info_file;
struct info_file *info_file_new(struct tool *tool, const char *option, const char *name);
void info_file_put(struct info_file *file, const struct rc_grid *grid);
void info_file_end(struct info_file *file);

#endif
