/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "meter.h"

#include <sanitizer/allocator_interface.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double seconds_most = 1;

static struct {
    size_t held, most;
    clock_t start;
    int installed;
} meter;

static void
on_malloc(const volatile void *at, size_t n)
{
    (void)at;
    meter.held += n;
    if (meter.most == 0 || meter.held <= meter.most)
        return;
    fprintf(stderr, "%zu bytes are held, of which the last %zu, with %zu allowed\n", meter.held, n,
            meter.most);
    meter.most = 0;
    abort();
}

static void
on_free(const volatile void *at)
{
    size_t n = at == NULL ? 0 : __sanitizer_get_allocated_size(at);

    meter.held -= n < meter.held ? n : meter.held; /* blocks from before the start may be freed */
}

void
meter_start(size_t most)
{
    if (!meter.installed)
        meter.installed = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
    if (!meter.installed) {
        fprintf(stderr, "the memory cannot be metered\n");
        abort();
    }
    meter.held = 0;
    meter.most = most;
    meter.start = clock();
}

void
meter_stop(void)
{
    double seconds = (double)(clock() - meter.start) / CLOCKS_PER_SEC;

    meter.most = 0;
    if (seconds <= seconds_most)
        return;
    fprintf(stderr, "it took %.2f s\n", seconds);
    abort();
}
