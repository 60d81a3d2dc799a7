/*
 * X3P, ISO 25178-72 (earlier ISO 5436-2): a ZIP archive that holds
 *
 *     main.xml           what was measured and how, and the heights themselves when they are few
 *     bindata/data.bin   else the heights: little-endian, row 0 first, x fastest
 *     bindata/valid.bin  one bit a point, lowest bit first, 1 where the height is valid
 *     md5checksum.hex    MD5 sum of main.xml
 *
 * A height is number * increment + offset of the axis CZ, in metres. Damage that reaches a height
 * (a wrong sum of data.bin or valid.bin) refuses the file; a wrong sum of main.xml is noted only,
 * because programs that edit the header are known to leave the old sum behind.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "archive.h"
#include "bytes.h"
#include "format.h"
#include "text.h"
#include "values.h"
#include "xml.h"

#define MAIN_MOST ((uint64_t)1 << 28) /* bytes of main.xml: some millions of heights in it */

enum {
    SUM_MOST = 4096,  /* bytes of md5checksum.hex                              */
    MASK_PADDING = 7, /* bytes that a writer may round the valid points up by  */
    NAME_MOST = 1024  /* bytes of a member's name                              */
};

enum field {
    FEATURE,
    CX_AXIS,
    CX_INCREMENT,
    CY_AXIS,
    CY_INCREMENT,
    CZ_TYPE,
    CZ_INCREMENT,
    CZ_OFFSET,
    SIZE_X,
    SIZE_Y,
    SIZE_Z,
    POINTS,
    POINTS_SUM,
    VALID,
    VALID_SUM,
    SUM_FILE,
    FIRST_KEY, /* from here on: kept as keys */
    FIELDS = FIRST_KEY + 11
};

