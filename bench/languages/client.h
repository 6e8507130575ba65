/* What the clients in C and C++ share: `run` writes a number of messages to standard input and expects the time of each
 * round trip, in nanoseconds, as one line. */
#ifndef CLIENT_H
#define CLIENT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BYTES = 20 };

static inline int64_t now_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* Measures batches until standard input ends. `exchange` returns false if a call fails. */
static inline bool measure_batches(bool (*exchange)(void *), void *context) {
    int count;
    while (scanf("%d", &count) == 1) {
        int64_t *durations = (int64_t *)malloc((size_t)count * sizeof *durations);
        if (durations == NULL) {
            return false;
        }
        /* The other programs have had their turns since, so the first tenth warms the caches. */
        for (int i = -count / 10; i < count; i++) {
            int64_t started = now_ns();
            if (!exchange(context)) {
                free(durations);
                return false;
            }
            durations[i < 0 ? 0 : i] = now_ns() - started;
        }
        for (int i = 0; i < count; i++) {
            printf("%lld ", (long long)durations[i]);
        }
        printf("\n");
        fflush(stdout);
        free(durations);
    }
    return true;
}

#endif
