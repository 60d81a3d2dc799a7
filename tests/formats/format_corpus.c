/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every channel of a real file is read with the same values as by the independent readers of the manifest. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "formats/format.h"
#include "tests/exact.h"
#include "tests/formats/made/open.h"

enum {
    SKIPPED = 77,
    LINE_MOST = 8192,
};

/* Columns of the manifest. */
enum {
    FILE_NAME,
    FORMAT,
    NX = 6,
    NY,
    DX,
    DY,
    LATERAL_UNIT,
    CHANNEL,
    Z_UNIT,
    Z_MIN,
    Z_MAX,
    Z_MEAN,
    Z_RMS,
    N_MISSING,
    PROBES,
    NOTE = 23,
    COLUMNS = 24
};

/* Names in the manifest of the formats with a reader here; `rows`: their number of rows in the manifest. */
static struct {
    const char *in_manifest, *here;
    size_t rows;
} formats[] = {
#define CORPUS_FORMAT(in_manifest, here) {in_manifest, here, 0},
#include "corpus.list"
#undef CORPUS_FORMAT
};

/* Rows that a reader refuses for a good reason. */
static const struct {
    const char *file, *refused_for;
} refused[] = {
    {"profile-text/SurfaceTopography__xy-1.txt", "the positions are not evenly spaced"},
    {"profile-text/SurfaceTopography__xy-3.txt", "the positions are not evenly spaced"},
};

/* Rows with sample values under the mask, at points that the same row counts as missing. */
static const char probes_under_mask[] = "generated/frt-2.gwy";

/* The row whose reference values and sums were computed in single precision: heights rounded to it give the
 * same numbers. */
static const char single[] = "truemap-tmd/SurfaceTopography__tmd-1.tmd";

/* The row whose dy is dx, because its independent reader takes x for y. The file has dy to eight digits. */
static const char dy_of_x[] = "generated/al3d-1.nrrd";

/* A file that only other readers refuse: the manifest describes its content. */
static const char in_manifest[] = "";

/* Files of bad.tsv and the reason for which they are refused; NULL: a profile of this number of points whose
 * last values are ... 3, 2, 1. */
static const struct {
    const char *file, *refused_for;
    size_t points;
} bad[] = {
    {"SurfaceTopography__di_corrupted.di", "the file has 489346 bytes in all", 0},
    {"SurfaceTopography__wrongnpyfile.npy", "not recognised", 0},
    {"SurfaceTopography__nonsense_txt_file.txt", "not recognised", 0},
    {"SurfaceTopography__single_column.txt", "9 numbers in one column", 0},
    {"SurfaceTopography__not-yet-working-1.txt", "9 numbers in one column", 0},
    {"x3p__ISO5436-sample2.x3p", "FeatureType PCL is a cloud of points", 0},
    {"x3p__ISO5436-sample3.x3p", "only incremental axes (I), a regular grid, are read", 0},
    {"rosettasciio__test_RGB.sur", "a colour image (type 12)", 0},
    {"rosettasciio__test_RGBSURFACE.sur", "a surface with colours (type 13)", 0},
    {"rosettasciio__test_spectral_map.sur", "a spectral map (type 21)", 0},
    {"rosettasciio__test_spectral_map_compressed.sur", "a spectral map (type 21)", 0},
    {"rosettasciio__test_spectra.pro", "a series of spectra (type 20)", 0},
    {"pySPM__bruker_data_header.000", "begins at byte 40960 of a file of 34693", 0},
    {"pySPM__bruker_data_header.001", "begins at byte 40960 of a file of 10685", 0},
    {"pySPM__bruker_data_header.002", "begins at byte 80960 of a file of 43130", 0},
    {"pySPM__bruker_data_header.003", "there are no numbers in the file", 0},
    {"NSFopen__thermal.nid", "only curves, no map", 0},
    {"igor2__mac-textWave.ibw", "of type 0, text", 0},
    {"igor2__win-zeroPointWave.ibw", "the wave has no points", 0},
    {"igor2__mac-version2.ibw", "version 2", 0},
    {"igor2__win-version5.ibw", NULL, 5},
    {"igor2__mac-version3Dependent.ibw", "version 3", 0},
    {"nanonispy__Bias-Spectroscopy002.dat", "the positions are in 'V', which is not a length", 0},
    {"SurfaceTopography__mitutoyo_mock.xlsx", in_manifest, 0},
    {"afmformats__fmt-jpk-fd_spot3-0192.jpk-force", "force curves of JPK", 0},
};

