/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Park files made by this test are read in both byte orders; damaged ones are refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "made/made.h"

extern const struct rc_format rc_format_park;

struct park {
    unsigned version, kind, type;
    size_t nx, ny;
    double width, height, gain, scale, offset;
    const char *unit;
};

static const struct park park = {2, 0, 2, 3, 2, 6, 5, -12.5, 0.5, 0.25, "nm"};

static void
wide(struct bytes *b, const char *text, size_t n)
{
    for (size_t k = 0; k < n; k++)
        add_number(b, k < strlen(text) ? (unsigned char)text[k] : 0, 2);
}

static void
fill(struct bytes *b, size_t until)
{
    while (b->n < until)
        add(b, "", 1);
}

static struct bytes
park_header(const struct park *p)
{
    struct bytes h = {0};

    add_number(&h, p->kind, 4);
    wide(&h, "Z Height", 32);
    wide(&h, "Tapping", 8);
    fill(&h, 100);
    add_number(&h, p->nx, 4);
    add_number(&h, p->ny, 4);
    fill(&h, 140);
    add_f64(&h, p->width);
    add_f64(&h, p->height);
    fill(&h, 220);
    add_f64(&h, p->gain);
    add_f64(&h, p->scale);
    add_f64(&h, p->offset);
    wide(&h, p->unit, 8);
    fill(&h, 284);
    if (p->version == 2) {
        fill(&h, 348);
        add_number(&h, p->type, 4);
        fill(&h, 580);
    }
    return h;
}

static struct bytes
park_file(const struct park *p, bool big, size_t less)
{
    struct bytes b, data = {0}, header = park_header(p);
    struct tag tags[] = {number_tag(50432, 4, 0x0e031301),
                         number_tag(50433, 4, 0x1000000 + p->version),
                         {50434, 7, 0, NULL, 0},
                         {50435, 7, (uint32_t)header.n, NULL, 0},
                         {0}};

    for (size_t k = 0; k < 6; k++)
        if (p->version == 2 && p->type == 2)
            add_f32(&data, raw_counts[k]);
        else
            add_number(&data, (uint64_t)(int64_t)(raw_counts[k] % 100000),
                       p->version == 2 && p->type == 1 ? 4 : 2);
    tags[2].text = (const char *)data.data;
    tags[2].count = (uint32_t)(data.n - less);
    tags[3].text = (const char *)header.data;
    tiff_start(&b, big);
    tiff_page(&b, 4, 2, 1, 8, 1, NULL, "\1\2", 2, tags);
    drop(&data);
    drop(&header);
    return b;
}

static void
park_is_read(void **state)
{
    (void)state;
    for (unsigned type = 0; type < 4; type++)
        for (int big = 0; big < 2; big++) {
            struct park p = park;
            struct rc_file file;
            struct rc_grid *g;
            struct bytes b;
            double v[6];

            p.version = type == 3 ? 1 : 2; /* the first version has int16 only */
            p.type = type % 3;
            b = park_file(&p, big, 0);
            file = file_of(&b, "made");
            assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_park);
            for (size_t k = 0; k < 6; k++) { /* the bottom row comes first */
                int value = raw_counts[(k + 3) % 6];
                v[k] = -12.5 * (0.5 * (p.type == 2 ? value : value % 100000) + 0.25) * 1e-9;
            }
            g = read_well(&rc_format_park, &b, 0);
            check_map(g, 3, 2, 2e-6, 2.5e-6, v);
            assert_string_equal(rc_grid_get(g, "file.channel"), "Z Height");
            rc_grid_free(g);
            drop(&b);
        }
}

static void
park_defaults(void **state)
{
    struct park p = park;
    struct bytes b;
    struct rc_grid *g;
    double v[6];

    (void)state;
    p.unit = "";
    p.scale = 0;
    b = park_file(&p, false, 0);
    for (size_t k = 0; k < 6; k++)
        v[k] = -12.5 * (raw_counts[(k + 3) % 6] + 0.25) * 1e-6;
    g = read_well(&rc_format_park, &b, 0);
    check_map(g, 3, 2, 2e-6, 2.5e-6, v);
    rc_grid_free(g);
    drop(&b);
}

static void
refuse_park(const struct park *p, size_t less, const char *why)
{
    struct bytes b = park_file(p, false, less);

    refuse(&rc_format_park, &b, why);
    drop(&b);
}

/* In millivolts the values are a thousandth of those in metres. */
static void
other_units_stay(void **state)
{
    struct park p = park, m = park;
    struct bytes volts, metres;
    struct rc_grid *g, *of;

    (void)state;
    p.unit = "mV";
    m.unit = "mm";
    volts = park_file(&p, false, 0);
    metres = park_file(&m, false, 0);
    g = read_well(&rc_format_park, &volts, 0);
    of = read_well(&rc_format_park, &metres, 0);
    assert_string_equal(g->unit, "V");
    assert_string_equal(g->channel, rc_grid_get(g, "file.channel"));
    for (size_t k = 0; k < g->nx * g->ny; k++)
        assert_true(fabs(g->v[k] - of->v[k]) <= last_digit * fabs(of->v[k]));
    rc_grid_free(g);
    rc_grid_free(of);
    drop(&volts);
    drop(&metres);
}

static void
park_is_refused(void **state)
{
    struct park p = park;
    struct bytes b;

    (void)state;
    refuse_park(&p, 4, "promises 24 bytes of data, the file has 20");
    p.kind = 1;
    refuse_park(&p, 0, "line profile");
    p = park, p.type = 7;
    refuse_park(&p, 0, "data type 7");
    p = park, p.version = 3;
    refuse_park(&p, 0, "version 0x01000003");
    p = park, p.nx = 0;
    refuse_park(&p, 0, "empty");
    p = park, p.nx = 0xffffffff, p.ny = 0xffffffff;
    refuse_park(&p, 0, "more than this machine can address");
    p = park, p.width = 0;
    refuse_park(&p, 0, "must be positive");
    p = park, p.height = -1;
    refuse_park(&p, 0, "must be positive");
    p = park, p.width = NAN;
    refuse_park(&p, 0, "does not give the spacing");
    p = park, p.width = INFINITY;
    refuse_park(&p, 0, "must be positive and finite");
    p = park, p.gain = INFINITY;
    refuse_park(&p, 0, "must be finite");
    b = park_file(&park, true, 0);
    refuse_cuts(&rc_format_park, &b, b.n - 4, 1);
    survive_changes(&rc_format_park, &b, 150);
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(park_is_read),
        cmocka_unit_test(park_defaults),
        cmocka_unit_test(other_units_stay),
        cmocka_unit_test(park_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
