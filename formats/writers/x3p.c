/* SPDX-License-Identifier: GPL-3.0-or-later */
/* X3P, ISO 25178-72: see x3p.c. Heights go into bindata/data.bin, the list of valid points into
 * bindata/valid.bin if some are missing, and every part has an MD5 checksum. */
#include <stdlib.h>

#include "encode.h"
#include "formats/containers/containers.h"
#include "formats/core/core.h"
#include "formats/export.h"

enum {
    TYPES = RC_TYPE_I16 | RC_TYPE_I32 | RC_TYPE_F32 | RC_TYPE_F64
};

static const char data_name[] = "bindata/data.bin", valid_name[] = "bindata/valid.bin";

struct parts {
    struct rc_range range;
    struct rc_code code;
    unsigned char *data, *valid;
    size_t data_n, valid_n;
    char data_md5[RC_MD5_TEXT], valid_md5[RC_MD5_TEXT];
};

/* One bit per point, lowest first, 1 for a valid height. */
static enum rc_status
make_valid(struct parts *p, const struct rc_grid *g, struct rc_err *err)
{
    size_t n = g->nx * g->ny;

    p->valid_n = n / 8 + (n % 8 != 0);
    if ((p->valid = calloc(p->valid_n, 1)) == NULL)
        return rc_err_set(err, "out of memory for %zu valid points", n);
    for (size_t k = 0; k < n; k++)
        if (g->v[k] == g->v[k])
            p->valid[k / 8] |= (unsigned char)(1u << k % 8);
    rc_md5_of(p->valid, p->valid_n, p->valid_md5);
    return RC_OK; /* freed with the other parts: NOLINT(clang-analyzer-unix.Malloc) */
}

static enum rc_status
make_parts(struct parts *p, const struct rc_grid *g, const struct rc_export_wish *wish,
           struct rc_err *err)
{
    enum rc_raw raw = rc_export_raw(g, wish, TYPES);
    int32_t most = raw == RC_RAW_I16 ? INT16_MAX : INT32_MAX;

    if (rc_range_of(g, &p->range, err) != RC_OK)
        return RC_FAIL;
    p->code = rc_code_for(raw, &p->range, -most, most, 0);
    if (rc_size_mul(g->nx * g->ny, rc_raw_width(raw), &p->data_n, err) != RC_OK)
        return RC_FAIL;
    if ((p->data = malloc(p->data_n)) == NULL)
        return rc_err_set(err, "out of memory for %zu bytes of heights", p->data_n);
    if (rc_encode(&p->code, g->v, g->nx * g->ny, p->data, err) != RC_OK)
        return RC_FAIL;
    rc_md5_of(p->data, p->data_n, p->data_md5);
    return p->range.missing > 0 ? make_valid(p, g, err) : RC_OK;
}

/* ---- main.xml ---- */

static void
axis(struct rc_buffer *b, const char *name, const char *type, const char *data, double increment,
     double offset)
{
    rc_buffer_print(b,
                    "      "
                    "<%s><AxisType>%s</AxisType><DataType>%s</DataType><Increment>%s</"
                    "Increment><Offset>%s</Offset></%s>\n",
                    name, type, data, rc_number(increment), rc_number(offset), name);
}

/* The schema requires each of these elements, even if unknown. */
static void
word(struct rc_buffer *b, const char *element, const struct rc_grid *g, const char *key,
     const char *otherwise)
{
    const char *value = key == NULL ? NULL : rc_grid_get(g, key);

    rc_buffer_print(b, "<%s>", element);
    rc_buffer_escaped(b, value == NULL ? otherwise : value);
    rc_buffer_print(b, "</%s>", element);
}

static void
provenance(struct rc_buffer *b, const struct rc_grid *g, const struct rc_export_wish *wish)
{
    const char *comment = rc_grid_get(g, "file.comment"), *history = rc_grid_get(g, "history");
    char date[RC_DATE];

    rc_export_date(date, g, wish);
    rc_buffer_print(b, "  <Record2>\n    <Date>%s</Date>\n    ", date);
    word(b, "Creator", g, "file.creator", wish->creator);
    rc_buffer_print(b, "\n    <Instrument>");
    word(b, "Manufacturer", g, "file.manufacturer", "unknown");
    word(b, "Model", g, "file.model", "unknown");
    word(b, "Serial", g, "file.serial", "unknown");
    word(b, "Version", g, "file.version", "unknown");
    rc_buffer_print(b, "</Instrument>\n    ");
    word(b, "CalibrationDate", g, "file.calibrated", date);
    rc_buffer_print(b, "\n    <ProbingSystem>");
    word(b, "Type", g, "file.probe-type", "NonContacting");
    word(b, "Identification", g, "file.probe", "unknown");
    rc_buffer_print(b, "</ProbingSystem>\n");
    if (comment != NULL || history != NULL) {
        rc_buffer_print(b, "    <Comment>");
        rc_buffer_escaped(b, comment == NULL ? "" : comment);
        rc_buffer_print(b, comment == NULL || history == NULL ? "" : " | ");
        rc_buffer_escaped(b, history == NULL ? "" : history);
        rc_buffer_print(b, "</Comment>\n");
    }
    rc_buffer_print(b, "  </Record2>\n");
}

