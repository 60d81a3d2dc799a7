/* The order by approximate minimum degree of SuiteSparse (Amestoy, Davis and Duff, ACM Trans. Math. Softw.
 * 30, 2004, 381). Only this file uses SuiteSparse. */
#include "leak.h"

#ifdef RC_AMD
#include <amd.h>

enum rc_status
rc_ordering(int32_t n, const int32_t *start, const int32_t *row, int32_t *order, struct rc_err *err)
{
    int status = amd_order(n, start, row, order, NULL, NULL);

    if (status != AMD_OK && status != AMD_OK_BUT_JUMBLED)
        return rc_err_set(err, "out of memory for the order of %d nodes with fluid", n);
    return RC_OK;
}
#else
enum rc_status
rc_ordering(int32_t n, const int32_t *start, const int32_t *row, int32_t *order, struct rc_err *err)
{
    (void)n, (void)start, (void)row, (void)order;
    return rc_err_set(err, "this build has no flow through gaps: AMD of SuiteSparse was not found");
}
#endif