enum {
    BAD = sizeof bad / sizeof *bad,
    EXCEPTIONS = sizeof refused / sizeof *refused + 3 /* probes_under_mask, single and dy_of_x */
};

/* Formats whose files give steps without a unit. */
static const char *const unitless[] = {"esri", "grd", "xyz"};

static const char *folder;
static size_t faults, steps_checked, exceptions_met;

__attribute__((format(printf, 1, 2))) static void
fault(const char *format, ...)
{
    va_list ap;

    va_start(ap, format);
    printf("WRONG: ");
    vprintf(format, ap);
    printf("\n");
    va_end(ap);
    faults++;
}

static const char *
reader_of(const char *format)
{
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++)
        if (strcmp(format, formats[k].in_manifest) == 0) {
            formats[k].rows++;
            return formats[k].here;
        }
    return NULL;
}

static unsigned char *
whole_file(const char *name, size_t *size)
{
    char path[4096];
    unsigned char *data;
    long length;
    FILE *f;

    snprintf(path, sizeof path, "%s/corpus/%s", folder, name);
    f = fopen(path, "rb");
    if (f == NULL)
        return NULL;
    fseek(f, 0, SEEK_END);
    length = ftell(f);
    rewind(f);
    *size = (size_t)length;
    data = malloc(*size == 0 ? 1 : *size);
    assert_int_equal(fread(data, 1, *size, f), *size);
    fclose(f);
    return data;
}

struct summary {
    double min, max, mean, rms;
    size_t missing;
};

static struct summary
summarise(const struct rc_grid *g)
{
    struct summary s = {.min = INFINITY, .max = -INFINITY};
    size_t n = g->nx * g->ny;
    long double sum = 0, squares = 0; /* so that the order of the points does not matter */
    double there;

    for (size_t k = 0; k < n; k++) {
        if (isnan(g->v[k])) {
            s.missing++;
            continue;
        }
        s.min = fmin(s.min, g->v[k]);
        s.max = fmax(s.max, g->v[k]);
        sum += (long double)g->v[k];
    }
    there = (double)(n - s.missing);
    s.mean = (double)(sum / (long double)there);
    for (size_t k = 0; k < n; k++)
        if (!isnan(g->v[k]))
            squares += (long double)((g->v[k] - s.mean) * (g->v[k] - s.mean));
    s.rms = sqrt((double)squares / there);
    return s;
}

static void
check_near(const char *file, const char *what, double value, double truth, double within)
{
    if (!(fabs(value - truth) <= within))
        fault("%s: %s is %.17g, the manifest says %.17g", file, what, value, truth);
}

/* "row,col,value;..." with MISSING for a value. */
static size_t
check_probes(const char *file, const struct rc_grid *g, const char *text)
{
    size_t n = 0;

    while (*text != '\0') {
        char *end;
        size_t row = strtoul(text, &end, 10), column = strtoul(end + 1, &end, 10);
        double value;

        assert_true(row < g->ny && column < g->nx);
        value = g->v[row * g->nx + column];
        if (strncmp(end + 1, "MISSING", 7) == 0) {
            if (!isnan(value))
                fault("%s: row %zu, column %zu is %g, not missing", file, row, column, value);
            end += 8;
        } else {
            double truth = strtod(end + 1, &end);
            if (!isnan(value) || strcmp(file, probes_under_mask) != 0)
                check_near(file, "a probe", value, truth, rounding * fabs(truth));
        }
        n++;
        text = *end == ';' ? end + 1 : end;
    }
    return n;
}

/* If the manifest has no spacing, because the steps of x differ in the last digit, its note has both ends of
 * x. */
static double
wanted_dx(char *column[COLUMNS])
{
    const char *first = strstr(column[NOTE], "x0="), *last = strstr(column[NOTE], "x_last=");

    if (strcmp(column[DX], "nan") != 0 || first == NULL || last == NULL)
        return strtod(column[DX], NULL);
    return (strtod(last + 7, NULL) - strtod(first + 3, NULL)) / (strtod(column[NX], NULL) - 1);
}

