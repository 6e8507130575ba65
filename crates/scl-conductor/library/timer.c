// timerfd: the descriptor of a timer is an eventfd, which is read in the same way: how often it has expired.

#include "sim.h"

#include <fcntl.h>
#include <poll.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>

#define MOST_TIMERS 4096

struct timer {
    bool used;
    // The program's descriptor, and a copy of it, which stays valid if the program closes its own unseen.
    int descriptor;
    int own;
    clockid_t clock;
    struct schedule schedule;
};

static struct timer timers[MOST_TIMERS];
// All timers are among the first `slots`.
static int slots;

static struct timer *timer_of(int descriptor) {
    for (int i = 0; i < slots; i++) {
        if (timers[i].used && timers[i].descriptor == descriptor) return &timers[i];
    }
    return NULL;
}

void sim_forget_timers(unsigned first, unsigned last) {
    for (int i = 0; i < slots; i++) {
        unsigned descriptor = (unsigned)timers[i].descriptor;
        if (!timers[i].used || descriptor < first || descriptor > last) continue;
        timers[i].used = false;
        sim_call(SYS_close, timers[i].own);
    }
}

instant sim_expire_timers(void) {
    instant alarm = sim_expire_alarm(), posix = sim_expire_posix_timers();
    instant first = alarm < posix ? alarm : posix;
    for (int i = 0; i < slots; i++) {
        struct timer *timer = &timers[i];
        if (!timer->used) continue;
        uint64_t count = sim_expire(&timer->schedule);
        if (count > 0) sim_call(SYS_write, timer->own, &count, sizeof count);
        if (timer->schedule.due < first) first = timer->schedule.due;
    }
    return first;
}

EXPORT int timerfd_create(int clock, int flags) {
    if (!sim_takes_part() || !sim_follows(clock)) return REAL(timerfd_create)(clock, flags);
    for (int i = 0; i < MOST_TIMERS; i++) {
        if (timers[i].used) continue;
        // The flags of both have the values of `O_NONBLOCK` and `O_CLOEXEC`.
        int descriptor = eventfd(0, flags);
        if (descriptor < 0) return -1;
        int own = fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
        if (own < 0) {
            sim_call(SYS_close, descriptor);
            return -1;
        }
        own = sim_hide(own);
        timers[i] = (struct timer){
            .used = true, .descriptor = descriptor, .own = own, .clock = clock, .schedule = {.due = NEVER}};
        if (i >= slots) slots = i + 1;
        return descriptor;
    }
    errno = EMFILE;
    return -1;
}

EXPORT int timerfd_settime(int descriptor, int flags, const struct itimerspec *next, struct itimerspec *before) {
    struct timer *timer = sim_takes_part() ? timer_of(descriptor) : NULL;
    if (timer == NULL) return REAL(timerfd_settime)(descriptor, flags, next, before);
    struct itimerspec left = sim_left(&timer->schedule);
    if (!sim_set_schedule(&timer->schedule, timer->clock, (flags & TFD_TIMER_ABSTIME) != 0, next)) return -1;
    if (before != NULL) *before = left;
    // What has expired is forgotten.
    struct pollfd expired = {.fd = timer->own, .events = POLLIN};
    uint64_t count;
    if (sim_call(SYS_ppoll, &expired, 1, &(struct timespec){0}, NULL, 0) == 1) {
        sim_call(SYS_read, timer->own, &count, sizeof count);
    }
    return 0;
}

EXPORT int timerfd_gettime(int descriptor, struct itimerspec *left) {
    struct timer *timer = sim_takes_part() ? timer_of(descriptor) : NULL;
    if (timer == NULL) return REAL(timerfd_gettime)(descriptor, left);
    *left = sim_left(&timer->schedule);
    return 0;
}
