// Futexes: the locks of Rust's standard library, and of all who have their own.

#include "sim.h"

#include <linux/futex.h>
#include <stdatomic.h>

static long wait_on(_Atomic uint32_t *address, uint32_t expected, instant deadline, uint32_t bits) {
    if (atomic_load(address) != expected) {
        errno = EAGAIN;
        return -1;
    }
    struct wait wait = {.address = address, .bits = bits, .deadline = deadline, .interruptible = true};
    enum reason reason = sim_wait(&wait);
    if (reason == WOKEN) return 0;
    errno = reason == TIMED_OUT ? ETIMEDOUT : EINTR;
    return -1;
}

bool sim_call_futex(const long arguments[6], long *result) {
    int operation = (int)arguments[1];
    if ((operation & FUTEX_PRIVATE_FLAG) == 0) return false;
    clockid_t clock = (operation & FUTEX_CLOCK_REALTIME) == 0 ? CLOCK_MONOTONIC : CLOCK_REALTIME;
    _Atomic uint32_t *address = (_Atomic uint32_t *)arguments[0];
    uint32_t value = (uint32_t)arguments[2];
    const struct timespec *time = (const struct timespec *)arguments[3];
    int count = arguments[2] > INT_MAX || arguments[2] < 0 ? INT_MAX : (int)arguments[2];
    switch (operation & FUTEX_CMD_MASK) {
    case FUTEX_WAIT:
        *result = wait_on(address, value, time == NULL ? NEVER : sim_after(time), ALL_BITS);
        return true;
    case FUTEX_WAIT_BITSET:
        *result = wait_on(address, value, time == NULL ? NEVER : sim_instant(clock, time), (uint32_t)arguments[5]);
        return true;
    case FUTEX_WAKE:
        *result = sim_wake((const void *)address, ALL_BITS, count);
        return true;
    case FUTEX_WAKE_BITSET:
        *result = sim_wake((const void *)address, (uint32_t)arguments[5], count);
        return true;
    default:
        return false;
    }
}
