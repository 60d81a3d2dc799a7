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
    NOTE = 23,
    COLUMNS = 24
};

/* What the manifest calls the formats that have a reader here. */
static const struct {
    const char *in_manifest, *here;
} formats[] = {
    {"x3p", "x3p"},
    {"ascii-matrix", "ascii"},
    {"spip-asc", "ascii"},
    {"sdf-ascii", "sdf"},
    {"digitalsurf-sur", "sur"},
    {"digitalsurf-pro", "sur"},
    {"wyko-opd", "opd"},
    {"metropro-dat", "metropro"},
    {"alicona-al3d", "al3d"},
    {"sensofar-plu", "plu"},
    {"nanoscope", "nanoscope"},
    {"nanosurf-nid", "nid"},
    {"gwy", "gwy"},
    {"gsf", "gsf"},
    {"igor-ibw", "ibw"},
    {"mi-picoview", "mi"},
    {"wsxm-stp", "wsxm"},
    {"wsxm-top", "wsxm"},
    {"bcrf", "bcr"},
    {"frt", "frt"},
    {"truemap-tmd", "tmd"},
    {"surfer-grd", "grd"},
    {"esri-asc", "esri"},
    {"npy", "npy"},
    {"opdx", "opdx"},
    {"xyz", "xyz"},
    {"profile-text", "profile"},
    {"jpk-image", "jpk"},
    {"park-tiff", "park"},
    {"netcdf", "netcdf"},
    {"hdf5-generic", "hdf5"},
};

/* Rows of which a reader that gives something else than the manifest, or refuses, is right. */
static const struct {
    const char *file, *refused_for;
} refused[] = {
    {"profile-text/SurfaceTopography__xy-1.txt", "even"},
    {"profile-text/SurfaceTopography__xy-3.txt", "even"},
};

/* Rows whose probes were taken from under the mask that the same row counts as missing. */
static const char probes_under_mask[] = "generated/frt-2.gwy";

/* The row whose truth was worked out in single precision, sums among it: our heights are rounded
 * to that, and are then the same numbers. */
static const char single[] = "truemap-tmd/SurfaceTopography__tmd-1.tmd";

static const char *folder;
static size_t faults, steps_checked;

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
                check_near(file, "a probe", value, truth, 1e-12 * fabs(truth));
        }
        n++;
        text = *end == ';' ? end + 1 : end;
    }
    return n;
}

/* Where the manifest gives no spacing, because the steps of x are not even to the last digit, its
 * note has both ends. */
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
    double bound = strcmp(file, single) == 0 ? 1e-8 : 1e-9; /* of mean and rms */
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
        check_near(file, "dx", g->dx, dx, 1e-12 * dx);
    if (g->ny == 1) /* a profile */
        dy = g->dx;
    check_near(file, "dy", g->dy, dy, 1e-12 * dy);
    if (s.missing != strtoul(column[N_MISSING], NULL, 10))
        fault("%s: %zu missing", file, s.missing);
    check_near(file, "the minimum", s.min, strtod(column[Z_MIN], NULL), 1e-9 * fabs(s.min));
    check_near(file, "the maximum", s.max, strtod(column[Z_MAX], NULL), 1e-9 * fabs(s.max));
    /* a mean of about zero is as exact as the heights that cancel in it, and the last digit of a
     * rms height of zero is that of the heights */
    check_near(file, "the mean", s.mean, mean, bound * fmax(fabs(mean), rms));
    check_near(file, "the rms height", s.rms, rms, fmax(bound * rms, 1e-15 * fabs(mean)));
    probes = check_probes(file, g, column[PROBES]);
    if (faults == before)
        printf("%-62s %4zu x %-4zu %5zu missing, %zu probes: as in the manifest\n", file, g->nx,
               g->ny, s.missing, probes);
}

/* The channel that a user gets who names none: the first height. */
static size_t
first_height(const struct rc_format *format, const struct rc_file *file, const struct rc_wish *wish)
{
    struct rc_channel channel[64];
    size_t n = format->list(file, wish, channel, 64, NULL);

    for (size_t k = 0; k < n && k < 64; k++)
        if (strcmp(channel[k].unit, "m") == 0)
            return k;
    return 0;
}