static void
check_grid(char *column[COLUMNS], struct rc_grid *g)
{
    const char *file = column[FILE_NAME];
    double dx = wanted_dx(column), dy = strtod(column[DY], NULL);
    double mean = strtod(column[Z_MEAN], NULL), rms = strtod(column[Z_RMS], NULL);
    size_t probes, before = faults;
    double bound = strcmp(file, single) == 0 ? 1e-8 : summed; /* tolerance of mean and rms */
    struct summary s;

    if (strcmp(g->channel, "height") != 0 || strcmp(g->unit, "m") != 0)
        fault("%s: the channel is '%s' in %s", file, g->channel, g->unit);
    if (g->nx != strtoul(column[NX], NULL, 10) || g->ny != strtoul(column[NY], NULL, 10)) {
        fault("%s: read as %zu x %zu", file, g->nx, g->ny);
        return;
    }
    for (size_t k = 0; strcmp(file, single) == 0 && k < g->nx * g->ny; k++)
        g->v[k] = (double)(float)g->v[k];
    s = summarise(g);
    if (strcmp(column[LATERAL_UNIT], "m") == 0 || strcmp(column[DX], "nan") != 0)
        check_near(file, "dx", g->dx, dx, rounding * dx);
    if (g->ny == 1) /* a profile */
        dy = g->dx;
    check_near(file, "dy", g->dy, dy, (strcmp(file, dy_of_x) == 0 ? 5e-8 : rounding) * dy);
    if (s.missing != strtoul(column[N_MISSING], NULL, 10))
        fault("%s: %zu missing", file, s.missing);
    check_near(file, "the minimum", s.min, strtod(column[Z_MIN], NULL), rounding * fabs(s.min));
    check_near(file, "the maximum", s.max, strtod(column[Z_MAX], NULL), rounding * fabs(s.max));
    /* the error of a mean near zero is relative to the heights that cancel in it. The error of an rms height
     * of zero is the last digit of the heights */
    check_near(file, "the mean", s.mean, mean, bound * fmax(fabs(mean), rms));
    check_near(file, "the rms height", s.rms, rms, fmax(bound * rms, 1e-15 * fabs(mean)));
    probes = check_probes(file, g, column[PROBES]);
    if (probes == 0)
        fault("%s: no probe is given", file);
    if (faults == before)
        printf("%-62s %4zu x %-4zu %5zu missing, %zu probes: as in the manifest\n", file, g->nx,
               g->ny, s.missing, probes);
}

/* The default channel. */
static size_t
topography_of(const struct rc_format *format, const struct rc_file *file,
              const struct rc_wish *wish)
{
    struct rc_channel channel[64];
    size_t n = list_maps(format, file, wish, channel, 64, NULL), index;

    n = n < 64 ? n : 64;
    index = rc_format_topography(channel, n, "m").index;
    return index < n ? index : 0;
}

/* A file with steps without a unit is refused; the message gives the steps, which must be those of the
 * manifest. */
static void
check_steps(char *column[COLUMNS], const struct rc_format *format, const struct rc_file *file)
{
    struct rc_wish wish = {.dx = NAN, .dy = NAN, .z_unit = 1};
    double dx = strtod(column[DX], NULL), dy = strtod(column[DY], NULL);
    struct rc_err err = {""};
    struct rc_grid *g = read_map(format, file, &wish, 0, NULL, &err);
    const char *steps = strstr(err.text, "its steps are ");
    char *end;

    rc_grid_free(g);
    for (size_t k = 0; k < sizeof unitless / sizeof *unitless; k++)
        if (strcmp(format->name, unitless[k]) == 0 && steps == NULL)
            fault("%s: the refusal does not say the steps: %s", column[FILE_NAME], err.text);
    if (g != NULL || steps == NULL || isnan(dx))
        return;
    check_near(column[FILE_NAME], "the step in x", strtod(steps + 14, &end), dx, rounding * dx);
    if (!isnan(dy) && strncmp(end, " and ", 5) == 0)
        check_near(column[FILE_NAME], "the step in y", strtod(end + 5, NULL), dy, rounding * dy);
    steps_checked++;
}

