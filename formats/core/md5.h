/* MD5 (RFC 1321): finds damage that happened by chance, as file formats use it. It is no defence
 * against intent. */
#ifndef RC_MD5_H
#define RC_MD5_H

#include <stddef.h>
#include <stdint.h>

enum {
    RC_MD5_TEXT = 33 /* 32 hexadecimal digits and the NUL */
};

struct rc_md5 {
    uint32_t state[4];
    uint64_t bytes;
    unsigned char block[64]; /* what has come since the last whole block */
};

void rc_md5_start(struct rc_md5 *md5);
void rc_md5_add(struct rc_md5 *md5, const void *bytes, size_t n);
/* The sum of all that was added, in lower case. The state is spent. */
void rc_md5_end(struct rc_md5 *md5, char text[RC_MD5_TEXT]);

#endif
