/* SPDX-License-Identifier: GPL-3.0-or-later */
/* X3P: main.xml, read and judged. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "x3p_internal.h"

#define MAIN_MOST ((uint64_t)1 << 28) /* bytes of main.xml: some millions of heights in it */

static const struct {
    const char *path; /* below the root */
    const char *key;
} fields[RC_X3P_FIELDS] = {
    [RC_X3P_FEATURE] = {"Record1/FeatureType", NULL},
    [RC_X3P_CX_AXIS] = {"Record1/Axes/CX/AxisType", NULL},
    [RC_X3P_CX_TYPE] = {"Record1/Axes/CX/DataType", NULL},
    [RC_X3P_CX_INCREMENT] = {"Record1/Axes/CX/Increment", NULL},
    [RC_X3P_CX_OFFSET] = {"Record1/Axes/CX/Offset", NULL},
    [RC_X3P_CY_AXIS] = {"Record1/Axes/CY/AxisType", NULL},
    [RC_X3P_CY_TYPE] = {"Record1/Axes/CY/DataType", NULL},
    [RC_X3P_CY_INCREMENT] = {"Record1/Axes/CY/Increment", NULL},
    [RC_X3P_CZ_TYPE] = {"Record1/Axes/CZ/DataType", NULL},
    [RC_X3P_CZ_INCREMENT] = {"Record1/Axes/CZ/Increment", NULL},
    [RC_X3P_CZ_OFFSET] = {"Record1/Axes/CZ/Offset", NULL},
    [RC_X3P_SIZE_X] = {"Record3/MatrixDimension/SizeX", NULL},
    [RC_X3P_SIZE_Y] = {"Record3/MatrixDimension/SizeY", NULL},
    [RC_X3P_SIZE_Z] = {"Record3/MatrixDimension/SizeZ", NULL},
    [RC_X3P_LIST] = {"Record3/ListDimension", NULL},
    [RC_X3P_POINTS] = {"Record3/DataLink/PointDataLink", NULL},
    [RC_X3P_POINTS_MD5] = {"Record3/DataLink/MD5ChecksumPointData", NULL},
    [RC_X3P_VALID] = {"Record3/DataLink/ValidPointsLink", NULL},
    [RC_X3P_VALID_MD5] = {"Record3/DataLink/MD5ChecksumValidPoints", NULL},
    [RC_X3P_MD5_FILE] = {"Record4/ChecksumFile", NULL},
    [RC_X3P_FIRST_KEY] = {"Record2/Date", "file.date"},
    {"Record2/Creator", "file.creator"},
    {"Record2/Instrument/Manufacturer", "file.manufacturer"},
    {"Record2/Instrument/Model", "file.model"},
    {"Record2/Instrument/Serial", "file.serial"},
    {"Record2/Instrument/Version", "file.version"},
    {"Record2/CalibrationDate", "file.calibrated"},
    {"Record2/ProbingSystem/Type", "file.probe-type"},
    {"Record2/ProbingSystem/Identification", "file.probe"},
    {"Record2/Comment", "file.comment"},
    {"Record1/Revision", "file.revision"},
};

static const char root_name[] = "ISO5436_2";
static const char old_name[] = "ISO5436"; /* from writers that omitted a part of the standard */

const char *
rc_x3p_key(size_t field)
{
    return fields[field].key;
}

/* ---- main.xml ---- */

static enum rc_status
whole(const char *name, const char *text, size_t *value, struct rc_err *err)
{
    if (text == NULL || *text == '\0')
        return rc_err_set(err, "main.xml gives no %s", name);
    return rc_xml_whole("main.xml", name, text, value, err);
}

/* A finite number; `otherwise` where main.xml gives none. */
static enum rc_status
real(const char *name, const char *text, double otherwise, double *value, struct rc_err *err)
{
    *value = otherwise;
    if (text == NULL || *text == '\0')
        return RC_OK;
    if (rc_xml_number("main.xml", name, text, value, err) != RC_OK)
        return RC_FAIL;
    if (!isfinite(*value))
        return rc_err_set(err, "%s is '%s' in main.xml: it must be finite", name,
                          rc_word_shown(text));
    return RC_OK;
}

