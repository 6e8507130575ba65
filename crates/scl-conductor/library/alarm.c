// The timer that sends SIGALRM: `alarm`, and `setitimer` in real time. The program's first thread handles the signal.

#include "sim.h"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#define SECOND UINT64_C(1000000000)

static struct schedule schedule = {.due = NEVER};

instant sim_expire_alarm(void) {
    if (sim_expire(&schedule) > 0) {
        // Noted first, because the thread may handle the signal at once.
        sim_interrupt_first();
        sim_call(SYS_kill, getpid(), SIGALRM);
    }
    return schedule.due;
}

static struct timeval timeval_of(uint64_t nanoseconds) {
    struct timespec time = sim_timespec(nanoseconds);
    return (struct timeval){.tv_sec = time.tv_sec, .tv_usec = time.tv_nsec / 1000};
}

static uint64_t nanoseconds_of(const struct timeval *time) {
    return (uint64_t)time->tv_sec * SECOND + (uint64_t)time->tv_usec * 1000;
}

static bool is_valid(const struct timeval *time) {
    return time->tv_sec >= 0 && time->tv_usec >= 0 && time->tv_usec < 1000000;
}

static struct itimerval left(void) {
    instant now = sim_now();
    // A timer that is due is not one that is off.
    uint64_t time = schedule.due == NEVER ? 0 : schedule.due > now + 1000 ? schedule.due - now : 1000;
    return (struct itimerval){.it_value = timeval_of(time), .it_interval = timeval_of(schedule.period)};
}

EXPORT int getitimer(__itimer_which_t which, struct itimerval *value) {
    if (!sim_takes_part() || which != ITIMER_REAL) return (int)sim_call(SYS_getitimer, which, value);
    *value = left();
    return 0;
}

EXPORT int setitimer(__itimer_which_t which, const struct itimerval *restrict next, struct itimerval *restrict before) {
    if (!sim_takes_part() || which != ITIMER_REAL) return (int)sim_call(SYS_setitimer, which, next, before);
    if (next != NULL && !(is_valid(&next->it_value) && is_valid(&next->it_interval))) {
        errno = EINVAL;
        return -1;
    }
    if (before != NULL) *before = left();
    uint64_t first = next == NULL ? 0 : nanoseconds_of(&next->it_value);
    schedule.period = next == NULL ? 0 : nanoseconds_of(&next->it_interval);
    schedule.due = first == 0 ? NEVER : sim_now() + first;
    return 0;
}

EXPORT unsigned alarm(unsigned seconds) {
    struct itimerval before = {0};
    const struct itimerval next = {.it_value = {.tv_sec = seconds}};
    setitimer(ITIMER_REAL, &next, &before);
    // A part of a second counts as one, so that it is not taken for no alarm.
    return (unsigned)before.it_value.tv_sec + (before.it_value.tv_usec > 0);
}