static void
make_main(struct rc_buffer *b, const struct rc_grid *g, const struct parts *p,
          const struct rc_export_wish *wish)
{
    static const char *const letter[] = {
        [RC_RAW_I16] = "I", [RC_RAW_I32] = "L", [RC_RAW_F32] = "F", [RC_RAW_F64] = "D"};

    rc_buffer_print(b, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\" "
                       "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
                       "xsi:schemaLocation=\"http://www.opengps.eu/2008/ISO5436_2 "
                       "http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd\">\n"
                       "  <Record1>\n    <Revision>ISO5436 - 2000</Revision>\n"
                       "    <FeatureType>SUR</FeatureType>\n    <Axes>\n");
    axis(b, "CX", "I", "D", g->dx, 0);
    axis(b, "CY", "I", "D", g->dy, 0);
    axis(b, "CZ", "A", letter[p->code.raw], p->code.increment, p->code.offset);
    rc_buffer_print(b, "    </Axes>\n  </Record1>\n");
    provenance(b, g, wish);
    rc_buffer_print(b,
                    "  <Record3>\n    "
                    "<MatrixDimension><SizeX>%zu</SizeX><SizeY>%zu</SizeY><SizeZ>1</SizeZ></"
                    "MatrixDimension>\n    "
                    "<DataLink><PointDataLink>%s</PointDataLink><MD5ChecksumPointData>%s</"
                    "MD5ChecksumPointData>",
                    g->nx, g->ny, data_name, p->data_md5);
    if (p->valid != NULL)
        rc_buffer_print(b,
                        "<ValidPointsLink>%s</ValidPointsLink><MD5ChecksumValidPoints>%s</"
                        "MD5ChecksumValidPoints>",
                        valid_name, p->valid_md5);
    rc_buffer_print(
        b, "</DataLink>\n  </Record3>\n  "
           "<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>\n</p:ISO5436_2>\n");
}

/* ---- the archive ---- */

/* Adds a buffer to the archive, which then owns it. */
static enum rc_status
add_buffer(struct rc_zip_write *archive, const char *name, struct rc_buffer *b, struct rc_err *err)
{
    void *bytes = b->bytes;

    if (b->failed)
        return rc_err_set(err, "out of memory for the member '%s'", name);
    b->bytes = NULL;
    return rc_zip_write_add(archive, name, bytes, b->n, err);
}

static enum rc_status
add_bytes(struct rc_zip_write *archive, const char *name, unsigned char **bytes, size_t n,
          struct rc_err *err)
{
    void *given = *bytes;

    *bytes = NULL;
    return given == NULL ? RC_OK : rc_zip_write_add(archive, name, given, n, err);
}

static void
parts_free(struct parts *p)
{
    free(p->data);
    free(p->valid);
}

static enum rc_status
x3p_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    RC_ENDS(rc_buffer_free) struct rc_buffer xml = {0};
    RC_ENDS(rc_buffer_free) struct rc_buffer md5_file = {0};
    RC_OWN(rc_zip_write, archive) = NULL;
    RC_ENDS(parts_free) struct parts p = {0};
    char md5[RC_MD5_TEXT] = "";

    (void)frames;
    if (make_parts(&p, frame[0], wish, err) != RC_OK ||
        (archive = rc_zip_write_new(wish->time, err)) == NULL)
        return RC_FAIL;
    make_main(&xml, frame[0], &p, wish);
    if (!xml.failed)
        rc_md5_of(xml.bytes, xml.n, md5);
    rc_buffer_print(&md5_file, "%s *main.xml\n", md5);
    if (add_buffer(archive, "main.xml", &xml, err) != RC_OK ||
        add_bytes(archive, data_name, &p.data, p.data_n, err) != RC_OK ||
        add_bytes(archive, valid_name, &p.valid, p.valid_n, err) != RC_OK ||
        add_buffer(archive, "md5checksum.hex", &md5_file, err) != RC_OK)
        return RC_FAIL;
    return rc_zip_write_finish(archive, out, err);
}

const struct rc_export rc_export_x3p = {
    .name = "x3p",
    .suffixes = ".x3p",
    .summary = "ISO 25178-72, all four data types",
    .heights = true,
    .types = TYPES,
    .lengths = true,
    .write = x3p_write,
};