/* A file that has steps without a unit is refused by them; they must be those of the manifest. */
static void
check_steps(char *column[COLUMNS], const struct rc_format *format, const struct rc_file *file)
{
    struct rc_wish wish = {.dx = NAN, .dy = NAN, .z_unit = 1};
    double dx = strtod(column[DX], NULL), dy = strtod(column[DY], NULL);
    struct rc_err err = {""};
    struct rc_grid *g = format->read(file, &wish, 0, NULL, &err);
    const char *steps = strstr(err.text, "its steps are ");
    char *end;

    rc_grid_free(g);
    if (g != NULL || steps == NULL || isnan(dx))
        return;
    check_near(column[FILE_NAME], "the step in x", strtod(steps + 14, &end), dx, 1e-12 * dx);
    if (!isnan(dy) && strncmp(end, " and ", 5) == 0)
        check_near(column[FILE_NAME], "the step in y", strtod(end + 5, NULL), dy, 1e-12 * dy);
    steps_checked++;
}

/* The channel that the manifest means: "Height#6" is the one named Height; the first of heights
 * where none has that name. */
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
    return first_height(format, file, wish);
}

static void
check_file(char *column[COLUMNS], const char *reader, const struct rc_file *file)
{
    struct rc_wish wish = {.dx = NAN, .dy = NAN, .z_unit = NAN};
    const struct rc_format *format;
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    const char *reason = NULL;
    struct rc_grid *g;

    /* where the file does not say, its user must */
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
        }
    format = rc_format_find(file, &err);
    if (format == NULL || strcmp(format->name, reader) != 0) {
        fault("%s: %s", column[FILE_NAME], format == NULL ? err.text : format->name);
        return;
    }
    if (strcmp(column[LATERAL_UNIT], "unknown") == 0)
        check_steps(column, format, file);
    g = format->read(file, &wish, channel_of(format, file, &wish, column[CHANNEL]), &notes, &err);
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
    assert_true(read > 0);
    if (faults > 0)
        fail_msg("%zu faults", faults);
}

/* Files that must be refused, each with a reason: those of bad.tsv. */
static void
bad_files(void **state)
{
    static const char *const readable[] = {"none so far"};
    char path[4096], line[LINE_MOST];
    size_t n = 0, before = faults;
    FILE *f;

    (void)state;
    snprintf(path, sizeof path, "%s/corpus/bad.tsv", folder);
    f = fopen(path, "r");
    assert_non_null(f);
    assert_non_null(fgets(line, sizeof line, f)); /* titles */
    while (fgets(line, sizeof line, f) != NULL) {
        struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};
        char *repo = line, *name, copy[512], full[600];
        const struct rc_format *format;
        struct rc_file file;
        struct rc_err err = {""};
        unsigned char *data;
        struct rc_grid *g = NULL;

        line[strcspn(line, "\t")] = '\0';
        name = line + strlen(line) + 1;
        name = strchr(name, '\t') + 1; /* behind the commit */
        name[strcspn(name, "\t")] = '\0';
        snprintf(copy, sizeof copy, "bad/%s__%s", strchr(repo, '/') + 1, strrchr(name, '/') + 1);
        snprintf(full, sizeof full, "%s", copy);
        data = whole_file(full, &file.size);
        if (data == NULL) {
            fault("%s is in bad.tsv and not in the corpus", full);
            continue;
        }
        file.data = data;
        file.name = strrchr(full, '/') + 1;
        if ((format = rc_format_find(&file, &err)) != NULL)
            g = format->read(&file, &wish, first_height(format, &file, &wish), NULL, &err);
        if (g != NULL && strstr(full, readable[0]) == NULL)
            fault("%s is read by %s", full, format->name);
        else if (g == NULL && err.text[0] == '\0')
            fault("%s is refused without a reason", full);
        else
            printf("%-52s %-9s %s\n", full, format == NULL ? "-" : format->name, err.text);
        rc_grid_free(g);
        free(data);
        n++;
    }
    fclose(f);
    assert_true(n > 20);
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
