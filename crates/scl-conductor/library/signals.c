// Waiting for signals.

#include "sim.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

static int wait_for_handler(void) {
    struct wait wait = {.deadline = NEVER, .interruptible = true};
    sim_wait(&wait);
    errno = EINTR;
    return -1;
}

EXPORT int pause(void) {
    return sim_takes_part() ? wait_for_handler() : REAL(pause)();
}

EXPORT int sigsuspend(const sigset_t *mask) {
    if (!sim_takes_part()) return REAL(sigsuspend)(mask);
    sigset_t before, pending;
    // One that is pending is handled as soon as it is no longer blocked.
    bool handled = false;
    sigpending(&pending);
    for (int signal = 1; signal < _NSIG; signal++) {
        handled |= sigismember(&pending, signal) == 1 && sigismember(mask, signal) == 0;
    }
    pthread_sigmask(SIG_SETMASK, mask, &before);
    if (!handled) wait_for_handler();
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = EINTR;
    return -1;
}

struct signals {
    struct wait wait;
    const sigset_t *set;
    siginfo_t *found;
    int signal;
};

static bool attempt(struct wait *wait) {
    struct signals *of = (struct signals *)wait;
    of->signal = (int)sim_call(SYS_rt_sigtimedwait, of->set, of->found, &(struct timespec){0}, MASK);
    return of->signal > 0;
}

static int wait_for_signal(const sigset_t *set, siginfo_t *found, instant deadline) {
    struct signals of = {
        .wait = {.attempt = attempt, .deadline = deadline, .interruptible = true},
        .set = set,
        .found = found,
    };
    if (attempt(&of.wait)) return of.signal;
    enum reason reason = sim_wait(&of.wait);
    if (reason == READY) return of.signal;
    errno = reason == INTERRUPTED ? EINTR : EAGAIN;
    return -1;
}

EXPORT int sigtimedwait(const sigset_t *restrict set, siginfo_t *restrict found,
                        const struct timespec *restrict timeout) {
    if (!sim_takes_part()) return REAL(sigtimedwait)(set, found, timeout);
    return wait_for_signal(set, found, timeout == NULL ? NEVER : sim_after(timeout));
}

EXPORT int sigwaitinfo(const sigset_t *restrict set, siginfo_t *restrict found) {
    return sigtimedwait(set, found, NULL);
}

EXPORT int sigwait(const sigset_t *restrict set, int *restrict signal) {
    if (!sim_takes_part()) return REAL(sigwait)(set, signal);
    do *signal = wait_for_signal(set, NULL, NEVER);
    while (*signal < 0 && errno == EINTR);
    return *signal < 0 ? errno : 0;
}
