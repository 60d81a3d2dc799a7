/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every variant of the flat formats is read according to its specification. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "formats/format.h"
#include "made/made.h"

static size_t
first_height(const struct rc_format *format, const struct rc_file *file, const struct rc_wish *wish)
{
    struct rc_channel channel[64];
    size_t n = list_maps(format, file, wish, channel, 64, NULL);

    for (size_t k = 0; k < n && k < 64; k++)
        if (strcmp(channel[k].unit, "m") == 0)
            return k;
    return 0;
}

/* The numbers are read exactly; the file may hold spacing and scale in single precision. */
static void
check(const struct made_file *f, const struct rc_grid *g)
{
    double dy = (f->flags & SQUARE) != 0        ? 1.1e-6
                : strcmp(f->format, "opd") == 0 ? 1.375e-6
                                                : 1.29e-6;

    assert_int_equal(g->nx, NX);
    assert_int_equal(g->ny, NY);
    if (!(fabs(g->dx - 1.1e-6) <= 2 * float_rounding * 1.1e-6) ||
        !(fabs(g->dy - dy) <= 2 * float_rounding * dy))
        fail_msg("%s: the spacing is %g, %g", f->title, g->dx, g->dy);
    assert_string_equal(g->channel, "height");
    assert_string_equal(g->unit, "m");
    for (size_t k = 0; k < NX * NY; k++) {
        double wanted = value_of(k, (f->flags & PLAIN) == 0) * f->scale + f->zero;
        bool missing = k == MISSING_AT && (f->flags & HAS_MISSING) != 0;

        if (missing ? !isnan(g->v[k])
                    : !(fabs(g->v[k] - wanted) <=
                        float_rounding * fabs(wanted) + last_digit * fabs(f->zero)))
            fail_msg("%s: height %zu is %.17g, not %.17g", f->title, k, g->v[k],
                     missing ? (double)NAN : wanted);
    }
}

static void
variants(void **state)
{
    (void)state;
    for (size_t k = 0; k < made_files_n; k++) {
        const struct made_file *f = &made_files[k];
        struct rc_wish wish = wish_for(f->flags);
        const struct rc_format *format;
        struct rc_notes notes = {0};
        struct bytes m = {0};
        struct rc_err err = {""};
        struct rc_file file;
        struct rc_grid *g;

        f->make(&m, f->variant);
        for (int named = 0; named < 2; named++) { /* the content alone identifies the format */
            file = (struct rc_file){named ? f->name : "noname", m.data, m.n};
            format = rc_format_find(&file, &err);
            if (format == NULL || strcmp(format->name, f->format) != 0)
                fail_msg("%s is taken for %s", f->title, format == NULL ? err.text : format->name);
        }
        g = read_map(format, &file, &wish, first_height(format, &file, &wish), &notes, &err);
        if (g == NULL)
            fail_msg("%s: %s", f->title, err.text);
        check(f, g);
        printf("%-24s %-10s %4zu bytes, as it should be\n", f->title, f->format, m.n);
        rc_grid_free(g);
        drop(&m);
    }
}

static struct rc_grid *
read_made(const char *format, const struct bytes *m, size_t channel, struct rc_err *err)
{
    struct rc_file file = {"made", m->data, m->n};
    struct rc_wish wish = rc_no_wish;

    return read_map(rc_format_named(format), &file, &wish, channel, NULL, err);
}

