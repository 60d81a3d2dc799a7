/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "volume.h"

#include <stdlib.h>
#include <string.h>

#include "encode.h"
#include "formats/core/core.h"
#include "stack.h"

/* A value at every node; each layer is a frame. */
struct layers {
    struct rc_stack stack;
    char name[RC_LABEL];
    enum rc_raw raw;
};

struct volume {
    size_t n[3];   /* nodes along x, y, z             */
    double *at[3]; /* n positions of nodes            */
    size_t layers; /* frames in each stack            */
    size_t node;   /* values in a layer               */
    struct layers *array;
    size_t arrays;
};

/* ---- frames of one volume ---- */

static bool
depth_of(const struct rc_grid *g, double *depth)
{
    return rc_grid_number(g, "depth", depth);
}

static enum rc_status
check_alike(struct rc_grid *const *frame, size_t frames, struct rc_err *err)
{
    const struct rc_grid *a = frame[0];
    const char *section = rc_grid_get(a, "section");
    double depth;
    bool deep = depth_of(a, &depth);

    for (size_t k = 1; k < frames; k++) {
        const struct rc_grid *b = frame[k];
        const char *other = rc_grid_get(b, "section");

        if (b->nx != a->nx || b->ny != a->ny || b->dx != a->dx || b->dy != a->dy)
            return rc_err_set(
                err, "frame %zu (%s) has another grid than the first (%s): one file holds one grid",
                k + 1, b->channel, a->channel);
        if (depth_of(b, &depth) != deep)
            return rc_err_set(err,
                              "some frames have a depth and some have none: choose by --channel");
        if ((section == NULL) != (other == NULL) ||
            (section != NULL && strcmp(section, other) != 0))
            return rc_err_set(
                err, "sections and maps, or sections of two directions, do not fit into one file");
    }
    return RC_OK;
}

static enum rc_status
stack_frames(struct volume *v, struct rc_grid *const *frame, size_t frames, struct rc_err *err)
{
    struct rc_stack *stack;
    enum rc_status status = rc_stacks_make(&stack, &v->arrays, frame, frames, err);

    if (status == RC_OK && (v->array = calloc(v->arrays, sizeof *v->array)) == NULL)
        status = rc_err_set(err, "out of memory for %zu frames", frames);
    if (status != RC_OK) {
        rc_stacks_free(stack, v->arrays);
        v->arrays = 0;
        return RC_FAIL;
    }
    for (size_t a = 0; a < v->arrays; a++)
        v->array[a].stack = stack[a];
    free(stack);
    v->layers = v->array[0].stack.n;
    for (size_t a = 0; a < v->arrays; a++)
        if (v->array[a].stack.n != v->layers)
            return rc_err_set(err, "%s has %zu depths and %s has %zu: one file holds one stack",
                              frame[0]->channel, v->layers, v->array[a].stack.layer[0]->channel,
                              v->array[a].stack.n);
    return RC_OK;
}

static enum rc_status
check_depths(const struct volume *v, struct rc_err *err)
{
    const struct rc_stack *first = &v->array[0].stack;

    for (size_t a = 1; a < v->arrays; a++)
        for (size_t k = 0; k < v->layers; k++)
            if (rc_stack_depth(&v->array[a].stack, k) != rc_stack_depth(first, k))
                return rc_err_set(
                    err, "channels %s and %s have different depths: one file holds one stack",
                    first->layer[0]->channel, v->array[a].stack.layer[0]->channel);
    return RC_OK;
}

static enum rc_status
name_arrays(struct volume *v, const struct rc_export_wish *wish, struct rc_err *err)
{
    RC_OWNED struct rc_grid **first = calloc(v->arrays, sizeof(struct rc_grid *));

    if (first == NULL)
        return rc_err_set(err, "out of memory for %zu names", v->arrays);
    for (size_t a = 0; a < v->arrays; a++)
        first[a] = v->array[a].stack.layer[0];
    for (size_t a = 0; a < v->arrays; a++) {
        rc_export_label(v->array[a].name, first, v->arrays, a, false);
        v->array[a].raw = rc_export_raw(first[a], wish, RC_VTK_TYPES);
    }
    return RC_OK;
}

/* ---- positions of the nodes ---- */