/* Makes memory in the list for n numbers, which never exceeds the bytes of the source. */
static enum rc_status
grow(struct rc_x3p_list *list, size_t n, struct rc_err *err)
{
    size_t capacity = list->capacity == 0 ? 1024 : 2 * list->capacity;
    double *more;

    if (n <= list->capacity)
        return RC_OK;
    if ((more = realloc(list->value, capacity * sizeof *more)) == NULL)
        return rc_err_set(err, "out of memory for %zu heights", capacity);
    list->value = more;
    list->capacity = capacity;
    return RC_OK;
}

static bool
is(const char *text, const char *word)
{
    return text != NULL && strcmp(text, word) == 0;
}

/* A profile with a position for each point; the axes precede the data. */
static bool
is_absolute(char *const *text)
{
    return is(text[RC_X3P_FEATURE], "PRF") && is(text[RC_X3P_CX_AXIS], "A");
}

static enum rc_status
judge_axis(const char *name, const char *type, struct rc_err *err)
{
    if (type != NULL && strcmp(type, "I") == 0)
        return RC_OK;
    return rc_err_set(err,
                      "axis %s is of type '%s': only incremental axes (I), a regular grid, are "
                      "read where main.xml lists the heights",
                      name, type == NULL ? "" : rc_word_shown(type));
}

/* Checks the kind of the data first. */
static enum rc_status
judge_feature(struct rc_x3p *x, struct rc_err *err)
{
    const char *feature = x->text[RC_X3P_FEATURE] == NULL ? "" : x->text[RC_X3P_FEATURE];

    x->profile = strcmp(feature, "PRF") == 0;
    if (strcmp(feature, "PCL") == 0)
        return rc_err_set(err, "FeatureType PCL is a cloud of points: only maps (SUR) and profiles "
                               "(PRF) on a regular grid are read");
    if (!x->profile && strcmp(feature, "SUR") != 0)
        return rc_err_set(err, "FeatureType is '%s': it must be SUR or PRF",
                          rc_word_shown(feature));
    x->at.absolute = is_absolute(x->text);
    x->binary = x->text[RC_X3P_POINTS] != NULL && *x->text[RC_X3P_POINTS] != '\0';
    if (!x->profile && x->binary) {
        x->at.absolute_x = is(x->text[RC_X3P_CX_AXIS], "A");
        x->at.absolute_y = is(x->text[RC_X3P_CY_AXIS], "A");
    }
    if (!x->at.absolute && !x->at.absolute_x &&
        judge_axis("CX", x->text[RC_X3P_CX_AXIS], err) != RC_OK)
        return RC_FAIL;
    return x->profile || x->at.absolute_y ? RC_OK : judge_axis("CY", x->text[RC_X3P_CY_AXIS], err);
}

/* "x;z", or "x;y;z" where y is absolute too; z may be missing, x may not. */
static enum rc_status
take_point(struct rc_x3p *x, const char *text, struct rc_err *err)
{
    size_t n = is(x->text[RC_X3P_CY_AXIS], "A") ? 3 : 2, k = 0;
    double value[3] = {NAN, NAN, NAN};
    const char *end = text;

    while (k < n && end != NULL) {
        if (*end != ';' && *end != '\0')
            end = rc_number_read(end, true, &value[k]);
        k++;
        if (end == NULL || *end != ';')
            break;
        end++;
    }
    if (end == NULL || *end != '\0' || k != n || !isfinite(value[0]))
        return rc_err_set(err, "Datum %zu is '%s': %s are expected", x->list.n + 1,
                          rc_word_shown(text), n == 3 ? "x;y;z" : "x;z");
    if (grow(&x->list, 2 * x->list.n + 2, err) != RC_OK)
        return RC_FAIL;
    x->list.value[2 * x->list.n] = value[0];
    x->list.value[2 * x->list.n + 1] = value[n - 1];
    x->list.n++;
    return RC_OK;
}

