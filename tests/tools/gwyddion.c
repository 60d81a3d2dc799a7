/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Opens FILE with Gwyddion's libraries and compares its first channel with the array of an NPY file: gwyddion
 * FILE NPY DX DY PART. Heights may differ by PART of the largest. Built by pipe_gwyddion.sh. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <app/gwyapp.h>
#include <gtk/gtk.h>
#include <libgwydgets/gwydgets.h>
#include <libgwymodule/gwymodule-file.h>
#include <libgwymodule/gwymodule.h>
#include <libprocess/gwyprocess.h>

static void
fail(const char *what, const char *why)
{
    fprintf(stderr, "%s: %s\n", what, why);
    exit(1);
}

/* The values of an array of little-endian doubles. */
static double *
read_npy(const char *name, size_t *rows, size_t *columns)
{
    unsigned char head[65536 + 10];
    FILE *f = fopen(name, "rb");
    const char *shape;
    size_t n;
    double *v;

    if (f == NULL || fread(head, 1, 10, f) != 10 || memcmp(head, "\x93NUMPY\x01", 7) != 0)
        fail(name, "no NPY file");
    n = head[8] | (size_t)head[9] << 8;
    if (fread(head, 1, n, f) != n)
        fail(name, "cut off");
    head[n] = '\0';
    shape = strstr((char *)head, "'shape': (");
    if (strstr((char *)head, "'<f8'") == NULL || shape == NULL ||
        sscanf(shape, "'shape': (%zu, %zu", rows, columns) != 2)
        fail(name, "no matrix of doubles");
    v = malloc(*rows * *columns * sizeof *v);
    if (v == NULL || fread(v, sizeof *v, *rows * *columns, f) != *rows * *columns)
        fail(name, "cut off");
    fclose(f);
    return v;
}

static GwyContainer *
open_file(const char *name, const char **module)
{
    GError *error = NULL;
    GwyContainer *data;

    gwy_app_init_common(&error, "file", "layer", NULL);
    if (error != NULL)
        fail("Gwyddion", error->message);
    *module = gwy_file_detect(name, FALSE, GWY_FILE_OPERATION_LOAD);
    if (*module == NULL)
        fail(name, "Gwyddion does not know what it is");
    data = gwy_file_func_run_load(*module, name, GWY_RUN_NONINTERACTIVE, &error);
    if (data == NULL)
        fail(name, error == NULL ? "Gwyddion does not read it" : error->message);
    return data;
}

static int
is_metre(GwySIUnit *unit)
{
    gchar *text = gwy_si_unit_get_string(unit, GWY_SI_UNIT_FORMAT_PLAIN);
    int good = strcmp(text, "m") == 0 || *text == '\0'; /* lists of points have no unit */

    g_free(text);
    return good;
}

int
main(int argc, char **argv)
{
    GwyDataField *field = NULL, *mask = NULL;
    size_t rows, columns, wrong = 0, missing = 0;
    double *v, dx, dy, part, most = 0, worst = 0;
    const char *module;
    const double *got, *masked;
    GwyContainer *data;

    if (argc != 6)
        fail("gwyddion", "FILE NPY DX DY PART are expected");
    setenv("LC_ALL", "C", 1);
    gtk_init(&argc, &argv);
    v = read_npy(argv[2], &rows, &columns);
    dx = strtod(argv[3], NULL);
    dy = strtod(argv[4], NULL);
    part = strtod(argv[5], NULL);
    data = open_file(argv[1], &module);
    if (!gwy_container_gis_object_by_name(data, "/0/data", &field))
        fail(argv[1], "Gwyddion finds no channel");
    gwy_container_gis_object_by_name(data, "/0/mask", &mask);
    if ((size_t)gwy_data_field_get_xres(field) != columns ||
        (size_t)gwy_data_field_get_yres(field) != rows)
        fail(argv[1], "of another size");
    if (fabs(gwy_data_field_get_xreal(field) / (dx * (double)columns) - 1) > 1e-7 ||
        fabs(gwy_data_field_get_yreal(field) / (dy * (double)rows) - 1) > 1e-7)
        fail(argv[1], "of other spacings");
    if (!is_metre(gwy_data_field_get_si_unit_xy(field)) ||
        !is_metre(gwy_data_field_get_si_unit_z(field)))
        fail(argv[1], "in other units than metres");
    got = gwy_data_field_get_data_const(field);
    masked = mask == NULL ? NULL : gwy_data_field_get_data_const(mask);
    for (size_t k = 0; k < rows * columns; k++) {
        int none = isnan(got[k]) || (masked != NULL && masked[k] != 0);
        missing += none;
        wrong += none != isnan(v[k]);
        if (!none && !isnan(v[k]))
            worst = fmax(worst, fabs(got[k] - v[k]));
        if (!isnan(v[k]))
            most = fmax(most, fabs(v[k]));
    }
    printf("by %s: %zu x %zu, %zu missing, largest difference %.3g of %.3g m\n", module, columns,
           rows, missing, worst, most);
    if (wrong > 0)
        fail(argv[1], "other points are missing");
    if (!(worst <= part * most))
        fail(argv[1], "the heights differ");
    return 0;
}