static const struct {
    const char *path; /* below the root */
    const char *key;
} fields[FIELDS] = {
    [FEATURE] = {"Record1/FeatureType", NULL},
    [CX_AXIS] = {"Record1/Axes/CX/AxisType", NULL},
    [CX_INCREMENT] = {"Record1/Axes/CX/Increment", NULL},
    [CY_AXIS] = {"Record1/Axes/CY/AxisType", NULL},
    [CY_INCREMENT] = {"Record1/Axes/CY/Increment", NULL},
    [CZ_TYPE] = {"Record1/Axes/CZ/DataType", NULL},
    [CZ_INCREMENT] = {"Record1/Axes/CZ/Increment", NULL},
    [CZ_OFFSET] = {"Record1/Axes/CZ/Offset", NULL},
    [SIZE_X] = {"Record3/MatrixDimension/SizeX", NULL},
    [SIZE_Y] = {"Record3/MatrixDimension/SizeY", NULL},
    [SIZE_Z] = {"Record3/MatrixDimension/SizeZ", NULL},
    [POINTS] = {"Record3/DataLink/PointDataLink", NULL},
    [POINTS_SUM] = {"Record3/DataLink/MD5ChecksumPointData", NULL},
    [VALID] = {"Record3/DataLink/ValidPointsLink", NULL},
    [VALID_SUM] = {"Record3/DataLink/MD5ChecksumValidPoints", NULL},
    [SUM_FILE] = {"Record4/ChecksumFile", NULL},
    [FIRST_KEY] = {"Record2/Date", "file.date"},
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

struct x3p {
    struct rc_archive *archive;
    size_t main;            /* member                                                       */
    char prefix[NAME_MOST]; /* the folder that main.xml lies in, with its slash, or ""      */
    char sum[RC_MD5_TEXT];  /* of main.xml                                                  */
    char *text[FIELDS];     /* NULL: not in the file                                        */
    bool is_x3p, turned;    /* turned: a rotation that is not the identity                  */
    bool profile;
    bool binary;            /* the heights are in a member of their own                     */
    enum rc_raw raw;
    size_t nx, ny, n;       /* n = nx*ny                                                    */
    double dx, dy;          /* m, NAN when not given                                        */
    double increment, offset;
    bool wants_list;        /* the heights in main.xml are to be kept                       */
    double *list;           /* as far as they were in main.xml                              */
    size_t listed, room;
};

static const char *
shown(char to[RC_SHOWN], const char *text)
{
    return rc_text_shown(to, text, strlen(text));
}

/* ---- main.xml ---- */

static enum rc_status
whole(const char *name, const char *text, size_t *value, struct rc_err *err)
{
    char quote[RC_SHOWN];

    *value = 0;
    if (text == NULL || *text == '\0')
        return rc_err_set(err, "main.xml gives no %s", name);
    if (strlen(text) > 15 || text[strspn(text, "0123456789")] != '\0')
        return rc_err_set(err, "%s is '%s' in main.xml: it must be a whole number", name,
                          shown(quote, text));
    for (; *text != '\0'; text++)
        *value = 10 * *value + (size_t)(*text - '0');
    return RC_OK;
}

/* A number that may be absent or empty: then it is `otherwise`. */
static enum rc_status
real(const char *name, const char *text, double otherwise, double *value, struct rc_err *err)
{
    char quote[RC_SHOWN];
    const char *end;

    *value = otherwise;
    if (text == NULL || *text == '\0')
        return RC_OK;
    end = rc_number_read(text, true, value);
    if (end == NULL || *end != '\0')
        return rc_err_set(err, "%s is '%s' in main.xml: that is no number", name,
                          shown(quote, text));
    if (!isfinite(*value))
        return rc_err_set(err, "%s is '%s' in main.xml: it must be finite", name,
                          shown(quote, text));
    return RC_OK;
}

/* Room for one more height of the list; the list is never longer than the bytes it came from. */
static enum rc_status
grow(struct x3p *x, struct rc_err *err)
{
    size_t room = x->room == 0 ? 1024 : 2 * x->room;
    double *more;

    if (x->listed < x->room)
        return RC_OK;
    if ((more = realloc(x->list, room * sizeof *more)) == NULL)
        return rc_err_set(err, "out of memory for %zu heights", room);
    x->list = more;
    x->room = room;
    return RC_OK;
}

static enum rc_status
take_datum(struct x3p *x, const char *text, struct rc_err *err)
{
    char quote[RC_SHOWN];
    double value = NAN; /* an empty one is a missing point */
    const char *end = *text == '\0' ? text : rc_number_read(text, true, &value);

    if (!x->wants_list) {
        x->listed++;
        return RC_OK;
    }
    if (end != NULL && *end == ';')
        return rc_err_set(err, "Datum %zu is '%s': lists with coordinates are not read, only "
                               "matrices of heights", x->listed + 1, shown(quote, text));
    if (end == NULL || *end != '\0')
        return rc_err_set(err, "Datum %zu is '%s': that is no number", x->listed + 1,
                          shown(quote, text));
    if (grow(x, err) != RC_OK)
        return RC_FAIL;
    x->list[x->listed++] = value;
    return RC_OK;
}

/* Elements r11 to r33 of the rotation matrix. */
static enum rc_status
take_rotation(struct x3p *x, const char *name, const char *text, struct rc_err *err)
{
    double value;

    if (real("the rotation matrix", text, name[0] == name[1], &value, err) != RC_OK)
        return RC_FAIL;
    x->turned = x->turned || fabs(value - (name[0] == name[1])) > 1e-9;
    return RC_OK;
}

static enum rc_status
take_element(void *arg, const char *path, const char *text, struct rc_err *err)
{
    static const char rotation[] = "Record1/Axes/Rotation/r";
    struct x3p *x = arg;
    char quote[RC_SHOWN];

    if (strncmp(path, root_name, strlen(root_name)) != 0 || path[strlen(root_name)] != '/') {
        if (strchr(path, '/') == NULL && strcmp(path, root_name) != 0)
            return rc_err_set(err, "a ZIP archive, but no X3P: the root of its main.xml is '%s', "
                                   "not %s", shown(quote, path), root_name);
        return RC_OK;
    }
    x->is_x3p = true;
    path += strlen(root_name) + 1;
    if (strcmp(path, "Record3/DataList/Datum") == 0)
        return take_datum(x, text, err);
    if (strncmp(path, rotation, strlen(rotation)) == 0 && strlen(path) == strlen(rotation) + 2)
        return take_rotation(x, path + strlen(rotation), text, err);
    for (size_t f = 0; f < FIELDS; f++) {
        if (strcmp(path, fields[f].path) != 0)
            continue;
        if (x->text[f] != NULL && fields[f].key == NULL)
            return rc_err_set(err, "main.xml holds %s twice", fields[f].path);
        return rc_text_set(&x->text[f], text, err);
    }
    return RC_OK;
}

static enum rc_status
take_xml(void *arg, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    return rc_xml_feed(arg, bytes, n, err);
}

static enum rc_status
read_main(struct x3p *x, struct rc_err *err)
{
    struct rc_xml *xml = rc_xml_new("main.xml", take_element, x, err);
    enum rc_status status = RC_FAIL;

    if (xml == NULL)
        return RC_FAIL;
    if (rc_archive_read(x->archive, x->main, MAIN_MOST, take_xml, xml, x->sum, err) != RC_OK ||
        rc_xml_end(xml, err) != RC_OK)
        goto done;
    if (!x->is_x3p) {
        rc_err_set(err, "a ZIP archive, but no X3P: its main.xml holds no %s", root_name);
        goto done;
    }
    status = RC_OK;
done:
    rc_xml_free(xml);
    return status;
}

/* ---- what main.xml says ---- */

static enum rc_status
judge_axis(const char *name, const char *type, struct rc_err *err)
{
    char quote[RC_SHOWN];

    if (type != NULL && strcmp(type, "I") == 0)
        return RC_OK;
    return rc_err_set(err, "axis %s is of type '%s': only incremental axes (I), a regular grid, "
                           "are read", name, type == NULL ? "" : shown(quote, type));
}

/* What kind of data it is, before anything else is asked of it. */
static enum rc_status
judge_feature(struct x3p *x, struct rc_err *err)
{
    const char *feature = x->text[FEATURE] == NULL ? "" : x->text[FEATURE];
    char quote[RC_SHOWN];

    x->profile = strcmp(feature, "PRF") == 0;
    if (strcmp(feature, "PCL") == 0)
        return rc_err_set(err, "FeatureType PCL is a cloud of points: only maps (SUR) and profiles "
                               "(PRF) on a regular grid are read");
    if (!x->profile && strcmp(feature, "SUR") != 0)
        return rc_err_set(err, "FeatureType is '%s': it must be SUR or PRF", shown(quote, feature));
    if (judge_axis("CX", x->text[CX_AXIS], err) != RC_OK)
        return RC_FAIL;
    return x->profile ? RC_OK : judge_axis("CY", x->text[CY_AXIS], err);
}

static enum rc_status
judge_sizes(struct x3p *x, struct rc_err *err)
{
    size_t nz, bytes;

    if (whole("SizeX", x->text[SIZE_X], &x->nx, err) != RC_OK ||
        whole("SizeY", x->text[SIZE_Y], &x->ny, err) != RC_OK ||
        whole("SizeZ", x->text[SIZE_Z], &nz, err) != RC_OK)
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
judge_scales(struct x3p *x, struct rc_err *err)
{
    if (real("the increment of CX", x->text[CX_INCREMENT], NAN, &x->dx, err) != RC_OK ||
        real("the increment of CY", x->text[CY_INCREMENT], NAN, &x->dy, err) != RC_OK ||
        real("the increment of CZ", x->text[CZ_INCREMENT], 1, &x->increment, err) != RC_OK ||
        real("the offset of CZ", x->text[CZ_OFFSET], 0, &x->offset, err) != RC_OK)
        return RC_FAIL;
    if (x->increment == 0)
        return rc_err_set(err, "the increment of CZ is 0 in main.xml: all heights would be one");
    if (x->profile)
        x->dy = x->dx;
    return RC_OK;
}

static enum rc_status
judge_type(struct x3p *x, struct rc_err *err)
{
    static const struct {
        const char *letter;
        enum rc_raw raw;
    } types[] = {{"I", RC_RAW_I16}, {"L", RC_RAW_I32}, {"F", RC_RAW_F32}, {"D", RC_RAW_F64}};
    const char *type = x->text[CZ_TYPE] == NULL ? "" : x->text[CZ_TYPE];
    char quote[RC_SHOWN];

    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        if (strcmp(type, types[k].letter) == 0) {
            x->raw = types[k].raw;
            return RC_OK;
        }
    return rc_err_set(err, "DataType of CZ is '%s': it must be I, L, F or D", shown(quote, type));
}

static enum rc_status
judge(struct x3p *x, struct rc_err *err)
{
    if (judge_feature(x, err) != RC_OK || judge_sizes(x, err) != RC_OK ||
        judge_scales(x, err) != RC_OK || judge_type(x, err) != RC_OK)
        return RC_FAIL;
    x->binary = x->text[POINTS] != NULL && *x->text[POINTS] != '\0';
    if (!x->binary && x->listed != x->n)
        return rc_err_set(err, "the header promises %zu x %zu heights, main.xml lists %zu", x->nx,
                          x->ny, x->listed);
    return RC_OK;
}

/* ---- the archive ---- */

/* main.xml at the top, or under one folder there; macOS adds a folder of its own to archives. */
static bool
find_main(const struct rc_archive *a, size_t *member, char prefix[NAME_MOST])
{
    static const char name[] = "main.xml";
    size_t n = rc_archive_members(a);

    if (rc_archive_find(a, name, member, NULL) == RC_OK) {
        prefix[0] = '\0';
        return true;
    }
    for (size_t k = 0; k < n; k++) {
        const char *path = rc_archive_name(a, k), *slash = strchr(path, '/');
        size_t folder = slash == NULL ? 0 : (size_t)(slash - path) + 1;

        if (folder == 0 || folder >= NAME_MOST || strcmp(slash + 1, name) != 0 ||
            strncmp(path, "__MACOSX/", 9) == 0)
            continue;
        memcpy(prefix, path, folder);
        prefix[folder] = '\0';
        *member = k;
        return true;
    }
    return false;
}

static void
x3p_close(struct x3p *x)
{
    rc_archive_free(x->archive);
    free(x->list);
    for (size_t f = 0; f < FIELDS; f++)
        free(x->text[f]);
}

static enum rc_status
x3p_open(struct x3p *x, const struct rc_file *file, bool wants_list, struct rc_err *err)
{
    char quote[RC_SHOWN];

    *x = (struct x3p){.wants_list = wants_list};
    if ((x->archive = rc_archive_new(file, err)) == NULL)
        return RC_FAIL;
    if (!find_main(x->archive, &x->main, x->prefix))
        return rc_err_set(err, "a ZIP archive, but no X3P: it holds no main.xml (the first of its "
                               "%zu members is '%s')", rc_archive_members(x->archive),
                          shown(quote, rc_archive_name(x->archive, 0)));
    if (read_main(x, err) != RC_OK)
        return RC_FAIL;
    return judge(x, err);
}

/* The member that a link in main.xml names. */
static enum rc_status
follow(const struct x3p *x, const char *link, size_t *member, struct rc_err *err)
{
    char name[NAME_MOST];
    size_t n = strlen(x->prefix);

    if (strncmp(link, "./", 2) == 0)
        link += 2;
    if (n + strlen(link) >= sizeof name)
        return rc_err_set(err, "main.xml names a member with a name of %zu bytes", strlen(link));
    memcpy(name, x->prefix, n);
    strcpy(name + n, link);
    for (char *s = name; *s != '\0'; s++)
        if (*s == '\\')
            *s = '/';
    return rc_archive_find(x->archive, name, member, err);
}

/* ---- checksums ---- */

/* The MD5 sum that text begins with, in lower case; false when there is none. */
static bool
sum_of(const char *text, char sum[RC_MD5_TEXT])
{
    size_t n = strspn(text, "0123456789abcdefABCDEF");

    if (n != RC_MD5_TEXT - 1)
        return false;
    for (size_t k = 0; k < n; k++)
        sum[k] = (char)(text[k] >= 'A' && text[k] <= 'F' ? text[k] + ('a' - 'A') : text[k]);
    sum[n] = '\0';
    return true;
}

/* A sum given in main.xml against that of the bytes. */
static enum rc_status
check_sum(const char *what, const char *given, const char *sum, struct rc_notes *notes,
          struct rc_err *err)
{
    char wanted[RC_MD5_TEXT], quote[RC_SHOWN];

    if (given == NULL || *given == '\0')
        return RC_OK;
    if (!sum_of(given, wanted)) {
        rc_note(notes, "'%s' is no MD5 sum: the %s are not checked", shown(quote, given), what);
        return RC_OK;
    }
    if (strcmp(wanted, sum) == 0)
        return RC_OK;
    return rc_err_set(err, "the %s are damaged: their MD5 sum is %s, main.xml says %s", what, sum,
                      wanted);
}

struct buffer {
    unsigned char *bytes;
    size_t n;
};

static enum rc_status
take_bytes(void *arg, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    struct buffer *b = arg;

    (void)err;
    memcpy(b->bytes + b->n, bytes, n);
    b->n += n;
    return RC_OK;
}

static void
check_main(struct x3p *x, struct rc_notes *notes)
{
    const char *link = x->text[SUM_FILE];
    unsigned char bytes[SUM_MOST + 1];
    struct buffer buffer = {.bytes = bytes};
    char wanted[RC_MD5_TEXT], ignored[RC_MD5_TEXT];
    struct rc_err err;
    size_t member;

    if (link == NULL || *link == '\0')
        link = "md5checksum.hex";
    if (follow(x, link, &member, NULL) != RC_OK) {
        rc_note(notes, "the file has no md5checksum.hex: main.xml is not checked");
        return;
    }
    if (rc_archive_read(x->archive, member, SUM_MOST, take_bytes, &buffer, ignored, &err) !=
        RC_OK) {
        rc_note(notes, "main.xml is not checked: %s", err.text);
        return;
    }
    bytes[buffer.n] = '\0';
    if (!sum_of((const char *)bytes, wanted))
        rc_note(notes, "md5checksum.hex holds no MD5 sum: main.xml is not checked");
    else if (strcmp(wanted, x->sum) != 0)
        rc_note(notes, "main.xml was changed after its checksum was written: its MD5 sum is %s, "
                       "md5checksum.hex says %s", x->sum, wanted);
}

/* ---- heights ---- */

struct values {
    double *v;
    size_t n;
    enum rc_raw raw;
};

/* Pieces hold whole numbers: RC_PIECE is a multiple of every width, and the size was checked. */
static enum rc_status
take_values(void *arg, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    struct values *values = arg;
    struct rc_bytes cursor = {.data = bytes, .size = n};
    size_t count = n / rc_raw_width(values->raw);

    (void)err;
    rc_bytes_values(&cursor, values->raw, values->v + values->n, count);
    values->n += count;
    return RC_OK;
}

/* Finds the member and checks its size before anything is allocated for it. */
static enum rc_status
find_points(struct x3p *x, size_t *member, struct rc_err *err)
{
    uint64_t size, wanted = (uint64_t)x->n * rc_raw_width(x->raw);

    if (follow(x, x->text[POINTS], member, err) != RC_OK ||
        rc_archive_size(x->archive, *member, &size, err) != RC_OK)
        return RC_FAIL;
    return rc_bytes_agree("heights", wanted, size, err);
}

static enum rc_status
read_points(struct x3p *x, size_t member, double *v, struct rc_notes *notes, struct rc_err *err)
{
    struct values values = {.v = v, .raw = x->raw};
    uint64_t size = (uint64_t)x->n * rc_raw_width(x->raw);
    char sum[RC_MD5_TEXT];

    if (rc_archive_read(x->archive, member, size, take_values, &values, sum, err) != RC_OK)
        return RC_FAIL;
    return check_sum("heights", x->text[POINTS_SUM], sum, notes, err);
}

static enum rc_status
apply_mask(struct x3p *x, double *v, struct rc_notes *notes, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    struct buffer mask = {0};
    size_t member, least = x->n / 8 + (x->n % 8 != 0);
    char sum[RC_MD5_TEXT];
    uint64_t size;

    if (x->text[VALID] == NULL || *x->text[VALID] == '\0')
        return RC_OK;
    if (follow(x, x->text[VALID], &member, err) != RC_OK ||
        rc_archive_size(x->archive, member, &size, err) != RC_OK)
        return RC_FAIL;
    if ((size < least || size > least + MASK_PADDING) &&
        rc_bytes_agree("valid points", least, size, err) != RC_OK)
        return RC_FAIL;
    if ((mask.bytes = malloc((size_t)size)) == NULL)
        return rc_err_set(err, "out of memory for %zu valid points", x->n);
    if (rc_archive_read(x->archive, member, size, take_bytes, &mask, sum, err) == RC_OK &&
        check_sum("valid points", x->text[VALID_SUM], sum, notes, err) == RC_OK) {
        for (size_t k = 0; k < x->n; k++)
            if ((mask.bytes[k / 8] >> k % 8 & 1) == 0)
                v[k] = NAN;
        status = RC_OK;
    }
    free(mask.bytes);
    return status;
}

static enum rc_status
scale(const struct x3p *x, double metres, double *v, struct rc_err *err)
{
    for (size_t k = 0; k < x->n; k++) {
        if (isnan(v[k]))
            continue;
        v[k] = (v[k] * x->increment + x->offset) * metres;
        if (!isfinite(v[k]))
            return rc_err_set(err, "the height at column %zu, row %zu (from 0) is infinite",
                              k % x->nx, k / x->nx);
    }
    return RC_OK;
}

static struct rc_grid *
make_grid(struct x3p *x, const struct rc_wish *wish, double *metres, struct rc_notes *notes,
          struct rc_err *err)
{
    struct rc_shape shape = {.nx = x->nx, .ny = x->ny};
    struct rc_grid *g;

    if (rc_spacing(wish, x->dx, x->dy, &shape, notes, err) != RC_OK ||
        rc_height_unit(wish, 1, "m", metres, notes, err) != RC_OK ||
        (g = rc_grid_new(&shape, "height", "m", err)) == NULL)
        return NULL;
    for (size_t f = FIRST_KEY; f < FIELDS; f++)
        if (x->text[f] != NULL && rc_text_keep(g, fields[f].key, x->text[f], strlen(x->text[f]),
                                               err) != RC_OK) {
            rc_grid_free(g);
            return NULL;
        }
    return g;
}

/* ---- the row ---- */

static int
x3p_score(const struct rc_file *file)
{
    struct rc_archive *archive;
    char prefix[NAME_MOST];
    size_t n = strlen(file->name), member;
    bool named = n > 4 && strcmp(file->name + n - 4, ".x3p") == 0;
    bool has_main;

    if (file->size < 4 || memcmp(file->data, "PK", 2) != 0)
        return 0;
    /* Another kind of archive scores a little too, so that its refusal names what it lacks. */
    if ((archive = rc_archive_new(file, NULL)) == NULL)
        return named ? 50 : 5;
    has_main = find_main(archive, &member, prefix);
    rc_archive_free(archive);
    return has_main ? (named ? 95 : 80) : 5;
}

static size_t
x3p_list(const struct rc_file *file, const struct rc_wish *wish, struct rc_channel *channel,
         size_t most, struct rc_err *err)
{
    struct x3p x;
    size_t n = 0;

    (void)wish;
    if (x3p_open(&x, file, false, err) == RC_OK) {
        if (most > 0)
            *channel = (struct rc_channel){
                .name = "height", .unit = "m", .nx = x.nx, .ny = x.ny, .dx = x.dx, .dy = x.dy};
        n = 1;
    }
    x3p_close(&x);
    return n;
}

static struct rc_grid *
x3p_read(const struct rc_file *file, const struct rc_wish *wish, size_t index,
         struct rc_notes *notes, struct rc_err *err)
{
    struct rc_grid *g = NULL;
    struct x3p x;
    size_t points = 0;
    double metres;
    bool good = false;

    if (x3p_open(&x, file, true, err) != RC_OK)
        goto done;
    if (index != 0) {
        rc_err_set(err, "an X3P file has one channel, not %zu", index + 1);
        goto done;
    }
    if ((x.binary && find_points(&x, &points, err) != RC_OK) ||
        rc_map_fits(file, x.nx, x.ny, err) != RC_OK)
        goto done;
    check_main(&x, notes);
    if (x.turned)
        rc_note(notes, "the file turns its axes by a rotation matrix: it is not applied");
    if ((g = make_grid(&x, wish, &metres, notes, err)) == NULL)
        goto done;
    if (!x.binary)
        memcpy(g->v, x.list, x.n * sizeof *g->v);
    else if (read_points(&x, points, g->v, notes, err) != RC_OK)
        goto done;
    good = apply_mask(&x, g->v, notes, err) == RC_OK && scale(&x, metres, g->v, err) == RC_OK;
done:
    x3p_close(&x);
    if (good)
        return g;
    rc_grid_free(g);
    return NULL;
}

const struct rc_format rc_format_x3p = {
    .name = "x3p",
    .suffixes = ".x3p",
    .summary = "ISO 25178-72 (ISO 5436-2): maps and profiles",
    .score = x3p_score,
    .list = x3p_list,
    .read = x3p_read,
};