/* Channels other than heights keep their name and get the SI unit. */
static void
other_channels(void **state)
{
    static const struct {
        const char *format;
        void (*make)(struct bytes *m, int variant);
        int variant;
        size_t channel;
        const char *name, *unit;
    } rows[] = {
        {"gwy", make_gwy, 0, 0, "values", "V"},
        {"mi", make_mi, 1, 0, "Friction", "V"},
        {"ibw", make_ibw, 2, 0, "PhaseTrace", "deg"},
        {"nid", make_nid, 0, 0, "Topo, Scan forward", "V"},
        {"sxm", make_sxm, 0, 0, "Current", "A"},
        {"mdt", make_mdt, 0, 0, "Phase1", "deg"},
        {"createc", make_createc, 2, 1, "Plane 2", "count"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct bytes m = {0};
        struct rc_err err = {""};
        struct rc_grid *g;

        rows[k].make(&m, rows[k].variant);
        g = read_made(rows[k].format, &m, rows[k].channel, &err);
        if (g == NULL)
            fail_msg("%s: %s", rows[k].format, err.text);
        assert_string_equal(g->channel, rows[k].name);
        assert_string_equal(g->unit, rows[k].unit);
        rc_grid_free(g);
        assert_null(read_made(rows[k].format, &m, 7, &err));
        assert_non_null(strstr(err.text, "no channel 8"));
        drop(&m);
    }
}

/* Rows beyond the end of a scan of Createc are missing. If x does not determine the factor of a count,
 * nothing else in the file does. */
static void
createc_scans(void **state)
{
    struct bytes m = {0};
    struct rc_err err = {""};
    struct rc_grid *g;
    char *place;

    (void)state;
    make_createc(&m, 1);
    place = (char *)m.data + strlen((char *)m.data);
    strcpy(place, "ImageYPosMax=2\r\n");
    g = read_made("createc", &m, 0, &err);
    assert_non_null(g);
    for (size_t k = 0; k < 6; k++)
        assert_true(k < 3 ? g->v[k] == (double)(float)value_of(k, true) * 0.02 * 1e-9
                          : isnan(g->v[k]));
    rc_grid_free(g);
    strcpy(place, "Dacto[A]xy=3\r\n");
    assert_null(read_made("createc", &m, 0, &err));
    assert_non_null(strstr(err.text, "--z-unit"));
    m.n--;
    assert_null(read_made("createc", &m, 0, &err));
    assert_non_null(strstr(err.text, "promises 2 planes of 3 x 2 numbers"));
    drop(&m);
}

/* Reads a synthetic scan of Createc whose header ends in these lines. Every height must be the given number
 * of nanometres per count, with a relative error of at most `most`. */
static void
createc_counts_are(const char *lines, double count, double most)
{
    struct bytes m = {0};
    struct rc_err err = {""};
    struct rc_grid *g;
    char *place;

    make_createc(&m, 1);
    place = strstr((char *)m.data, "Delta X");
    assert_non_null(place);
    memset(place, 0, strlen(place));
    strcpy(place, lines);
    if ((g = read_made("createc", &m, 0, &err)) == NULL)
        fail_msg("%s", err.text);
    for (size_t n = 0; n < NX * NY; n++)
        assert_true(fabs(g->v[n] - value_of(n, true) * count * 1e-9) <= most * fabs(g->v[n]));
    rc_grid_free(g);
    drop(&m);
}

/* A count of z, where the header has the factor 0.00038. The converter has 20 V over 2^20 counts, amplified
 * 10 times, on a piezo of 20 Angstrom per volt: 4000 / 2^20 Angstrom. If the piezo constant contradicts the
 * factor, the factor of the file is used, times the gain. */
static void
createc_counts(void **state)
{
    static const struct {
        const char *piezo, *gain;
        double count; /* nm */
    } rows[] = {{"20.00", "10", 400 / 1048576.0}, {"20.00", "3", 120 / 1048576.0},
                {"20.00", "1", 40 / 1048576.0},   {"30.00", "10", 0.00038},
                {"30.00", "3", 0.00038 * 0.3},    {"0", "10", 0.00038},
                {"x", "30", 0.00038 * 3}};
    char lines[256];

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        snprintf(lines, sizeof lines,
                 "Delta X / Delta X [Dac]=576755\r\nGainZ / GainZ=%s\r\nZPiezoconst=%s\r\n"
                 "Dacto[A]xy=0.00191\r\nDacto[A]z=0.00038\r\n",
                 rows[k].gain, rows[k].piezo);
        createc_counts_are(lines, rows[k].count, last_digit);
    }
    /* the factor includes the gain already, in Angstrom; or the gain is absent */
    createc_counts_are("Delta X / Delta X [Dac]=576755\r\nGainX / GainX=3\r\nGainZ / GainZ=10\r\n"
                       "ZPiezoconst=20\r\nDacto[A]xy=0.01907\r\nDacto[A]z=0.00381\r\n",
                       400 / 1048576.0, last_digit);
    createc_counts_are("GainZ / GainZ=3\r\nZPiezoconst=20\r\n", 120 / 1048576.0, last_digit);
}

/* Numbers from the headers of three real files. Z-Res. is the height that the instrument's program computed
 * for 128 grey levels of Imagegrayfactor counts each. Both have three or four digits. */
