// Locks and semaphores of the C library. One that is free is taken by the C library's own function; whoever frees one
// wakes a thread that waits for it.

#include "sim.h"

#include <pthread.h>
#include <semaphore.h>

// Waits until `address` is free, perhaps. Returns false if the time is over.
static bool wait_for(const void *address, instant deadline) {
    struct wait wait = {.address = address, .bits = ALL_BITS, .deadline = deadline};
    return sim_wait(&wait) != TIMED_OUT;
}

// Repeats what fails with `busy` while the lock is taken.
#define TAKE(attempt, busy, address, deadline)                     \
    for (;;) {                                                     \
        int error = attempt;                                       \
        if (error != busy) return error;                           \
        if (!wait_for(address, deadline)) return ETIMEDOUT;        \
    }

static int take_mutex(pthread_mutex_t *mutex, instant deadline) {
    TAKE(REAL(pthread_mutex_trylock)(mutex), EBUSY, mutex, deadline)
}

EXPORT int pthread_mutex_lock(pthread_mutex_t *mutex) {
    return sim_takes_part() ? take_mutex(mutex, NEVER) : REAL(pthread_mutex_lock)(mutex);
}

EXPORT int pthread_mutex_timedlock(pthread_mutex_t *restrict mutex, const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(pthread_mutex_timedlock)(mutex, until);
    return take_mutex(mutex, sim_instant(CLOCK_REALTIME, until));
}

EXPORT int pthread_mutex_clocklock(pthread_mutex_t *restrict mutex, clockid_t clock,
                                   const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(pthread_mutex_clocklock)(mutex, clock, until);
    return take_mutex(mutex, sim_instant(clock, until));
}

EXPORT int pthread_mutex_unlock(pthread_mutex_t *mutex) {
    int error = REAL(pthread_mutex_unlock)(mutex);
    if (sim_takes_part()) sim_wake(mutex, ALL_BITS, 1);
    return error;
}

static int take_to_read(pthread_rwlock_t *lock, instant deadline) {
    TAKE(REAL(pthread_rwlock_tryrdlock)(lock), EBUSY, lock, deadline)
}

static int take_to_write(pthread_rwlock_t *lock, instant deadline) {
    TAKE(REAL(pthread_rwlock_trywrlock)(lock), EBUSY, lock, deadline)
}

EXPORT int pthread_rwlock_rdlock(pthread_rwlock_t *lock) {
    return sim_takes_part() ? take_to_read(lock, NEVER) : REAL(pthread_rwlock_rdlock)(lock);
}

EXPORT int pthread_rwlock_wrlock(pthread_rwlock_t *lock) {
    return sim_takes_part() ? take_to_write(lock, NEVER) : REAL(pthread_rwlock_wrlock)(lock);
}

EXPORT int pthread_rwlock_timedrdlock(pthread_rwlock_t *restrict lock, const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(pthread_rwlock_timedrdlock)(lock, until);
    return take_to_read(lock, sim_instant(CLOCK_REALTIME, until));
}

EXPORT int pthread_rwlock_timedwrlock(pthread_rwlock_t *restrict lock, const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(pthread_rwlock_timedwrlock)(lock, until);
    return take_to_write(lock, sim_instant(CLOCK_REALTIME, until));
}

EXPORT int pthread_rwlock_unlock(pthread_rwlock_t *lock) {
    int error = REAL(pthread_rwlock_unlock)(lock);
    if (sim_takes_part()) sim_wake(lock, ALL_BITS, INT_MAX);
    return error;
}

static int take_semaphore(sem_t *semaphore, instant deadline) {
    TAKE(REAL(sem_trywait)(semaphore) == 0 ? 0 : errno, EAGAIN, semaphore, deadline)
}

static int by_errno(int error) {
    if (error == 0) return 0;
    errno = error;
    return -1;
}

EXPORT int sem_wait(sem_t *semaphore) {
    return sim_takes_part() ? by_errno(take_semaphore(semaphore, NEVER)) : REAL(sem_wait)(semaphore);
}

EXPORT int sem_timedwait(sem_t *restrict semaphore, const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(sem_timedwait)(semaphore, until);
    return by_errno(take_semaphore(semaphore, sim_instant(CLOCK_REALTIME, until)));
}

EXPORT int sem_clockwait(sem_t *restrict semaphore, clockid_t clock, const struct timespec *restrict until) {
    if (!sim_takes_part()) return REAL(sem_clockwait)(semaphore, clock, until);
    return by_errno(take_semaphore(semaphore, sim_instant(clock, until)));
}

EXPORT int sem_post(sem_t *semaphore) {
    int result = REAL(sem_post)(semaphore);
    if (sim_takes_part()) sim_wake(semaphore, ALL_BITS, 1);
    return result;
}
