/* Every channel of a real file is read as the independent readers of the manifest read it. */
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
    COLUMNS = 24
};

/* What the manifest calls the formats that have a reader here. */
static const struct {
    const char *in_manifest, *here;
} formats[] = {
    {"x3p", "x3p"},
    {"ascii-matrix", "ascii"},
    {"spip-asc", "ascii"},
    {"jpk-image", "jpk"},
    {"park-tiff", "park"},
    {"netcdf", "netcdf"},
    {"hdf5-generic", "hdf5"},
};

static const char *folder;

static const char *
reader_of(const char *format)
{
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++)
        if (strcmp(format, formats[k].in_manifest) == 0)
            return formats[k].here;
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
    double sum = 0, squares = 0, there;

    for (size_t k = 0; k < n; k++) {
        if (isnan(g->v[k])) {
            s.missing++;
            continue;
        }
        s.min = fmin(s.min, g->v[k]);
        s.max = fmax(s.max, g->v[k]);
        sum += g->v[k];
    }
    there = (double)(n - s.missing);
    s.mean = sum / there;
    for (size_t k = 0; k < n; k++)
        if (!isnan(g->v[k]))
            squares += (g->v[k] - s.mean) * (g->v[k] - s.mean);
    s.rms = sqrt(squares / there);
    return s;
}

static void
check_near(const char *file, const char *what, double value, double truth, double within)
{
    if (!(fabs(value - truth) <= within))
        fail_msg("%s: %s is %.17g, the manifest says %.17g", file, what, value, truth);
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
                fail_msg("%s: row %zu, column %zu is %g, not missing", file, row, column, value);
            end += 8;
        } else {
            double truth = strtod(end + 1, &end);
            check_near(file, "a probe", value, truth, 1e-12 * fabs(truth));
        }
        n++;
        text = *end == ';' ? end + 1 : end;
    }
    return n;
}

static void
check_grid(char *column[COLUMNS], const struct rc_grid *g)
{
    const char *file = column[FILE_NAME];
    double dx = strtod(column[DX], NULL), dy = strtod(column[DY], NULL);
    double mean = strtod(column[Z_MEAN], NULL), rms = strtod(column[Z_RMS], NULL);
    struct summary s = summarise(g);
    size_t probes;

    assert_string_equal(g->channel, "height");
    assert_string_equal(g->unit, "m");
    assert_int_equal(g->nx, strtoul(column[NX], NULL, 10));
    assert_int_equal(g->ny, strtoul(column[NY], NULL, 10));
    check_near(file, "dx", g->dx, dx, 1e-12 * dx);
    check_near(file, "dy", g->dy, dy, 1e-12 * dy);
    assert_int_equal(s.missing, strtoul(column[N_MISSING], NULL, 10));
    check_near(file, "the minimum", s.min, strtod(column[Z_MIN], NULL), 1e-9 * fabs(s.min));
    check_near(file, "the maximum", s.max, strtod(column[Z_MAX], NULL), 1e-9 * fabs(s.max));
    /* a mean of about zero is as exact as the heights that cancel in it */
    check_near(file, "the mean", s.mean, mean, 1e-9 * fmax(fabs(mean), rms));
    check_near(file, "the rms height", s.rms, rms, 1e-9 * rms);
    probes = check_probes(file, g, column[PROBES]);
    printf("%-62s %4zu x %-4zu %5zu missing, %zu probes: as in the manifest\n", file, g->nx,
           g->ny, s.missing, probes);
}

/* The channel that the manifest means: "Height#6" is the one named Height; the first one where none
 * has that name. */
static size_t
channel_of(const struct rc_format *format, const struct rc_file *file, const struct rc_wish *wish,
           const char *name)
{
    struct rc_channel channel[64];
    size_t length = strcspn(name, "#");
    size_t n = format->list(file, wish, channel, 64, NULL);

    for (size_t k = 0; k < n && k < 64; k++)
        if (strlen(channel[k].name) == length && strncmp(channel[k].name, name, length) == 0)
            return k;
    return 0;
}

static void
check_row(char *column[COLUMNS], const char *reader)
{
    struct rc_wish wish = {.dx = NAN, .dy = NAN, .z_unit = NAN};
    const char *slash = strrchr(column[FILE_NAME], '/');
    struct rc_file file = {.name = slash + 1};
    const struct rc_format *format;
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    unsigned char *data = whole_file(column[FILE_NAME], &file.size);
    struct rc_grid *g;

    if (data == NULL)
        fail_msg("%s is in the manifest and not in the corpus", column[FILE_NAME]);
    file.data = data;
    /* where the file does not say, its user must */
    if (strcmp(column[LATERAL_UNIT], "unknown") == 0)
        wish.dx = strtod(column[DX], NULL);
    if (strcmp(column[Z_UNIT], "unknown") == 0)
        wish.z_unit = 1;
    format = rc_format_find(&file, &err);
    if (format == NULL)
        fail_msg("%s: %s", column[FILE_NAME], err.text);
    assert_string_equal(format->name, reader);
    g = format->read(&file, &wish, channel_of(format, &file, &wish, column[CHANNEL]), &notes,
                     &err);
    if (g == NULL)
        fail_msg("%s: %s", column[FILE_NAME], err.text);
    check_grid(column, g);
    rc_grid_free(g);
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
            others++;
            continue;
        }
        check_row(column, reader);
        read++;
    }
    fclose(f);
    printf("%zu channels as in the manifest; %zu are of formats without a reader\n", read, others);
    assert_true(read > 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_the_manifest),
    };
    FILE *f = open_manifest();

    if (f == NULL) {
        printf("skipped: RC_CORPUS names no folder with a manifest.tsv\n");
        return SKIPPED;
    }
    fclose(f);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
