// The time of the simulation.
//
// Looking at the clock takes time: a nanosecond, so that a loop that waits for the clock to move goes on, and a
// microsecond after the first thousand looks of a turn, so that a loop that waits for a time ends soon.

#include "sim.h"

#include <stdatomic.h>
#include <sys/time.h>

#define SECOND UINT64_C(1000000000)
// The simulation starts 1000 seconds after the machine.
#define SINCE_BOOT (UINT64_C(1000) * SECOND)
#define FAST_LOOKS 1000

static _Atomic instant now;
static _Atomic uint64_t looks;
static uint64_t wall_clock;

instant sim_now(void) {
    return now;
}

void sim_set_now(instant next) {
    if (next > now) now = next;
    looks = 0;
}

void sim_set_start(uint64_t start) {
    wall_clock = start;
}

static instant look(void) {
    return now += ++looks > FAST_LOOKS ? 1000 : 1;
}

bool sim_follows(clockid_t clock) {
    switch (clock) {
    case CLOCK_REALTIME:
    case CLOCK_REALTIME_COARSE:
    case CLOCK_TAI:
    case CLOCK_REALTIME_ALARM:
    case CLOCK_MONOTONIC:
    case CLOCK_MONOTONIC_RAW:
    case CLOCK_MONOTONIC_COARSE:
    case CLOCK_BOOTTIME:
    case CLOCK_BOOTTIME_ALARM:
        return true;
    default:
        return false;
    }
}

static uint64_t start_of(clockid_t clock) {
    switch (clock) {
    case CLOCK_REALTIME:
    case CLOCK_REALTIME_COARSE:
    case CLOCK_TAI:
    case CLOCK_REALTIME_ALARM:
        return wall_clock;
    default:
        return SINCE_BOOT;
    }
}

instant sim_instant(clockid_t clock, const struct timespec *time) {
    uint64_t start = start_of(clock);
    if (time->tv_sec < 0 || (uint64_t)time->tv_sec < start / SECOND) return 0;
    uint64_t seconds = (uint64_t)time->tv_sec - start / SECOND;
    return seconds >= NEVER / SECOND ? NEVER : seconds * SECOND + (uint64_t)time->tv_nsec;
}

instant sim_after(const struct timespec *duration) {
    if (duration->tv_sec < 0) return now;
    uint64_t seconds = (uint64_t)duration->tv_sec;
    if (seconds >= (NEVER - now) / SECOND) return NEVER;
    return now + seconds * SECOND + (uint64_t)duration->tv_nsec;
}

struct timespec sim_timespec(uint64_t nanoseconds) {
    return (struct timespec){.tv_sec = (time_t)(nanoseconds / SECOND), .tv_nsec = (long)(nanoseconds % SECOND)};
}

bool sim_is_duration(const struct timespec *duration) {
    return duration->tv_sec >= 0 && duration->tv_nsec >= 0 && duration->tv_nsec < (long)SECOND;
}

uint64_t sim_nanoseconds(const struct timespec *duration) {
    return (uint64_t)duration->tv_sec * SECOND + (uint64_t)duration->tv_nsec;
}

EXPORT int clock_gettime(clockid_t clock, struct timespec *time) {
    if (!sim_takes_part() || !sim_follows(clock)) return REAL(clock_gettime)(clock, time);
    *time = sim_timespec(start_of(clock) + look());
    return 0;
}

EXPORT int timespec_get(struct timespec *time, int base) {
    if (base != TIME_UTC) return 0;
    return clock_gettime(CLOCK_REALTIME, time) == 0 ? base : 0;
}

EXPORT int gettimeofday(struct timeval *restrict time, void *restrict zone) {
    if (!sim_takes_part()) return REAL(gettimeofday)(time, zone);
    struct timespec precise;
    clock_gettime(CLOCK_REALTIME, &precise);
    *time = (struct timeval){.tv_sec = precise.tv_sec, .tv_usec = precise.tv_nsec / 1000};
    return 0;
}

EXPORT time_t time(time_t *kept) {
    struct timespec precise;
    clock_gettime(CLOCK_REALTIME, &precise);
    if (kept != NULL) *kept = precise.tv_sec;
    return precise.tv_sec;
}