static enum rc_status
place_nodes(struct volume *v, const struct rc_grid *g, struct rc_err *err)
{
    const char *section = rc_grid_get(g, "section");
    bool cut = section != NULL, along_y = cut && strcmp(section, "x") == 0;
    int first = along_y ? 1 : 0, other = along_y ? 0 : 1; /* the axis along rows; the other one */
    double at = 0, middle, row;

    rc_grid_origin(g, &middle, &row);
    v->n[first] = g->nx;
    v->n[other] = cut ? 1 : g->ny;
    v->n[2] = cut ? g->ny : v->layers;
    if (cut && v->layers > 1)
        return rc_err_set(err, "a section holds all depths itself: sections at several depths do "
                               "not fit into one file");
    for (int axis = 0; axis < 3; axis++)
        if ((v->at[axis] = calloc(v->n[axis], sizeof(double))) == NULL)
            return rc_err_set(err, "out of memory for the nodes of %zu x %zu x %zu", v->n[0],
                              v->n[1], v->n[2]);
    for (size_t i = 0; i < g->nx; i++)
        v->at[first][i] = ((double)i - middle) * g->dx;
    for (size_t j = 0; j < g->ny && !cut; j++)
        v->at[1][j] = ((double)j - row) * g->dy;
    for (size_t k = 0; k < v->layers && !cut; k++)
        v->at[2][k] = rc_stack_depth(&v->array[0].stack, k);
    if (cut && rc_grid_number(g, "at", &at))
        v->at[other][0] = at;
    return cut ? rc_export_depths(g, v->at[2], err) : RC_OK;
}

/* RC_FAIL for frames that do not fit together. Free it in either case. */
static enum rc_status
volume_make(struct volume *v, struct rc_grid *const *frame, size_t frames,
            const struct rc_export_wish *wish, struct rc_err *err)
{
    *v = (struct volume){.node = frame[0]->nx * frame[0]->ny};
    if (check_alike(frame, frames, err) != RC_OK || stack_frames(v, frame, frames, err) != RC_OK ||
        place_nodes(v, frame[0], err) != RC_OK || check_depths(v, err) != RC_OK)
        return RC_FAIL;
    return name_arrays(v, wish, err);
}

static void
volume_free(struct volume *v)
{
    for (size_t a = 0; a < v->arrays; a++)
        free(v->array[a].stack.layer);
    free(v->array);
    for (int axis = 0; axis < 3; axis++)
        free(v->at[axis]);
}

/* ---- XML and appended data ---- */

/* Bytes that an array of n values takes in the file, with the count before it. */
static uint64_t
bytes_of(size_t n, enum rc_raw raw)
{
    return sizeof(uint64_t) + (uint64_t)n * rc_raw_width(raw);
}

/* The attributes and the keys of the arrays as a header, `<PointData>...`, whose data begin at byte `offset`
 * of the appended data. */
static void
put_keys(struct rc_buffer *b, const struct volume *v, uint64_t offset)
{
    rc_buffer_print(b, "      <PointData Scalars=\"");
    rc_buffer_escaped(b, v->array[0].name);
    rc_buffer_print(b, "\">\n");
    for (size_t a = 0; a < v->arrays; a++) {
        rc_buffer_print(b, "        <DataArray type=\"%s\" Name=\"",
                        v->array[a].raw == RC_RAW_F32 ? "Float32" : "Float64");
        rc_buffer_escaped(b, v->array[a].name);
        rc_buffer_print(b,
                        "\" format=\"appended\" offset=\"%llu\">\n"
                        "          <InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">",
                        (unsigned long long)offset);
        rc_buffer_escaped(b, v->array[a].stack.layer[0]->unit);
        rc_buffer_print(b, "</InformationKey>\n        </DataArray>\n");
        offset += bytes_of(v->node * v->layers, v->array[a].raw);
    }
    rc_buffer_print(b, "      </PointData>\n");
}

/* The history of the first frame, as field data. */
static void
put_history(struct rc_buffer *b, const struct rc_grid *g)
{
    const char *history = rc_grid_get(g, "history");

    if (history == NULL)
        return;
    rc_buffer_print(b, "    <FieldData>\n      <DataArray type=\"String\" Name=\"history\" "
                       "NumberOfTuples=\"1\" format=\"ascii\">\n       ");
    for (const char *s = history; *s != '\0'; s++)
        rc_buffer_print(b, " %d", (unsigned char)*s);
    rc_buffer_print(b, " 0\n      </DataArray>\n    </FieldData>\n");
}

/* The length in bytes of an array of the appended data, written before its values. */
static enum rc_status
put_length(FILE *out, size_t n, enum rc_raw raw, struct rc_err *err)
{
    RC_ENDS(rc_buffer_free) struct rc_buffer b = {0};

    rc_buffer_u64(&b, bytes_of(n, raw) - sizeof(uint64_t));
    return rc_buffer_write(&b, out, err);
}