static enum rc_status
take_datum(struct rc_x3p *x, const char *text, struct rc_err *err)
{
    double value = NAN; /* an empty one is a missing point */
    const char *end = *text == '\0' ? text : rc_number_read(text, true, &value);

    if (x->list.n == 0 && x->text[RC_X3P_FEATURE] != NULL && judge_feature(x, err) != RC_OK)
        return RC_FAIL; /* a clearer reason than that of a number */
    if (is_absolute(x->text))
        return take_point(x, text, err);
    if (end != NULL && *end == ';')
        return rc_err_set(
            err, "Datum %zu is '%s': lists with coordinates are not read, only matrices of heights",
            x->list.n + 1, rc_word_shown(text));
    if (end == NULL || *end != '\0')
        return rc_err_set(err, "Datum %zu is '%s': that is not a number", x->list.n + 1,
                          rc_word_shown(text));
    if (grow(&x->list, x->list.n + 1, err) != RC_OK)
        return RC_FAIL;
    x->list.value[x->list.n++] = value;
    return RC_OK;
}

/* Elements r11 to r33 of the rotation matrix. */
static enum rc_status
take_rotation(bool *turned, const char *name, const char *text, struct rc_err *err)
{
    double value;

    if (real("the rotation matrix", text, name[0] == name[1], &value, err) != RC_OK)
        return RC_FAIL;
    *turned = *turned || fabs(value - (name[0] == name[1])) > 1e-9;
    return RC_OK;
}

static enum rc_status
take_element(void *arg, const char *path, const char *text, struct rc_err *err)
{
    static const char rotation[] = "Record1/Axes/Rotation/r";
    struct rc_x3p *x = arg;
    size_t root = strcspn(path, "/");

    x->old_root = root == strlen(old_name) && strncmp(path, old_name, root) == 0;
    if (!x->old_root && (root != strlen(root_name) || strncmp(path, root_name, root) != 0)) {
        if (path[root] == '\0')
            return rc_err_set(err,
                              "a ZIP archive, but no X3P: the root of its main.xml is '%s', not %s",
                              rc_word_shown(path), root_name);
        return RC_OK;
    }
    if (path[root] == '\0')
        return RC_OK;
    x->is_x3p = true;
    path += root + 1;
    if (strcmp(path, "Record3/DataList/Datum") == 0)
        return take_datum(x, text, err);
    if (strncmp(path, rotation, strlen(rotation)) == 0 && strlen(path) == strlen(rotation) + 2)
        return take_rotation(&x->turned, path + strlen(rotation), text, err);
    for (size_t f = 0; f < RC_X3P_FIELDS; f++) {
        if (strcmp(path, fields[f].path) != 0)
            continue;
        if (x->text[f] != NULL && fields[f].key == NULL)
            return rc_err_set(err, "main.xml has %s twice", fields[f].path);
        return rc_text_set(&x->text[f], text, err);
    }
    return RC_OK;
}

static enum rc_status
read_main(struct rc_x3p *x, struct rc_err *err)
{
    if (rc_zip_read_xml(x->archive, x->main, MAIN_MOST, "main.xml", false, take_element, x, x->md5,
                        err) != RC_OK)
        return RC_FAIL;
    if (!x->is_x3p)
        return rc_err_set(err, "a ZIP archive, but no X3P: its main.xml has no %s", root_name);
    return RC_OK;
}

/* ---- what main.xml says ---- */

static enum rc_status
judge_sizes(struct rc_x3p *x, struct rc_err *err)
{
    size_t nz = 1, bytes;

    if (x->profile && x->text[RC_X3P_LIST] != NULL && x->text[RC_X3P_SIZE_X] == NULL) {
        x->ny = 1;
        if (whole("ListDimension", x->text[RC_X3P_LIST], &x->nx, err) != RC_OK)
            return RC_FAIL;
    } else if (whole("SizeX", x->text[RC_X3P_SIZE_X], &x->nx, err) != RC_OK ||
               whole("SizeY", x->text[RC_X3P_SIZE_Y], &x->ny, err) != RC_OK ||
               whole("SizeZ", x->text[RC_X3P_SIZE_Z], &nz, err) != RC_OK)
        return RC_FAIL;
    if (nz != 1)
        return rc_err_set(err, "SizeZ is %zu: only maps of one layer are read", nz);
    if (x->nx == 0 || x->ny == 0)
        return rc_err_set(err, "a matrix of %zu x %zu points is empty", x->nx, x->ny);
    if (x->profile && x->ny != 1)
        return rc_err_set(err, "a profile (PRF) of %zu rows: SizeY must be 1", x->ny);
    if (rc_size_mul(x->nx, x->ny, &x->n, err) != RC_OK)
        return RC_FAIL;
    return rc_size_mul(x->n, sizeof(double), &bytes, err);
}

