// Sleeping.

#include "sim.h"

#include <unistd.h>

// Sleeps until an instant. Returns false if a signal came before.
static bool sleep_until(instant deadline) {
    struct wait wait = {.deadline = deadline, .interruptible = true};
    return sim_wait(&wait) != INTERRUPTED;
}

// Sleeps, and returns an error number, with what is left of the time.
static int sleep_for(const struct timespec *duration, struct timespec *left) {
    if (!sim_is_duration(duration)) return EINVAL;
    instant deadline = sim_after(duration);
    if (sleep_until(deadline)) return 0;
    if (left != NULL) *left = sim_timespec(deadline > sim_now() ? deadline - sim_now() : 0);
    return EINTR;
}

EXPORT int clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *left) {
    if (!sim_takes_part() || !sim_follows(clock)) return REAL(clock_nanosleep)(clock, flags, time, left);
    if ((flags & TIMER_ABSTIME) == 0) return sleep_for(time, left);
    if (time->tv_nsec < 0 || time->tv_nsec >= 1000000000) return EINVAL;
    return sleep_until(sim_instant(clock, time)) ? 0 : EINTR;
}

EXPORT int nanosleep(const struct timespec *duration, struct timespec *left) {
    if (!sim_takes_part()) return REAL(nanosleep)(duration, left);
    int error = sleep_for(duration, left);
    if (error == 0) return 0;
    errno = error;
    return -1;
}

EXPORT int usleep(useconds_t microseconds) {
    const struct timespec duration = {
        .tv_sec = microseconds / 1000000,
        .tv_nsec = (long)(microseconds % 1000000) * 1000,
    };
    return nanosleep(&duration, NULL);
}

EXPORT unsigned sleep(unsigned seconds) {
    struct timespec duration = {.tv_sec = seconds};
    return nanosleep(&duration, &duration) == 0 ? 0 : (unsigned)duration.tv_sec;
}
