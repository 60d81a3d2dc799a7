#include "limit.h"

#include <stdint.h>

enum {
    TIMES_FILE = 16,
    LEAST = 64 << 20,
};

size_t
rc_memory_limit(size_t file_size)
{
    const size_t most = SIZE_MAX / 2; /* so that what the process has already can be added to it */

    return file_size > (most - LEAST) / TIMES_FILE ? most : TIMES_FILE * file_size + LEAST;
}

enum rc_status
rc_map_fits(const struct rc_file *file, size_t nx, size_t ny, struct rc_err *err)
{
    size_t n, bytes, limit = rc_memory_limit(file->size);

    if (rc_size_mul(nx, ny, &n, err) != RC_OK ||
        rc_size_mul(n, sizeof(double), &bytes, err) != RC_OK)
        return RC_FAIL;
    if (bytes > limit)
        return rc_err_set(err,
                          "%zu x %zu values need %zu MiB, more than the %zu that a file of %zu "
                          "bytes may take",
                          nx, ny, bytes >> 20, limit >> 20, file->size);
    return RC_OK;
}