/* The channel of the manifest: "Height#6" is the channel named Height, or the topography if there is no such
 * name. */
static size_t
channel_of(const struct rc_format *format, const struct rc_file *file, const struct rc_wish *wish,
           const char *name)
{
    struct rc_channel channel[64];
    size_t length = strcspn(name, "#");
    size_t n = list_maps(format, file, wish, channel, 64, NULL);

    for (size_t k = 0; k < n && k < 64; k++)
        if (strlen(channel[k].name) == length && strncmp(channel[k].name, name, length) == 0)
            return k;
    return topography_of(format, file, wish);
}

static void
check_file(char *column[COLUMNS], const char *reader, const struct rc_file *file)
{
    struct rc_wish wish = rc_no_wish;
    const struct rc_format *format;
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    const char *reason = NULL;
    struct rc_grid *g;

    /* data that the file lacks come from options */
    if (strcmp(column[LATERAL_UNIT], "unknown") == 0 && strcmp(column[DX], "nan") != 0) {
        wish.dx = strtod(column[DX], NULL);
        wish.dy = strcmp(column[DY], "nan") == 0 ? NAN : strtod(column[DY], NULL);
    } else if (strcmp(column[LATERAL_UNIT], "unknown") == 0)
        wish.dx = 1;
    if (strcmp(column[Z_UNIT], "m") != 0)
        wish.z_unit = 1;
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        if (strcmp(refused[k].file, column[FILE_NAME]) == 0) {
            reason = refused[k].refused_for;
            wish.dx = NAN;
            exceptions_met++;
        }
    exceptions_met += strcmp(column[FILE_NAME], probes_under_mask) == 0;
    exceptions_met += strcmp(column[FILE_NAME], single) == 0;
    exceptions_met += strcmp(column[FILE_NAME], dy_of_x) == 0;
    format = rc_format_find(file, &err);
    if (format == NULL || strcmp(format->name, reader) != 0) {
        fault("%s: %s", column[FILE_NAME], format == NULL ? err.text : format->name);
        return;
    }
    if (strcmp(column[LATERAL_UNIT], "unknown") == 0)
        check_steps(column, format, file);
    g = read_map(format, file, &wish, channel_of(format, file, &wish, column[CHANNEL]), &notes,
                 &err);
    if (g != NULL && reason == NULL)
        check_grid(column, g);
    else if (g != NULL || reason == NULL || strstr(err.text, reason) == NULL)
        fault("%s: %s", column[FILE_NAME], g == NULL ? err.text : "read, and should not be");
    else
        printf("%-62s refused, as it should be: %s\n", column[FILE_NAME], err.text);
    rc_grid_free(g);
}

static void
check_row(char *column[COLUMNS], const char *reader)
{
    struct rc_file file = {.name = strrchr(column[FILE_NAME], '/') + 1};
    unsigned char *data = whole_file(column[FILE_NAME], &file.size);

    file.data = data;
    if (data == NULL)
        fault("%s is in the manifest and not in the corpus", column[FILE_NAME]);
    else
        check_file(column, reader, &file);
    free(data);
}

static bool
split(char *line, char *column[COLUMNS])
{
    line[strcspn(line, "\n")] = '\0';
    for (size_t k = 0; k < COLUMNS; k++) {
        column[k] = line;
        line += strcspn(line, "\t");
        if (*line == '\0' && k + 1 < COLUMNS)
            return false;
        *line++ = '\0';
    }
    return true;
}

static FILE *
open_manifest(void)
{
    char path[4096];

    folder = getenv("RC_CORPUS");
    if (folder == NULL)
        return NULL;
    snprintf(path, sizeof path, "%s/manifest.tsv", folder);
    return fopen(path, "r");
}

