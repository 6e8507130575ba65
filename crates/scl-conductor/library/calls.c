// System calls by number: those that programs make with `syscall`, and those that they make without the C library.

#include "sim.h"

#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdarg.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/random.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/uio.h>
#include <unistd.h>

// A signal mask as the C library has it; it is longer than that of the kernel.
static const sigset_t *mask_of(const void *kernels, sigset_t *room) {
    if (kernels == NULL) return NULL;
    sigemptyset(room);
    memcpy(room, kernels, MASK);
    return room;
}

static long failed_with(int error) {
    if (error == 0) return 0;
    errno = error;
    return -1;
}

#define NUMBER(i) ((int)a[i])
#define POINTER(i) ((void *)a[i])

long sim_do(long number, const long a[6]) {
    sigset_t mask;
    switch (number) {
    case SYS_futex: {
        long result;
        if (sim_call_futex(a, &result)) return result;
        break;
    }
    case SYS_getrandom:
        return getrandom(POINTER(0), (size_t)a[1], (unsigned)a[2]);
    case SYS_clock_gettime:
        return clock_gettime(NUMBER(0), POINTER(1));
    case SYS_gettimeofday:
        return gettimeofday(POINTER(0), POINTER(1));
    case SYS_nanosleep:
        return nanosleep(POINTER(0), POINTER(1));
    case SYS_clock_nanosleep:
        return failed_with(clock_nanosleep(NUMBER(0), NUMBER(1), POINTER(2), POINTER(3)));
    case SYS_epoll_pwait:
        return epoll_pwait(NUMBER(0), POINTER(1), NUMBER(2), NUMBER(3), mask_of(POINTER(4), &mask));
    case SYS_epoll_pwait2:
        return epoll_pwait2(NUMBER(0), POINTER(1), NUMBER(2), POINTER(3), mask_of(POINTER(4), &mask));
    case SYS_ppoll:
        return ppoll(POINTER(0), (nfds_t)a[1], POINTER(2), mask_of(POINTER(3), &mask));
    case SYS_pselect6: {
        void *const *masked = POINTER(5);
        const sigset_t *set = masked == NULL ? NULL : mask_of(*masked, &mask);
        return pselect(NUMBER(0), POINTER(1), POINTER(2), POINTER(3), POINTER(4), set);
    }
    case SYS_rt_sigsuspend:
        return sigsuspend(mask_of(POINTER(0), &mask));
    case SYS_rt_sigtimedwait:
        return sigtimedwait(mask_of(POINTER(0), &mask), POINTER(1), POINTER(2));
    case SYS_timerfd_create:
        return timerfd_create(NUMBER(0), NUMBER(1));
    case SYS_timerfd_settime:
        return timerfd_settime(NUMBER(0), NUMBER(1), POINTER(2), POINTER(3));
    case SYS_timerfd_gettime:
        return timerfd_gettime(NUMBER(0), POINTER(1));
    case SYS_getitimer:
        return getitimer(NUMBER(0), POINTER(1));
    case SYS_setitimer:
        return setitimer(NUMBER(0), POINTER(1), POINTER(2));
    case SYS_sched_yield:
        return sched_yield();
    case SYS_read:
        return read(NUMBER(0), POINTER(1), (size_t)a[2]);
    case SYS_readv:
        return readv(NUMBER(0), POINTER(1), NUMBER(2));
    case SYS_recvfrom:
        return recvfrom(NUMBER(0), POINTER(1), (size_t)a[2], NUMBER(3), POINTER(4), POINTER(5));
    case SYS_recvmsg:
        return recvmsg(NUMBER(0), POINTER(1), NUMBER(2));
    case SYS_accept:
        return accept(NUMBER(0), POINTER(1), POINTER(2));
    case SYS_accept4:
        return accept4(NUMBER(0), POINTER(1), POINTER(2), NUMBER(3));
    case SYS_connect:
        return connect(NUMBER(0), POINTER(1), (socklen_t)a[2]);
    case SYS_close:
        return close(NUMBER(0));
    case SYS_close_range:
        return close_range((unsigned)a[0], (unsigned)a[1], NUMBER(2));
    case SYS_dup3:
        return dup3(NUMBER(0), NUMBER(1), NUMBER(2));
// What newer machines no longer have.
#ifdef SYS_poll
    case SYS_poll:
        return poll(POINTER(0), (nfds_t)a[1], NUMBER(2));
    case SYS_select:
        return select(NUMBER(0), POINTER(1), POINTER(2), POINTER(3), POINTER(4));
    case SYS_epoll_wait:
        return epoll_wait(NUMBER(0), POINTER(1), NUMBER(2), NUMBER(3));
    case SYS_time:
        return time(POINTER(0));
    case SYS_alarm:
        return alarm((unsigned)a[0]);
    case SYS_pause:
        return pause();
    case SYS_dup2:
        return dup2(NUMBER(0), NUMBER(1));
#endif
    default:
        break;
    }
    return sim_call(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

EXPORT long syscall(long number, ...) {
    va_list list;
    va_start(list, number);
    long a[6];
    for (int i = 0; i < 6; i++) a[i] = va_arg(list, long);
    va_end(list);
    return sim_takes_part() ? sim_do(number, a) : sim_call(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}
