/* VTK RectilinearGrid: as vti.c, with the place of every node written out, so that depths may
 * have uneven steps. */
#include "volume.h"

static void
make_header(struct rc_buffer *b, const struct rc_volume *v, const struct rc_grid *g)
{
    static const char axis[] = "xyz";
    uint64_t offset = 0;

    rc_buffer_print(b,
                    "<?xml version=\"1.0\"?>\n"
                    "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                    "header_type=\"UInt64\">\n"
                    "  <RectilinearGrid WholeExtent=\"0 %zu 0 %zu 0 %zu\">\n",
                    v->n[0] - 1, v->n[1] - 1, v->n[2] - 1);
    rc_vtk_history(b, g);
    rc_buffer_print(b, "    <Piece Extent=\"0 %zu 0 %zu 0 %zu\">\n      <Coordinates>\n",
                    v->n[0] - 1, v->n[1] - 1, v->n[2] - 1);
    for (int k = 0; k < 3; k++) {
        rc_buffer_print(b,
                        "        <DataArray type=\"Float64\" Name=\"%c\" format=\"appended\" "
                        "offset=\"%llu\"/>\n",
                        axis[k], (unsigned long long)offset);
        offset += rc_vtk_bytes(v->n[k], RC_RAW_F64);
    }
    rc_buffer_print(b, "      </Coordinates>\n");
    rc_vtk_arrays(b, v, offset);
    rc_buffer_print(b, "    </Piece>\n  </RectilinearGrid>\n"
                       "  <AppendedData encoding=\"raw\">\n   _");
}

static enum rc_status
vtr_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    static const char end[] = "\n  </AppendedData>\n</VTKFile>\n";
    struct rc_buffer header = {0};
    enum rc_status status = RC_FAIL;
    struct rc_volume v;

    if (rc_volume_make(&v, frame, frames, wish, err) != RC_OK)
        goto done;
    make_header(&header, &v, frame[0]);
    if (rc_buffer_write(&header, out, err) != RC_OK)
        goto done;
    for (int axis = 0; axis < 3; axis++)
        if (rc_vtk_put(out, v.at[axis], v.n[axis], RC_RAW_F64, err) != RC_OK)
            goto done;
    if (rc_vtk_put_arrays(out, &v, err) == RC_OK)
        status = rc_put(out, end, sizeof end - 1, err);
done:
    rc_buffer_free(&header);
    rc_volume_free(&v);
    return status;
}

const struct rc_export rc_export_vtr = {
    .name = "vtr",
    .suffixes = ".vtr",
    .summary = "VTK RectilinearGrid (ParaView): as vti, for uneven depths",
    .several = true,
    .types = RC_VTK_TYPES,
    .uneven = true,
    .write = vtr_write,
};