static void
rows_of_the_manifest(void **state)
{
    FILE *f = open_manifest();
    char line[LINE_MOST], *column[COLUMNS];
    size_t read = 0, others = 0;

    (void)state;
    assert_non_null(fgets(line, sizeof line, f)); /* titles */
    while (fgets(line, sizeof line, f) != NULL) {
        const char *reader;
        if (!split(line, column))
            fail_msg("a row of the manifest has fewer than %d columns: %s", COLUMNS, line);
        reader = reader_of(column[FORMAT]);
        if (reader == NULL) {
            printf("%-62s no reader yet for %s\n", column[FILE_NAME], column[FORMAT]);
            others++;
            continue;
        }
        check_row(column, reader);
        read++;
    }
    fclose(f);
    printf("%zu channels as in the manifest, %zu with steps that lack a unit; %zu are of formats "
           "without a reader\n",
           read, steps_checked, others);
    assert_int_equal(exceptions_met, EXCEPTIONS);
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++) {
        if (rc_format_named(formats[k].here) == NULL)
            fault("corpus.list names a reader '%s', which there is not", formats[k].here);
        if (formats[k].rows == 0)
            fault("no row of the manifest is of the format '%s'", formats[k].in_manifest);
    }
    if (faults > 0)
        fail_msg("%zu faults", faults);
}

/* Reads a row of bad.tsv: repository, commit, path, and further columns. Returns its index in bad[], or
 * BAD. */
static size_t
check_bad(char *line)
{
    struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};
    char *rest, *repo = strtok_r(line, "\t", &rest), *commit = strtok_r(NULL, "\t", &rest);
    char *path = strtok_r(NULL, "\t", &rest);
    const struct rc_format *format;
    struct rc_err err = {""};
    struct rc_file file;
    struct rc_grid *g = NULL;
    unsigned char *data;
    char name[600];
    size_t k = 0;

    assert_true(repo != NULL && commit != NULL && path != NULL);
    snprintf(name, sizeof name, "bad/%s__%s", strrchr(repo, '/') + 1, strrchr(path, '/') + 1);
    file.name = name + strlen("bad/");
    while (k < BAD && strcmp(bad[k].file, file.name) != 0)
        k++;
    if (k == BAD) {
        fault("%s is in bad.tsv, and this test does not say what it is refused for", name);
        return k;
    }
    if ((data = whole_file(name, &file.size)) == NULL) {
        fault("%s is in bad.tsv and not in the corpus", name);
        return k;
    }
    file.data = data;
    if ((format = rc_format_find(&file, &err)) != NULL)
        g = read_map(format, &file, &wish, topography_of(format, &file, &wish), NULL, &err);
    if (bad[k].refused_for == in_manifest) {
        if (g == NULL)
            fault("%s is refused for '%s'", name, err.text);
    } else if (g != NULL && bad[k].refused_for == NULL) {
        if (g->nx != bad[k].points || g->ny != 1)
            fault("%s is read as %zu x %zu", name, g->nx, g->ny);
        for (size_t i = 0; i < g->nx; i++)
            if (g->v[i] != (double)(g->nx - i))
                fault("%s: value %zu is %g", name, i, g->v[i]);
    } else if (g != NULL)
        fault("%s is read by %s", name, format->name);
    else if (bad[k].refused_for == NULL)
        fault("%s is refused for '%s'", name, err.text);
    else if (strstr(err.text, bad[k].refused_for) == NULL)
        fault("%s is refused for '%s', not for '%s'", name, err.text, bad[k].refused_for);
    else
        printf("%-52s %-9s %s\n", name, format == NULL ? "-" : format->name, err.text);
    rc_grid_free(g);
    free(data);
    return k;
}

static void
bad_files(void **state)
{
    char path[4096], line[LINE_MOST];
    bool met[BAD + 1] = {false};
    size_t before = faults;
    FILE *f;

    (void)state;
    snprintf(path, sizeof path, "%s/corpus/bad.tsv", folder);
    f = fopen(path, "r");
    assert_non_null(f);
    assert_non_null(fgets(line, sizeof line, f)); /* titles */
    while (fgets(line, sizeof line, f) != NULL)
        met[check_bad(line)] = true;
    fclose(f);
    for (size_t k = 0; k < BAD; k++)
        if (!met[k])
            fault("%s is not in bad.tsv", bad[k].file);
    if (faults > before)
        fail_msg("%zu faults", faults - before);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_the_manifest),
        cmocka_unit_test(bad_files),
    };
    FILE *f = open_manifest();

    if (f == NULL) {
        printf("skipped: RC_CORPUS names no folder with a manifest.tsv\n");
        return SKIPPED;
    }
    fclose(f);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
