// Timers of `timer_create`, which send a signal or call a function.

#include "sim.h"

#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#define MOST_TIMERS 1024

struct posix_timer {
    bool used;
    clockid_t clock;
    struct sigevent event;
    struct schedule schedule;
    // How often it had expired before it was last told.
    int overrun;
};

static struct posix_timer timers[MOST_TIMERS];
// All timers are among the first `slots`.
static int slots;

// What programs hold: never null, and no pointer.
static timer_t handle_of(int index) {
    return (timer_t)(uintptr_t)(index + 1);
}

static struct posix_timer *timer_of(timer_t handle) {
    uintptr_t number = (uintptr_t)handle;
    struct posix_timer *timer = number >= 1 && number <= (uintptr_t)slots ? &timers[number - 1] : NULL;
    if (timer != NULL && timer->used) return timer;
    errno = EINVAL;
    return NULL;
}

static void *call(void *argument) {
    struct posix_timer *timer = argument;
    timer->event.sigev_notify_function(timer->event.sigev_value);
    return NULL;
}

static void tell(struct posix_timer *timer, int index) {
    pthread_t thread;
    pthread_attr_t detached;
    switch (timer->event.sigev_notify) {
    case SIGEV_THREAD:
        pthread_attr_init(&detached);
        pthread_attr_setdetachstate(&detached, PTHREAD_CREATE_DETACHED);
        pthread_create(&thread, &detached, call, timer);
        pthread_attr_destroy(&detached);
        break;
    case SIGEV_SIGNAL:
    case SIGEV_THREAD_ID: {
        siginfo_t info = {.si_signo = timer->event.sigev_signo, .si_code = SI_TIMER};
        info.si_value = timer->event.sigev_value;
        info.si_timerid = index;
        info.si_overrun = timer->overrun;
        bool to_thread = timer->event.sigev_notify == SIGEV_THREAD_ID;
        pid_t process = getpid();
        // Noted first, because the thread may handle the signal at once.
        if (!to_thread) sim_interrupt_first();
        if (to_thread) {
            sim_call(SYS_rt_tgsigqueueinfo, process, timer->event._sigev_un._tid, info.si_signo, &info);
        } else {
            sim_call(SYS_rt_sigqueueinfo, process, info.si_signo, &info);
        }
        break;
    }
    default:
        break;
    }
}

instant sim_expire_posix_timers(void) {
    instant first = NEVER;
    for (int i = 0; i < slots; i++) {
        struct posix_timer *timer = &timers[i];
        if (!timer->used) continue;
        uint64_t count = sim_expire(&timer->schedule);
        if (count > 0) {
            timer->overrun = count > INT_MAX ? INT_MAX : (int)(count - 1);
            tell(timer, i);
        }
        if (timer->schedule.due < first) first = timer->schedule.due;
    }
    return first;
}

EXPORT int timer_create(clockid_t clock, struct sigevent *restrict event, timer_t *restrict handle) {
    if (!sim_takes_part() || !sim_follows(clock)) return REAL(timer_create)(clock, event, handle);
    for (int i = 0; i < MOST_TIMERS; i++) {
        if (timers[i].used) continue;
        timers[i] = (struct posix_timer){.used = true, .clock = clock, .schedule = {.due = NEVER}};
        if (event != NULL) {
            timers[i].event = *event;
        } else {
            timers[i].event.sigev_notify = SIGEV_SIGNAL;
            timers[i].event.sigev_signo = SIGALRM;
            timers[i].event.sigev_value.sival_int = i + 1;
        }
        if (i >= slots) slots = i + 1;
        *handle = handle_of(i);
        return 0;
    }
    errno = EAGAIN;
    return -1;
}

EXPORT int timer_settime(timer_t handle, int flags, const struct itimerspec *restrict next,
                         struct itimerspec *restrict before) {
    if (!sim_takes_part()) return REAL(timer_settime)(handle, flags, next, before);
    struct posix_timer *timer = timer_of(handle);
    if (timer == NULL) return -1;
    struct itimerspec left = sim_left(&timer->schedule);
    if (!sim_set_schedule(&timer->schedule, timer->clock, (flags & TIMER_ABSTIME) != 0, next)) return -1;
    if (before != NULL) *before = left;
    timer->overrun = 0;
    return 0;
}

EXPORT int timer_gettime(timer_t handle, struct itimerspec *left) {
    if (!sim_takes_part()) return REAL(timer_gettime)(handle, left);
    struct posix_timer *timer = timer_of(handle);
    if (timer == NULL) return -1;
    *left = sim_left(&timer->schedule);
    return 0;
}

EXPORT int timer_getoverrun(timer_t handle) {
    if (!sim_takes_part()) return REAL(timer_getoverrun)(handle);
    struct posix_timer *timer = timer_of(handle);
    return timer == NULL ? -1 : timer->overrun;
}

EXPORT int timer_delete(timer_t handle) {
    if (!sim_takes_part()) return REAL(timer_delete)(handle);
    struct posix_timer *timer = timer_of(handle);
    if (timer == NULL) return -1;
    timer->used = false;
    return 0;
}