static void
createc_headers(void **state)
{
    static const struct {
        const char *lines;
        double resolution, grey; /* Angstrom; counts */
    } rows[] = {
        {"Length x[A]=29.29777\r\nDelta X / Delta X [Dac]=512\r\nGainX / GainX=10\r\n"
         "GainZ / GainZ=3\r\nDacto[A]xy=0.00191\r\nDacto[A]z=0.00038\r\nZPiezoconst= 20.00\r\n",
         4.749, 32.416},
        {"Length x[A]=4.529435\r\nDelta X / Delta X [Dac]=256\r\nGainX / GainX=10\r\n"
         "GainZ / GainZ=10\r\nDacto[A]xy=0.00059\r\nDacto[A]z=0.00014\r\nZPiezoconst=  7.33\r\n",
         3.039, 16.979},
        {"DAC-Type=16bit\r\nLength x[A]=14.64888\r\nDelta X / Delta X [Dac]=16\r\n"
         "GainX / GainX=10\r\nGainZ / GainZ=10\r\nDacto[A]xy=0.03052\r\nDacto[A]z=0.00610\r\n"
         "ZPiezoconst= 20.00\r\n",
         7.809, 0.999},
        {"Length x[A]=14.64888\r\nDelta X / Delta X [Dac]=16\r\n"
         "GainX / GainX=10\r\nGainZ / GainZ=10\r\nDacto[A]xy=0.03052\r\nDacto[A]z=0.00610\r\n",
         7.809, 0.999},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        createc_counts_are(rows[k].lines, 0.1 * rows[k].resolution / 128 / rows[k].grey,
                           k < 3 ? 6e-4 : 2e-3);
}

/* The wave has one unit for all its channels; labels show the channels with another unit. */
static void
labels_of_waves(void **state)
{
    static const struct {
        const char *label, *unit;
    } rows[] = {
        {"PhaseTrace", "deg"},     {"NapPhaseTrace", "deg"}, {"NapPhase", "deg"},
        {"PotentialRetrace", "V"}, {"NapPotential", "V"},    {"Current", "A"},
        {"NapCurrent", "A"},       {"FrequencyTrace", "Hz"}, {"NapFrequency", "Hz"},
        {"NapHeight", "m"},        {"ZSensorTrace", "m"},    {"Nap", "m"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct bytes m = {0};
        struct rc_channel channel[2];
        struct rc_file file;

        make_ibw(&m, 2);
        memset(m.data + m.n - 64, 0, 32);
        set_text(&m, m.n - 64, rows[k].label);
        file = file_of(&m, "a.ibw");
        assert_int_equal(list_maps(rc_format_named("ibw"), &file, &rc_no_wish, channel, 2, NULL),
                         2);
        assert_string_equal(channel[0].name, rows[k].label);
        assert_string_equal(channel[0].unit, rows[k].unit);
        assert_string_equal(channel[1].unit, "m");
        drop(&m);
    }
}

/* If the note has the settings of an Asylum microscope, which stores all values in SI units, the labels
 * determine the units. They do so also if the wave has another unit or none. A sensor that is not calibrated
 * has no unit. */
static void
labels_with_a_note(void **state)
{
    static const struct {
        const char *wave, *note, *label, *unit;
    } rows[] = {
        {"V", "ZLVDTSens: 2.35e-06\r", "HeightRetrace", "m"},
        {"V", "ZLVDTSens: 2.35e-06\r", "NapHeight", "m"},
        {"V", "a: b\rZLVDTSens:2.35e-06\r", "ZSensorTrace", "m"},
        {"V", "ZLVDTSens: -1\r", "ZSensorTrace", "V"},
        {"V", "ZLVDTSens: -1\r", "HeightTrace", "m"},
        {"V", "ZLVDTSens: 2.35e-06\r", "AmplitudeTrace", "m"},
        {"V", "ZLVDTSens: 2.35e-06\r", "LatPhaseTrace", "deg"},
        {"V", "another: 1\r", "HeightTrace", "V"},
        {"", "ZLVDTSens: -1\r", "HeightTrace", "m"},
        {"", "ZLVDTSens: -1\r", "ZSensorTrace", ""},
        {"", "", "HeightTrace", ""},
        {"m", "ZLVDTSens: 2.35e-06\r", "LatAmplitudeTrace", "V"},
        {"m", "ZLVDTSens: 2.35e-06\r", "UserIn0Trace", "V"},
        {"m", "", "UserIn0Trace", "m"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct rc_channel channel[2];
        struct bytes m = {0};
        struct rc_file file;
        size_t labels;

        make_ibw(&m, 2);
        memset(m.data + 212, 0, 4);
        set_text(&m, 212, rows[k].wave);
        m.n -= 4 + 96; /* the note with another length, and the labels after it */
        set_raw(&m, 12, RC_RAW_I32, (double)strlen(rows[k].note));
        add_text(&m, rows[k].note);
        labels = m.n;
        add_zeros(&m, 96);
        set_text(&m, labels + 32, rows[k].label);
        set_text(&m, labels + 64, "PhaseTrace");
        file = file_of(&m, "a.ibw");
        assert_int_equal(list_maps(rc_format_named("ibw"), &file, &rc_no_wish, channel, 2, NULL),
                         2);
        assert_string_equal(channel[0].name, rows[k].label);
        assert_string_equal(channel[0].unit, rows[k].unit);
        assert_string_equal(channel[1].unit, "deg");
        drop(&m);
    }
}

/* A scale whose unit contains parentheses. */
static void
scale_of_a_logarithm(void **state)
{
    struct rc_err err = {""};
    struct bytes m = {0};
    struct rc_grid *g;
    char *at;

    (void)state;
    make_nanoscope(&m, 2);
    at = strstr((char *)m.data, "\\@2:Z scale");
    assert_non_null(at);
    strcpy(at, "\\@2:Z scale: V [Sens. LogSens] (0.01 log(Arb)/LSB) 655.36 log(Arb)\r\n"
               "\\*File list end\r\n\x1a");
    if ((g = read_made("nanoscope", &m, 0, &err)) == NULL)
        fail_msg("%s", err.text);
    assert_string_equal(g->unit, "log(Arb)");
    for (size_t k = 0; k < NX * NY; k++)
        assert_true(fabs(g->v[k] - value_of(k, true) * 0.01) <= last_digit * fabs(g->v[k]));
    rc_grid_free(g);
    drop(&m);
}

/* If programs interpret a number differently a message tells the user, unless --z-unit is given. */
static void
doubts(void **state)
{
    static const struct {
        const char *format;
        void (*make)(struct bytes *m, int variant);
        int variant;
        const char *note; /* NULL: the meaning is clear */
    } rows[] = {
        {"tmd", make_tmd, 0, "no unit, and micrometres are assumed"},
        {"tmd", make_tmd, 1, NULL},
        {"wykotext", make_wykotext, 0, "Mult is not 1"},
        {"wykotext", make_wykotext, 1, "Mult is not 1"},
        {"wykotext", make_wykotext, 3, "files of points that are known have nanometres"},
        {"opd", make_opd, 0, NULL},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int said = 0; said < 2; said++) {
            struct rc_wish wish = rc_no_wish;
            struct rc_notes notes = {0};
            struct rc_err err = {""};
            struct bytes m = {0};
            struct rc_file file;
            struct rc_grid *g;
            size_t told = 0;

            rows[k].make(&m, rows[k].variant);
            file = file_of(&m, "made");
            if (said)
                wish.z_unit = 1e-3;
            g = read_map(rc_format_named(rows[k].format), &file, &wish, 0, &notes, &err);
            if (g == NULL)
                fail_msg("%s: %s", rows[k].format, err.text);
            for (size_t n = 0; n < notes.n; n++)
                told += strstr(notes.text[n],
                               rows[k].note == NULL ? "other programs" : rows[k].note) != NULL;
            assert_int_equal(told, rows[k].note != NULL && !said ? 1 : 0);
            rc_grid_free(g);
            drop(&m);
        }
}

/* A wave with one dimension. */
static void
profile_of_a_wave(void **state)
{
    struct rc_err err = {""};
    struct bytes m = {0};
    struct rc_grid *g;

    (void)state;
    make_ibw(&m, 1);
    m.big = true;
    set_raw(&m, 132, RC_RAW_I32, NX * NY);
    set_raw(&m, 136, RC_RAW_I32, 0);
    if ((g = read_made("ibw", &m, 0, &err)) == NULL)
        fail_msg("%s", err.text);
    assert_true(g->nx == NX * NY && g->ny == 1);
    assert_true(fabs(g->dx - 1.1e-6) <= last_digit * g->dx && g->dy == g->dx);
    for (size_t k = 0; k < NX * NY; k++) { /* the file has the lower row first */
        size_t at = (k + NX) % (NX * NY);

        assert_true(at == MISSING_AT
                        ? isnan(g->v[k])
                        : fabs(g->v[k] - value_of(at, true) * 1e-9) <= last_digit * fabs(g->v[k]));
    }
    rc_grid_free(g);
    memset(m.data + 216, 0, 4); /* no unit of x */
    refuse(rc_format_named("ibw"), &m, "--dx LENGTH says it (its steps are 1.1 and 1.1 ");
    drop(&m);
}

/* Heights in wavelengths, in a file without the wavelength. */
static void
no_wavelength(void **state)
{
    struct rc_wish wish = rc_no_wish;
    struct rc_err err = {""};
    struct rc_file file;
    struct bytes m = {0};
    struct rc_grid *g;

    (void)state;
    make_opd(&m, 0);
    memcpy(m.data + 2 + 3 * 24, "Wavelenght", 10);
    refuse(rc_format_named("opd"), &m, "does not give the unit of its heights: --z-unit");
    file = file_of(&m, "a.opd");
    wish.z_unit = 640e-9;
    if ((g = read_map(rc_format_named("opd"), &file, &wish, 0, NULL, &err)) == NULL)
        fail_msg("%s", err.text);
    assert_string_equal(g->unit, "m");
    for (size_t k = 0; k < NX * NY; k++)
        assert_true(k == MISSING_AT
                        ? isnan(g->v[k])
                        : fabs(g->v[k] - value_of(k, true) * 80e-9) <= last_digit * fabs(g->v[k]));
    rc_grid_free(g);
    drop(&m);
}

/* The metadata of a file become keys. */
static void
keys(void **state)
{
    static const struct {
        const char *format;
        void (*make)(struct bytes *m, int variant);
        int variant;
        size_t channel;
        const char *key, *value;
    } rows[] = {
        {"sdf", make_sdf_text, 0, 0, "file.creator", "maker"},
        {"sdf", make_sdf_binary, 5, 0, "file.date", "010203040506"},
        {"sur", make_sur, 0, 0, "file.channel", "name of it"},
        {"sur", make_sur, 0, 0, "file.comment", "comment"},
        {"opd", make_opd, 0, 0, "file.title", "a title"},
        {"plu", make_plu, 0, 0, "file.date", "Fri Mar 10 16:35:59 2023"},
        {"nanoscope", make_nanoscope, 0, 0, "file.channel", "Height Sensor"},
        {"nanoscope", make_nanoscope, 0, 0, "file.date", "02:03:59 PM Wed May 06 2015"},
        {"nid", make_nid, 0, 1, "file.date", "24-01-2008"},
        {"gwy", make_gwy, 0, 1, "file.channel", "The heights"},
        {"gsf", make_gsf, 3, 0, "file.channel", "Titl"},
        {"mi", make_mi, 0, 1, "file.version", "PicoView"},
        {"frt", make_frt, 0, 0, "file.comment", "hello"},
        {"wykotext", make_wykotext, 0, 0, "file.title", "a title"},
        {"zygo", make_zygo, 0, 0, "file.comment", "a comment"},
        {"keyence", make_keyence, 1, 0, "file.channel", "H\xc3\xb6he"},
        {"sxm", make_sxm, 0, 1, "file.channel", "Z"},
        {"sxm", make_sxm, 0, 2, "file.channel", "Z (backward)"},
        {"sxm", make_sxm, 0, 1, "file.date", "16.08.2016"},
        {"sxm", make_sxm, 0, 1, "file.comment", "of two lines"},
        {"opdx", make_opdx, 0, 0, "file.date", "2/11/2021"},
        {"vk", make_vk4, 0, 0, "file.date", "2020-02-29T13:14:15"},
        {"vk", make_vk6, 0, 0, "file.date", "2020-02-29T13:14:15"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct bytes m = {0};
        struct rc_err err = {""};
        const char *value;
        struct rc_grid *g;

        rows[k].make(&m, rows[k].variant);
        if ((g = read_made(rows[k].format, &m, rows[k].channel, &err)) == NULL)
            fail_msg("%s: %s", rows[k].format, err.text);
        value = rc_grid_get(g, rows[k].key);
        if (value == NULL || strcmp(value, rows[k].value) != 0)
            fail_msg("%s: %s is '%s'", rows[k].format, rows[k].key, value == NULL ? "" : value);
        rc_grid_free(g);
        drop(&m);
    }
}

/* ---- profiles as text ---- */

static const struct {
    const char *text;
    size_t n;
    double dx, first, last; /* NAN: missing */
    const char *why;        /* refused for */
} profiles[] = {
    {"x [um],z [nm]\n0,1\n0.5,2\n1.0,3\n", 3, 0.5e-6, 1e-9, 3e-9, NULL},
    {"Position (mm)\tHeight (\xb5m)\n0\t1\n0.5\t2\n1\tNaN\n", 3, 0.5e-3, 1e-6, NAN, NULL},
    {"a header\nof lines, no numbers\nindex;x in \xc2\xb5m;y in \xc2\xb5m\n0;1;4\n1;2;5\n2;3;6\n",
     3, 1e-6, 4e-6, 6e-6, NULL},
    {"x_um z_um valid\n0 1 1\n1 2 1\n2 3 0\n", 3, 1e-6, 1e-6, NAN, NULL},
    {"x_um z_um\n2 1\n1 2\n0 3\n", 3, 1e-6, 3e-6, 1e-6, NULL},
    /* rounded to the last decimal */
    {"x [um],z [um]\n0.0,1\n0.2,2\n0.3,3\n0.5,4\n0.6,5\n", 5, 0.15e-6, 1e-6, 5e-6, NULL},
    /* the positions of a stylus drift by a hundredth of a step, and by six hundredths */
    {"x [um] z [um]\n0 1\n1.009 2\n1.995 3\n3 4\n", 4, 1e-6, 1e-6, 4e-6, NULL},
    {"x [um] z [um]\n0 1\n1.00 2\n2.06 3\n3.00 4\n", 0, 0, 0, 0,
     "point 3 is at 2.06, but even steps of 1 lead to 2, 0.06 steps away; up to 0.05"},
    {"x [um] z [um]\n0 1\n1 2\n2 3\n4 4\n5 5\n", 0, 0, 0, 0,
     "point 3 is at 2, but even steps of 1.25 lead to 2.5, 0.4 steps away"},
    {"x [um] z [um]\n5 1\n4 2\n2 3\n1 4\n0 5\n", 0, 0, 0, 0,
     "point 3 is at 2, but even steps of 1.25 lead to 2.5"},
    {"x [s] z [um]\n0 1\n1 2\n2 3\n", 0, 0, 0, 0, "'s', which is not a length"},
    {"x [um] z [um]\n0 1\n2 2\n1 3\n", 0, 0, 0, 0, "change direction at row 3"},
    {"0 1\n1 2\n2 3\n", 0, 0, 0, 0, "its steps are 1"},
    {"0 1\n1 2\n2 3\n", 0, 0, 0, 0, "the unit of its heights is missing too: give --z-unit UNIT"},
    {"x [um] z\n0 1\n1 2\n2 3\n", 0, 0, 0, 0, "--z-unit"},
    {"x [um] z [um]\n0 1\n1 2\n", 0, 0, 0, 0, "3 points at least"},
    {"0 1 2\n1 2 3\n2 3 4\n", 0, 0, 0, 0, "without titles"},
    {"x [um] z [um]\n0 1\n1 2 3\n2 3\n", 0, 0, 0, 0, "line 3"},
    /* units in separate lines, in quotes, after the first line that spreadsheets write */
    {"# x-unit = um\n# z-unit = nm\n0 1\n0.5 2\n1.0 3\n", 3, 0.5e-6, 1e-9, 3e-9, NULL},
    {"# z-unit: [nm]\n# x-unit: um\n0 1\n0.5 2\n1.0 3\n", 3, 0.5e-6, 1e-9, 3e-9, NULL},
    {"X/mm Z/um\n0 1\n0.5 2\n1.0 3\n", 3, 0.5e-3, 1e-6, 3e-6, NULL},
    {"X[um] Z[nm]\n0 1\n0.5 2\n1.0 3\n", 3, 0.5e-6, 1e-9, 3e-9, NULL},
    {"x (um),z (nm)\n0 1\n0.5 2\n1.0 3\n", 3, 0.5e-6, 1e-9, 3e-9, NULL},
    {"sep=;\nx [um];z [nm]\n0;1,0\n0,5;2,0\n1,0;3,0\n", 3, 0.5e-6, 1e-9, 3e-9, NULL},
    {"sep=;\r\n\"x [um]\";\"z [nm]\"\r\n\"0\";\"1,0\"\r\n\"0,5\";\"2\"\r\n\"1\";\"3\"\r\n", 3,
     0.5e-6, 1e-9, 3e-9, NULL},
    {"\"X/mm\",\"Z/um\"\n\"0\",\"1\"\n\"0.5\",\"2\"\n\"1\",\"\"\n", 3, 0.5e-3, 1e-6, NAN, NULL},
    {"# x-unit = s\n0 1\n1 2\n2 3\n", 0, 0, 0, 0, "'s', which is not a length"},
    {"z [um]\n1\n2\n3\n", 0, 0, 0, 0, "--dx"},
    {"1\n2 2\n3\n", 0, 0, 0, 0, "line 3"},
    {"words and no more\n", 0, 0, 0, 0, "no table"},
};

/* UTF-16 in either byte order, after its mark. */
static void
widen(struct bytes *m, const char *from, bool big)
{
    add(m, big ? "\xfe\xff" : "\xff\xfe", 2);
    m->big = big;
    for (const unsigned char *s = (const unsigned char *)from; *s != '\0'; s++) {
        unsigned c = *s;
        if (c == 0xc2) /* the only two bytes above 127 are those of U+00B5 */
            c = *++s;
        add_raw(m, RC_RAW_U16, c);
    }
}

static void
check_profile(size_t row, const struct bytes *m)
{
    struct rc_err err = {""};
    struct rc_grid *g = read_made("profile", m, 0, &err);

    if (profiles[row].why != NULL) {
        if (g != NULL || strstr(err.text, profiles[row].why) == NULL)
            fail_msg("'%s': %s", profiles[row].text, g == NULL ? err.text : "read");
        return;
    }
    if (g == NULL)
        fail_msg("'%s': %s", profiles[row].text, err.text);
    assert_int_equal(g->nx, profiles[row].n);
    assert_int_equal(g->ny, 1);
    assert_true(fabs(g->dx - profiles[row].dx) <= last_digit * g->dx);
    assert_true(g->dy == g->dx);
    assert_true(fabs(g->v[0] - profiles[row].first) <= last_digit * fabs(g->v[0]));
    assert_true(isnan(profiles[row].last) ? isnan(g->v[g->nx - 1])
                                          : fabs(g->v[g->nx - 1] - profiles[row].last) <=
                                                last_digit * fabs(g->v[g->nx - 1]));
    rc_grid_free(g);
}

/* The file cut at any byte, in a block of memory of exactly its length. */
static void
cut_profile(size_t row, const struct bytes *m)
{
    for (size_t n = 0; n < m->n; n++) {
        struct bytes part = {0};
        struct rc_err err = {""};
        struct rc_grid *g;

        part.data = malloc(n == 0 ? 1 : n);
        memcpy(part.data, m->data, n);
        part.n = n;
        g = read_made("profile", &part, 0, &err);
        if (g == NULL ? err.text[0] == '\0' : !(g->dx > 0) || g->ny != 1 || g->nx > profiles[row].n)
            fail_msg("'%s' cut to %zu bytes", profiles[row].text, n);
        rc_grid_free(g);
        drop(&part);
    }
}

static void
text_profiles(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof profiles / sizeof *profiles; k++)
        for (int wide = 0; wide < 3; wide++) {
            struct bytes m = {0};

            if (wide == 0)
                add_text(&m, profiles[k].text);
            else
                widen(&m, profiles[k].text, wide == 2);
            check_profile(k, &m);
            if (profiles[k].why == NULL)
                cut_profile(k, &m);
            drop(&m);
        }
}

/* Heights without positions; the user gives the spacing. */
static void
one_column(void **state)
{
    static const char heights[] = "Height (nm)\n5\nNaN\n7\n8\n";
    struct rc_wish wish = {.dx = 2e-6, .dy = NAN, .z_unit = NAN};
    struct rc_file file = {"made.txt", (const unsigned char *)heights, strlen(heights)};
    struct rc_err err = {""};
    struct rc_grid *g = read_map(rc_format_named("profile"), &file, &wish, 0, NULL, &err);

    (void)state;
    if (g == NULL)
        fail_msg("%s", err.text);
    assert_int_equal(g->nx, 4);
    assert_int_equal(g->ny, 1);
    assert_true(g->dx == 2e-6 && g->dy == 2e-6);
    assert_true(fabs(g->v[0] - 5e-9) <= last_digit * 5e-9 && isnan(g->v[1]) &&
                fabs(g->v[3] - 8e-9) <= last_digit * 8e-9);
    rc_grid_free(g);
}

/* ---- refusals ---- */

static void
points(void **state)
{
    static const struct {
        const char *text, *why;
    } rows[] = {
        {"0 0 1\n1 0 2\n0 1 3\n1 1 4\n0 0 5\n", "point 5 has the same position as another one"},
        {"0 0 1\n1 0 2\n3.3 0 3\n0 1 4\n", "on no raster"},
        {"0 0 1\n1 2 2\n2 4 3\n3 1 4\n4 3 5\n5 5 6\n6 6 7\n7 8 2\n8 7 3\n9 9 4\n10 10 1\n",
         "11 of them have 11 different x"},
        {"0 nan 1\n1 0 2\n", "has no y"},
        {"0 0 1 2\n1 0 2 3\n", "has 3 columns, this table has 4"},
        {"0 0 1\n0 1 1\n", "the same x"},
        {"0 0 1\n1 1 1\n2 2 1\n3 3 1\n4 4 1\n5 5.1 1\n", "on no raster: 6 of them"},
        {"0 0 1\n1 1 1\n2 2 1\n3 3 1\n4 4 1\n6 6 1\n", "not evenly spaced: point 5 is at"},
        {"0 0 1\n1 1 1\n2 2 1\n3 3 1\n4 4 1\n4 4 2\n", "on no raster: 6 of them"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};
        struct bytes m = {0};
        struct rc_err err = {""};
        struct rc_file file;
        struct rc_grid *g;

        add_text(&m, rows[k].text);
        file = (struct rc_file){"made.xyz", m.data, m.n};
        g = read_map(rc_format_named("xyz"), &file, &wish, 0, NULL, &err);
        if (g != NULL || strstr(err.text, rows[k].why) == NULL)
            fail_msg("'%s': %s", rows[k].text, g == NULL ? err.text : "read");
        drop(&m);
    }
}

/* Units from the titles of columns, or from lines above them. */
static void
units_of_points(void **state)
{
    static const struct {
        const char *head;
        double dx, dy, z; /* NAN: nothing */
        char mark;
    } rows[] = {
        {"X/mm Y/mm Z/um", 2e-3, 3e-3, 1e-6, ' '},
        {"X[um] Y[um] Z[nm]", 2e-6, 3e-6, 1e-9, ' '},
        {"# x [um]\ty [nm]\tz [mm]", 2e-6, 3e-9, 1e-3, '\t'},
        {"x (um),y (um),z (nm)", 2e-6, 3e-6, 1e-9, ' '},
        {"sep=;\r\n\"X [um]\";\"Y [um]\";\"Z [nm]\"", 2e-6, 3e-6, 1e-9, ';'},
        {"# x-unit = um\n# z-unit = nm", 2e-6, 3e-6, 1e-9, ' '},
        {"WSxM file copyright Nanotec Electronica\nWSxM ASCII XYZ file\nX[A]  Y[A]  Z[nm]\n", 2e-10,
         3e-10, 1e-9, ' '},
        {"x [um];y;z", 2e-6, 3e-6, NAN, ';'},
        {"x [s];y [s];z [nm]", NAN, NAN, 1e-9, ';'},
        {"a scan in mm", NAN, NAN, NAN, ' '}, /* not titles: four words */
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[300], c = rows[k].mark;
        struct rc_channel channel;
        struct rc_file file;

        snprintf(text, sizeof text, "%s\n0%c0%c1\n2%c0%c2\n0%c3%c3\n2%c3%c4\n", rows[k].head, c, c,
                 c, c, c, c, c, c);
        file = (struct rc_file){"made.txt", (const unsigned char *)text, strlen(text)};
        assert_string_equal(rc_format_find(&file, NULL)->name, "xyz");
        assert_int_equal(list_maps(rc_format_named("xyz"), &file, &rc_no_wish, &channel, 1, NULL),
                         1);
        if (isnan(rows[k].dx) ? !isnan(channel.dx) || !isnan(channel.dy)
                              : !(fabs(channel.dx - rows[k].dx) <= last_digit * rows[k].dx) ||
                                    !(fabs(channel.dy - rows[k].dy) <= last_digit * rows[k].dy))
            fail_msg("'%s': %g, %g", text, channel.dx, channel.dy);
        assert_string_equal(channel.unit, isnan(rows[k].z) ? "" : "m");
        if (!isnan(rows[k].z) && !isnan(rows[k].dx)) {
            struct rc_grid *g = read_map(rc_format_named("xyz"), &file, &rc_no_wish, 0, NULL, NULL);

            assert_non_null(g);
            assert_true(fabs(g->v[3] - 4 * rows[k].z) <= last_digit * 4 * rows[k].z);
            rc_grid_free(g);
        }
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variants),
        cmocka_unit_test(other_channels),
        cmocka_unit_test(createc_scans),
        cmocka_unit_test(createc_counts),
        cmocka_unit_test(createc_headers),
        cmocka_unit_test(keys),
        cmocka_unit_test(text_profiles),
        cmocka_unit_test(one_column),
        cmocka_unit_test(points),
        cmocka_unit_test(units_of_points),
        cmocka_unit_test(labels_of_waves),
        cmocka_unit_test(labels_with_a_note),
        cmocka_unit_test(scale_of_a_logarithm),
        cmocka_unit_test(doubts),
        cmocka_unit_test(no_wavelength),
        cmocka_unit_test(profile_of_a_wave),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
