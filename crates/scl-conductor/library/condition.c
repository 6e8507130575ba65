// Condition variables of the C library. Their memory is not used: who waits for one is known here.

#include "sim.h"

#include <pthread.h>

static int wait_for(pthread_cond_t *condition, pthread_mutex_t *mutex, instant deadline) {
    // No other thread runs before this one waits.
    pthread_mutex_unlock(mutex);
    struct wait wait = {.address = condition, .bits = ALL_BITS, .deadline = deadline};
    enum reason reason = sim_wait(&wait);
    pthread_mutex_lock(mutex);
    return reason == TIMED_OUT ? ETIMEDOUT : 0;
}

// The C library keeps a condition's clock in the second bit of this member, since version 2.25.
static clockid_t clock_of(const pthread_cond_t *condition) {
    return (condition->__data.__wrefs & 2) == 0 ? CLOCK_REALTIME : CLOCK_MONOTONIC;
}

EXPORT int pthread_cond_wait(pthread_cond_t *restrict condition, pthread_mutex_t *restrict mutex) {
    return sim_takes_part() ? wait_for(condition, mutex, NEVER) : REAL(pthread_cond_wait)(condition, mutex);
}

EXPORT int pthread_cond_timedwait(pthread_cond_t *restrict condition, pthread_mutex_t *restrict mutex,
                                  const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(pthread_cond_timedwait)(condition, mutex, until);
    return wait_for(condition, mutex, sim_instant(clock_of(condition), until));
}

EXPORT int pthread_cond_clockwait(pthread_cond_t *restrict condition, pthread_mutex_t *restrict mutex, clockid_t clock,
                                  const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(pthread_cond_clockwait)(condition, mutex, clock, until);
    return wait_for(condition, mutex, sim_instant(clock, until));
}

EXPORT int pthread_cond_signal(pthread_cond_t *condition) {
    if (!sim_takes_part()) return REAL(pthread_cond_signal)(condition);
    sim_wake(condition, ALL_BITS, 1);
    return 0;
}

EXPORT int pthread_cond_broadcast(pthread_cond_t *condition) {
    if (!sim_takes_part()) return REAL(pthread_cond_broadcast)(condition);
    sim_wake(condition, ALL_BITS, INT_MAX);
    return 0;
}
