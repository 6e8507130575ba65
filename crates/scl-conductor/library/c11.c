// The threads of C11, which the C library keeps in the same memory as those of POSIX.

#include "sim.h"

#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <threads.h>
#include <unistd.h>

_Static_assert(sizeof(mtx_t) == sizeof(pthread_mutex_t) && sizeof(cnd_t) == sizeof(pthread_cond_t), "the same memory");

struct start {
    thrd_start_t routine;
    void *argument;
};

static int result_of(int error) {
    switch (error) {
    case 0:
        return thrd_success;
    case ETIMEDOUT:
        return thrd_timedout;
    case EAGAIN:
    case ENOMEM:
        return thrd_nomem;
    default:
        return thrd_error;
    }
}

static void *begin(void *argument) {
    struct start start = *(struct start *)argument;
    free(argument);
    return (void *)(intptr_t)start.routine(start.argument);
}

EXPORT int thrd_create(thrd_t *id, thrd_start_t routine, void *argument) {
    if (!sim_takes_part()) return REAL(thrd_create)(id, routine, argument);
    struct start *start = malloc(sizeof *start);
    if (start == NULL) return thrd_nomem;
    *start = (struct start){.routine = routine, .argument = argument};
    int error = pthread_create(id, NULL, begin, start);
    if (error != 0) free(start);
    return result_of(error);
}

EXPORT int thrd_join(thrd_t id, int *result) {
    if (!sim_takes_part()) return REAL(thrd_join)(id, result);
    void *returned;
    int error = pthread_join(id, &returned);
    if (error == 0 && result != NULL) *result = (int)(intptr_t)returned;
    return result_of(error);
}

EXPORT int thrd_sleep(const struct timespec *duration, struct timespec *left) {
    if (!sim_takes_part()) return REAL(thrd_sleep)(duration, left);
    if (nanosleep(duration, left) == 0) return 0;
    return errno == EINTR ? -1 : -2;
}

EXPORT void thrd_yield(void) {
    sched_yield();
}

EXPORT int mtx_lock(mtx_t *mutex) {
    return result_of(pthread_mutex_lock((pthread_mutex_t *)mutex));
}

EXPORT int mtx_timedlock(mtx_t *restrict mutex, const struct timespec *restrict until) {
    return result_of(pthread_mutex_timedlock((pthread_mutex_t *)mutex, until));
}

EXPORT int mtx_unlock(mtx_t *mutex) {
    return result_of(pthread_mutex_unlock((pthread_mutex_t *)mutex));
}

EXPORT int cnd_wait(cnd_t *condition, mtx_t *mutex) {
    return result_of(pthread_cond_wait((pthread_cond_t *)condition, (pthread_mutex_t *)mutex));
}

EXPORT int cnd_timedwait(cnd_t *restrict condition, mtx_t *restrict mutex, const struct timespec *restrict until) {
    return result_of(pthread_cond_timedwait((pthread_cond_t *)condition, (pthread_mutex_t *)mutex, until));
}

EXPORT int cnd_signal(cnd_t *condition) {
    return result_of(pthread_cond_signal((pthread_cond_t *)condition));
}

EXPORT int cnd_broadcast(cnd_t *condition) {
    return result_of(pthread_cond_broadcast((pthread_cond_t *)condition));
}
