/*
 * An MD5 sum taken by a second thread, while the first fetches the next bytes and turns them into
 * numbers: the sum is a chain of additions that nothing makes shorter, as long as all the rest.
 */
#ifndef RC_SUMS_H
#define RC_SUMS_H

#include <stddef.h>

#include "libcontact/grid.h"
#include "md5.h"

struct rc_sums;

/* For `total` bytes in pieces of at most `piece`; few are summed by the thread that calls. */
struct rc_sums *rc_sums_new(size_t piece, uint64_t total, struct rc_err *err);
/* Room for the next piece; waits until one has been summed. */
unsigned char *rc_sums_room(struct rc_sums *sums);
/* The first n bytes of that room are to be summed, and are not changed from now on. */
void rc_sums_add(struct rc_sums *sums, size_t n);
/* Waits for the sum of all pieces, and frees. */
void rc_sums_end(struct rc_sums *sums, char sum[RC_MD5_TEXT]);

#endif