static enum rc_status
put_arrays(FILE *out, const struct volume *v, struct rc_err *err)
{
    for (size_t a = 0; a < v->arrays; a++) {
        const struct rc_code code = {.raw = v->array[a].raw};

        if (put_length(out, v->node * v->layers, code.raw, err) != RC_OK)
            return RC_FAIL;
        for (size_t k = 0; k < v->layers; k++)
            if (rc_encode_file(&code, v->array[a].stack.layer[k]->v, v->node, out, err) != RC_OK)
                return RC_FAIL;
    }
    return RC_OK;
}

/* ---- the file ---- */

/* Writes the constant steps of an image as attributes of its XML element. */
static enum rc_status
put_steps(struct rc_buffer *b, const struct volume *v, const struct rc_grid *g, struct rc_err *err)
{
    char origin[3][RC_NUMBER_SIZE], spacing[3][RC_NUMBER_SIZE];
    double step;

    for (int axis = 0; axis < 3; axis++) {
        if (!rc_export_even(v->at[axis], v->n[axis], &step))
            return rc_err_set(err,
                              "the depths have uneven steps, an image has even ones: write vtr");
        rc_number_text(origin[axis], v->at[axis][0]);
        rc_number_text(spacing[axis], step == 0 ? g->dx : step); /* it must not be 0 */
    }
    rc_buffer_print(b, " Origin=\"%s %s %s\" Spacing=\"%s %s %s\"", origin[0], origin[1], origin[2],
                    spacing[0], spacing[1], spacing[2]);
    return RC_OK;
}

/* The positions of all nodes, which are the first arrays of the appended data; *offset: the byte after
 * them. */
static void
put_coordinates(struct rc_buffer *b, const struct volume *v, uint64_t *offset)
{
    rc_buffer_print(b, "      <Coordinates>\n");
    for (int k = 0; k < 3; k++) {
        rc_buffer_print(b,
                        "        <DataArray type=\"Float64\" Name=\"%c\" format=\"appended\" "
                        "offset=\"%llu\"/>\n",
                        "xyz"[k], (unsigned long long)*offset);
        *offset += bytes_of(v->n[k], RC_RAW_F64);
    }
    rc_buffer_print(b, "      </Coordinates>\n");
}

static enum rc_status
make_header(struct rc_buffer *b, const struct volume *v, const struct rc_grid *g, bool image,
            struct rc_err *err)
{
    const char *kind = image ? "ImageData" : "RectilinearGrid";
    char extent[80];
    uint64_t offset = 0;

    snprintf(extent, sizeof extent, "Extent=\"0 %zu 0 %zu 0 %zu\"", v->n[0] - 1, v->n[1] - 1,
             v->n[2] - 1);
    rc_buffer_print(b,
                    "<?xml version=\"1.0\"?>\n"
                    "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"LittleEndian\" "
                    "header_type=\"UInt64\">\n"
                    "  <%s Whole%s",
                    kind, kind, extent);
    if (image && put_steps(b, v, g, err) != RC_OK)
        return RC_FAIL;
    rc_buffer_print(b, ">\n");
    put_history(b, g);
    rc_buffer_print(b, "    <Piece %s>\n", extent);
    if (!image)
        put_coordinates(b, v, &offset);
    put_keys(b, v, offset);
    rc_buffer_print(b, "    </Piece>\n  </%s>\n  <AppendedData encoding=\"raw\">\n   _", kind);
    return RC_OK;
}

enum rc_status
rc_vtk_write(FILE *out, struct rc_grid *const *frame, size_t frames, bool image,
             const struct rc_export_wish *wish, struct rc_err *err)
{
    static const char end[] = "\n  </AppendedData>\n</VTKFile>\n";
    const struct rc_code place = {.raw = RC_RAW_F64};
    RC_ENDS(rc_buffer_free) struct rc_buffer header = {0};
    struct volume v;
    enum rc_status status = volume_make(&v, frame, frames, wish, err);

    if (status == RC_OK)
        status = make_header(&header, &v, frame[0], image, err);
    if (status == RC_OK)
        status = rc_buffer_write(&header, out, err);
    for (int axis = 0; status == RC_OK && !image && axis < 3; axis++)
        if ((status = put_length(out, v.n[axis], place.raw, err)) == RC_OK)
            status = rc_encode_file(&place, v.at[axis], v.n[axis], out, err);
    if (status == RC_OK && (status = put_arrays(out, &v, err)) == RC_OK)
        status = rc_put(out, end, sizeof end - 1, err);
    volume_free(&v);
    return status;
}