static enum rc_status
judge_scales(struct rc_x3p *x, struct rc_err *err)
{
    if (real("the increment of CX", x->text[RC_X3P_CX_INCREMENT], NAN, &x->dx, err) != RC_OK ||
        real("the increment of CY", x->text[RC_X3P_CY_INCREMENT], NAN, &x->dy, err) != RC_OK ||
        real("the increment of CZ", x->text[RC_X3P_CZ_INCREMENT], 1, &x->increment, err) != RC_OK ||
        real("the offset of CZ", x->text[RC_X3P_CZ_OFFSET], 0, &x->offset, err) != RC_OK ||
        real("the increment of CX", x->text[RC_X3P_CX_INCREMENT], 1, &x->at.x_increment, err) !=
            RC_OK ||
        real("the offset of CX", x->text[RC_X3P_CX_OFFSET], 0, &x->at.x_offset, err) != RC_OK ||
        real("the increment of CY", x->text[RC_X3P_CY_INCREMENT], 1, &x->at.y_increment, err) !=
            RC_OK)
        return RC_FAIL;
    if (x->increment == 0)
        return rc_err_set(err, "the increment of CZ is 0 in main.xml: all heights would be one");
    if (x->profile)
        x->dy = x->dx;
    return RC_OK;
}

static enum rc_status
judge_type(const char *axis, const char *type, enum rc_raw *raw, struct rc_err *err)
{
    static const struct {
        const char *letter;
        enum rc_raw raw;
    } types[] = {{"I", RC_RAW_I16}, {"L", RC_RAW_I32}, {"F", RC_RAW_F32}, {"D", RC_RAW_F64}};

    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        if (is(type, types[k].letter)) {
            *raw = types[k].raw;
            return RC_OK;
        }
    return rc_err_set(err, "DataType of %s is '%s': it must be I, L, F or D", axis,
                      type == NULL ? "" : rc_word_shown(type));
}

static enum rc_status
judge_types(struct rc_x3p *x, struct rc_err *err)
{
    if (judge_type("CZ", x->text[RC_X3P_CZ_TYPE], &x->raw, err) != RC_OK)
        return RC_FAIL;
    if (x->at.absolute || x->at.absolute_x) {
        if (judge_type("CX", x->text[RC_X3P_CX_TYPE], &x->at.raw_x, err) != RC_OK)
            return RC_FAIL;
        x->at.before_y = x->at.before_z = rc_raw_width(x->at.raw_x);
    }
    if (!x->at.absolute_y && !(x->at.absolute && is(x->text[RC_X3P_CY_AXIS], "A")))
        return RC_OK;
    if (judge_type("CY", x->text[RC_X3P_CY_TYPE], &x->at.raw_y, err) != RC_OK)
        return RC_FAIL;
    x->at.before_z += rc_raw_width(x->at.raw_y);
    return RC_OK;
}

static enum rc_status
judge(struct rc_x3p *x, struct rc_err *err)
{
    if (judge_feature(x, err) != RC_OK || judge_sizes(x, err) != RC_OK ||
        judge_scales(x, err) != RC_OK || judge_types(x, err) != RC_OK)
        return RC_FAIL;
    if (!x->binary && x->list.n != x->n)
        return rc_err_set(err, "the header promises %zu x %zu heights, main.xml lists %zu", x->nx,
                          x->ny, x->list.n);
    return RC_OK;
}

enum rc_status
rc_x3p_head(struct rc_x3p *x, struct rc_err *err)
{
    return read_main(x, err) == RC_OK ? judge(x, err) : RC_FAIL;
}
