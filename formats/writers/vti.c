/* VTK ImageData: XML with the values appended as they are, a 64-bit length before each array. */
#include "volume.h"

static enum rc_status
make_header(struct rc_buffer *b, const struct rc_volume *v, const struct rc_grid *g,
            struct rc_err *err)
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
    rc_buffer_print(b,
                    "<?xml version=\"1.0\"?>\n"
                    "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                    "header_type=\"UInt64\">\n"
                    "  <ImageData WholeExtent=\"0 %zu 0 %zu 0 %zu\" Origin=\"%s %s %s\" "
                    "Spacing=\"%s %s %s\">\n",
                    v->n[0] - 1, v->n[1] - 1, v->n[2] - 1, origin[0], origin[1], origin[2],
                    spacing[0], spacing[1], spacing[2]);
    rc_vtk_history(b, g);
    rc_buffer_print(b, "    <Piece Extent=\"0 %zu 0 %zu 0 %zu\">\n", v->n[0] - 1, v->n[1] - 1,
                    v->n[2] - 1);
    rc_vtk_arrays(b, v, 0);
    rc_buffer_print(b, "    </Piece>\n  </ImageData>\n  <AppendedData encoding=\"raw\">\n   _");
    return RC_OK;
}

static enum rc_status
vti_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    static const char end[] = "\n  </AppendedData>\n</VTKFile>\n";
    struct rc_buffer header = {0};
    enum rc_status status = RC_FAIL;
    struct rc_volume v;

    if (rc_volume_make(&v, frame, frames, wish, err) == RC_OK &&
        make_header(&header, &v, frame[0], err) == RC_OK &&
        rc_buffer_write(&header, out, err) == RC_OK && rc_vtk_put_arrays(out, &v, err) == RC_OK)
        status = rc_put(out, end, sizeof end - 1, err);
    rc_buffer_free(&header);
    rc_volume_free(&v);
    return status;
}

const struct rc_export rc_export_vti = {
    .name = "vti",
    .suffixes = ".vti",
    .summary = "VTK ImageData (ParaView): frames as arrays, even depths as a stack",
    .several = true,
    .types = RC_VTK_TYPES,
    .write = vti_write,
};
