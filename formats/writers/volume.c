#include "volume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* ---- which frames belong together ---- */

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
stack_frames(struct rc_volume *v, struct rc_grid *const *frame, size_t frames, struct rc_err *err)
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
check_depths(const struct rc_volume *v, struct rc_err *err)
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
name_arrays(struct rc_volume *v, const struct rc_export_wish *wish, struct rc_err *err)
{
    struct rc_grid **first = calloc(v->arrays, sizeof(struct rc_grid *));

    if (first == NULL)
        return rc_err_set(err, "out of memory for %zu names", v->arrays);
    for (size_t a = 0; a < v->arrays; a++)
        first[a] = v->array[a].stack.layer[0];
    for (size_t a = 0; a < v->arrays; a++) {
        rc_export_label(v->array[a].name, first, v->arrays, a, false);
        v->array[a].raw = rc_export_raw(first[a], wish, RC_VTK_TYPES);
    }
    free(first);
    return RC_OK;
}

/* ---- where the nodes are ---- */

static enum rc_status
place_nodes(struct rc_volume *v, const struct rc_grid *g, struct rc_err *err)
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

enum rc_status
rc_volume_make(struct rc_volume *v, struct rc_grid *const *frame, size_t frames,
               const struct rc_export_wish *wish, struct rc_err *err)
{
    *v = (struct rc_volume){.node = frame[0]->nx * frame[0]->ny};
    if (check_alike(frame, frames, err) != RC_OK || stack_frames(v, frame, frames, err) != RC_OK ||
        place_nodes(v, frame[0], err) != RC_OK || check_depths(v, err) != RC_OK)
        return RC_FAIL;
    return name_arrays(v, wish, err);
}

void
rc_volume_free(struct rc_volume *v)
{
    for (size_t a = 0; a < v->arrays; a++)
        free(v->array[a].stack.layer);
    free(v->array);
    for (int axis = 0; axis < 3; axis++)
        free(v->at[axis]);
}

/* ---- XML and appended data ---- */

uint64_t
rc_vtk_bytes(size_t n, enum rc_raw raw)
{
    return sizeof(uint64_t) + (uint64_t)n * rc_raw_width(raw);
}

void
rc_vtk_arrays(struct rc_buffer *b, const struct rc_volume *v, uint64_t offset)
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
        offset += rc_vtk_bytes(v->node * v->layers, v->array[a].raw);
    }
    rc_buffer_print(b, "      </PointData>\n");
}

void
rc_vtk_history(struct rc_buffer *b, const struct rc_grid *g)
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

static enum rc_status
put_length(FILE *out, size_t n, enum rc_raw raw, struct rc_err *err)
{
    struct rc_buffer b = {0};
    enum rc_status status;

    rc_buffer_u64(&b, rc_vtk_bytes(n, raw) - sizeof(uint64_t));
    status = rc_buffer_write(&b, out, err);
    rc_buffer_free(&b);
    return status;
}

enum rc_status
rc_vtk_put(FILE *out, const double *v, size_t n, enum rc_raw raw, struct rc_err *err)
{
    const struct rc_code code = {.raw = raw};

    if (put_length(out, n, raw, err) != RC_OK)
        return RC_FAIL;
    return rc_encode_file(&code, v, n, out, err);
}

enum rc_status
rc_vtk_put_arrays(FILE *out, const struct rc_volume *v, struct rc_err *err)
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
