#include "sums.h"

#include <pthread.h>
#include <stdlib.h>

enum {
    PIECES = 4
};

struct rc_sums {
    struct rc_md5 md5;
    size_t piece;
    unsigned char *room; /* PIECES of them, or one where there is no thread */
    bool aside;          /* there is a thread */
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t turned; /* a count below has changed */
    size_t filled, summed, n[PIECES];
    bool last; /* none will follow those filled */
};

static void *
sum_pieces(void *arg)
{
    struct rc_sums *s = arg;

    pthread_mutex_lock(&s->lock);
    for (;;) {
        size_t at = s->summed % PIECES;

        while (s->summed == s->filled && !s->last)
            pthread_cond_wait(&s->turned, &s->lock);
        if (s->summed == s->filled)
            break;
        pthread_mutex_unlock(&s->lock);
        rc_md5_add(&s->md5, s->room + at * s->piece, s->n[at]);
        pthread_mutex_lock(&s->lock);
        s->summed++;
        pthread_cond_signal(&s->turned);
    }
    pthread_mutex_unlock(&s->lock);
    return NULL;
}

struct rc_sums *
rc_sums_new(size_t piece, uint64_t total, struct rc_err *err)
{
    struct rc_sums *s = calloc(1, sizeof *s);
    size_t pieces = total > piece ? PIECES : 1;

    if (s == NULL || (s->room = malloc(pieces * piece)) == NULL) {
        rc_err_set(err, "out of memory for %zu bytes", pieces * piece);
        free(s);
        return NULL;
    }
    s->piece = piece;
    rc_md5_start(&s->md5);
    pthread_mutex_init(&s->lock, NULL);
    pthread_cond_init(&s->turned, NULL);
    s->aside = pieces > 1 && pthread_create(&s->thread, NULL, sum_pieces, s) == 0;
    return s;
}

unsigned char *
rc_sums_room(struct rc_sums *s)
{
    if (!s->aside)
        return s->room;
    pthread_mutex_lock(&s->lock);
    while (s->filled - s->summed == PIECES)
        pthread_cond_wait(&s->turned, &s->lock);
    pthread_mutex_unlock(&s->lock);
    return s->room + s->filled % PIECES * s->piece; /* only this thread changes `filled` */
}

void
rc_sums_add(struct rc_sums *s, size_t n)
{
    if (!s->aside) {
        rc_md5_add(&s->md5, s->room, n);
        return;
    }
    pthread_mutex_lock(&s->lock);
    s->n[s->filled++ % PIECES] = n;
    pthread_cond_signal(&s->turned);
    pthread_mutex_unlock(&s->lock);
}

void
rc_sums_end(struct rc_sums *s, char sum[RC_MD5_TEXT])
{
    if (s->aside) {
        pthread_mutex_lock(&s->lock);
        s->last = true;
        pthread_cond_signal(&s->turned);
        pthread_mutex_unlock(&s->lock);
        pthread_join(s->thread, NULL);
    }
    rc_md5_end(&s->md5, sum);
    pthread_cond_destroy(&s->turned);
    pthread_mutex_destroy(&s->lock);
    free(s->room);
    free(s);
}
