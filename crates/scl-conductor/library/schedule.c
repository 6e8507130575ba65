// When timers expire.

#include "sim.h"

bool sim_set_schedule(struct schedule *schedule, clockid_t clock, bool absolute, const struct itimerspec *next) {
    const struct timespec *first = &next->it_value;
    if (!sim_is_duration(first) || !sim_is_duration(&next->it_interval)) {
        errno = EINVAL;
        return false;
    }
    schedule->period = sim_nanoseconds(&next->it_interval);
    schedule->due = absolute ? sim_instant(clock, first) : sim_after(first);
    if (first->tv_sec == 0 && first->tv_nsec == 0) schedule->due = NEVER;
    return true;
}

uint64_t sim_expire(struct schedule *schedule) {
    instant now = sim_now();
    if (schedule->due > now) return 0;
    uint64_t count = schedule->period == 0 ? 1 : 1 + (now - schedule->due) / schedule->period;
    schedule->due = schedule->period == 0 ? NEVER : schedule->due + count * schedule->period;
    return count;
}

struct itimerspec sim_left(const struct schedule *schedule) {
    struct itimerspec left = {.it_interval = sim_timespec(schedule->period)};
    instant now = sim_now();
    // A timer that is due is not one that is off.
    if (schedule->due != NEVER) left.it_value = sim_timespec(schedule->due > now ? schedule->due - now : 1);
    return left;
}
