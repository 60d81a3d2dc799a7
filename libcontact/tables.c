/*
 * The tables of what can be named, for who walks them from outside. Those of engines and methods
 * stand where these are chosen.
 */
#include "libcontact/operator/operator.h"

static const struct rc_kernel *const kernels[] = {
#define RC_KERNEL(name) &rc_kernel_##name,
#include RC_KERNELS_LIST
#undef RC_KERNEL
};

enum {
    KERNELS = sizeof kernels / sizeof *kernels
};

const struct rc_kernel_info *
rc_kernel_info(size_t k)
{
    return k < KERNELS ? &kernels[k]->info : NULL;
}
