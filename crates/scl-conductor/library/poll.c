// Waiting for descriptors.

#include "sim.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

static instant after_milliseconds(int timeout) {
    if (timeout < 0) return NEVER;
    const struct timespec duration = {.tv_sec = timeout / 1000, .tv_nsec = (timeout % 1000) * 1000000L};
    return sim_after(&duration);
}

// A wait whose attempt is a system call that returns how many descriptors are ready.
struct descriptors {
    struct wait wait;
    // The call, with this mask of signals, without waiting.
    long (*call)(struct descriptors *of, const sigset_t *mask);
    long result;
    int error;
    int descriptor;
    struct epoll_event *events;
    struct pollfd *polled;
    size_t count;
    fd_set *sets[3];
    fd_set wanted[3];
};

static bool attempt(struct wait *wait) {
    struct descriptors *of = (struct descriptors *)wait;
    of->result = of->call(of, NULL);
    of->error = errno;
    return of->result != 0;
}

// Waits until a descriptor is ready, with this mask of signals.
static int wait_for(struct descriptors *of, instant deadline, const sigset_t *mask) {
    // With the mask, so that a signal that is pending ends the wait.
    int ready = (int)of->call(of, mask);
    if (ready != 0 || deadline <= sim_now()) {
        sim_pass();
        return ready;
    }
    of->wait.attempt = attempt;
    of->wait.deadline = deadline;
    of->wait.interruptible = true;
    of->wait.attempted = true;
    sigset_t before;
    if (mask != NULL) pthread_sigmask(SIG_SETMASK, mask, &before);
    enum reason reason = sim_wait(&of->wait);
    if (mask != NULL) pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (reason == TIMED_OUT) return 0;
    errno = reason == INTERRUPTED ? EINTR : of->error;
    return reason == INTERRUPTED ? -1 : (int)of->result;
}

static instant after(const struct timespec *timeout) {
    return timeout == NULL ? NEVER : sim_after(timeout);
}

static long call_epoll(struct descriptors *of, const sigset_t *mask) {
    return sim_call(SYS_epoll_pwait, of->descriptor, of->events, of->count, 0, mask, MASK);
}

static void watch_epoll(struct wait *wait) {
    sim_watch_epoll(((struct descriptors *)wait)->descriptor);
}

static struct descriptors of_epoll(int epoll, struct epoll_event *events, int most) {
    return (struct descriptors){
        .wait = {.watch = watch_epoll},
        .call = call_epoll,
        .descriptor = epoll,
        .events = events,
        .count = (size_t)most,
    };
}

EXPORT int epoll_pwait(int epoll, struct epoll_event *events, int most, int timeout, const sigset_t *mask) {
    if (!sim_takes_part()) return (int)sim_call(SYS_epoll_pwait, epoll, events, most, timeout, mask, MASK);
    struct descriptors of = of_epoll(epoll, events, most);
    return wait_for(&of, after_milliseconds(timeout), mask);
}

EXPORT int epoll_wait(int epoll, struct epoll_event *events, int most, int timeout) {
    return epoll_pwait(epoll, events, most, timeout, NULL);
}

EXPORT int epoll_pwait2(int epoll, struct epoll_event *events, int most, const struct timespec *timeout,
                        const sigset_t *mask) {
    if (!sim_takes_part()) return (int)sim_call(SYS_epoll_pwait2, epoll, events, most, timeout, mask, MASK);
    struct descriptors of = of_epoll(epoll, events, most);
    return wait_for(&of, after(timeout), mask);
}

static long call_poll(struct descriptors *of, const sigset_t *mask) {
    struct timespec none = {0};
    return sim_call(SYS_ppoll, of->polled, of->count, &none, mask, MASK);
}

static void watch_poll(struct wait *wait) {
    struct descriptors *of = (struct descriptors *)wait;
    for (size_t i = 0; i < of->count; i++) {
        if (of->polled[i].fd >= 0) sim_watch(of->polled[i].fd, of->polled[i].events);
    }
}

static int wait_for_poll(struct pollfd *polled, nfds_t count, instant deadline, const sigset_t *mask) {
    struct descriptors of = {.wait = {.watch = watch_poll}, .call = call_poll, .polled = polled, .count = count};
    return wait_for(&of, deadline, mask);
}

EXPORT int poll(struct pollfd *polled, nfds_t count, int timeout) {
    if (!sim_takes_part()) return REAL(poll)(polled, count, timeout);
    return wait_for_poll(polled, count, after_milliseconds(timeout), NULL);
}

EXPORT int ppoll(struct pollfd *polled, nfds_t count, const struct timespec *timeout, const sigset_t *mask) {
    if (!sim_takes_part()) return REAL(ppoll)(polled, count, timeout, mask);
    return wait_for_poll(polled, count, after(timeout), mask);
}

static long call_select(struct descriptors *of, const sigset_t *mask) {
    for (int i = 0; i < 3; i++) {
        if (of->sets[i] != NULL) *of->sets[i] = of->wanted[i];
    }
    struct timespec none = {0};
    struct {
        const sigset_t *mask;
        size_t size;
    } masked = {mask, MASK};
    return sim_call(SYS_pselect6, of->count, of->sets[0], of->sets[1], of->sets[2], &none, &masked);
}

static void watch_select(struct wait *wait) {
    struct descriptors *of = (struct descriptors *)wait;
    static const short events[] = {POLLIN, POLLOUT, POLLPRI};
    for (size_t descriptor = 0; descriptor < of->count; descriptor++) {
        short wanted = 0;
        for (int i = 0; i < 3; i++) {
            if (of->sets[i] != NULL && FD_ISSET(descriptor, &of->wanted[i])) wanted |= events[i];
        }
        if (wanted != 0) sim_watch((int)descriptor, wanted);
    }
}

static int wait_for_select(int count, fd_set *sets[3], instant deadline, const sigset_t *mask) {
    struct descriptors of = {.wait = {.watch = watch_select}, .call = call_select, .count = (size_t)count};
    for (int i = 0; i < 3; i++) {
        of.sets[i] = sets[i];
        if (sets[i] != NULL) of.wanted[i] = *sets[i];
    }
    return wait_for(&of, deadline, mask);
}

EXPORT int select(int count, fd_set *read, fd_set *write, fd_set *except, struct timeval *timeout) {
    if (!sim_takes_part()) return REAL(select)(count, read, write, except, timeout);
    instant deadline = NEVER;
    if (timeout != NULL) {
        const struct timespec duration = {.tv_sec = timeout->tv_sec, .tv_nsec = timeout->tv_usec * 1000};
        deadline = sim_after(&duration);
    }
    return wait_for_select(count, (fd_set *[]){read, write, except}, deadline, NULL);
}

EXPORT int pselect(int count, fd_set *read, fd_set *write, fd_set *except, const struct timespec *timeout,
                   const sigset_t *mask) {
    if (!sim_takes_part()) return REAL(pselect)(count, read, write, except, timeout, mask);
    return wait_for_select(count, (fd_set *[]){read, write, except}, after(timeout), mask);
}

bool sim_wait_for_descriptor(int descriptor, short events) {
    if (!sim_takes_part()) return true;
    int before = errno;
    // Errors are left to the call that follows.
    int flags = (int)sim_call(SYS_fcntl, descriptor, F_GETFL);
    struct pollfd polled = {.fd = descriptor, .events = events};
    int ready = flags < 0 || (flags & O_NONBLOCK) != 0 ? 1 : wait_for_poll(&polled, 1, NEVER, NULL);
    errno = ready < 0 ? errno : before;
    return ready >= 0;
}

EXPORT ssize_t read(int descriptor, void *buffer, size_t length) {
    return sim_wait_for_descriptor(descriptor, POLLIN) ? REAL(read)(descriptor, buffer, length) : -1;
}

EXPORT ssize_t readv(int descriptor, const struct iovec *buffers, int count) {
    return sim_wait_for_descriptor(descriptor, POLLIN) ? REAL(readv)(descriptor, buffers, count) : -1;
}

static bool wait_for_socket(int socket, int flags) {
    return (flags & MSG_DONTWAIT) != 0 || sim_wait_for_descriptor(socket, POLLIN);
}

EXPORT ssize_t recv(int socket, void *buffer, size_t length, int flags) {
    return wait_for_socket(socket, flags) ? REAL(recv)(socket, buffer, length, flags) : -1;
}

EXPORT ssize_t recvfrom(int socket, void *restrict buffer, size_t length, int flags, struct sockaddr *restrict from,
                        socklen_t *restrict from_length) {
    if (!wait_for_socket(socket, flags)) return -1;
    return REAL(recvfrom)(socket, buffer, length, flags, from, from_length);
}

EXPORT ssize_t recvmsg(int socket, struct msghdr *message, int flags) {
    return wait_for_socket(socket, flags) ? REAL(recvmsg)(socket, message, flags) : -1;
}

EXPORT int accept(int socket, struct sockaddr *restrict from, socklen_t *restrict length) {
    return sim_wait_for_descriptor(socket, POLLIN) ? REAL(accept)(socket, from, length) : -1;
}

EXPORT int accept4(int socket, struct sockaddr *restrict from, socklen_t *restrict length, int flags) {
    return sim_wait_for_descriptor(socket, POLLIN) ? REAL(accept4)(socket, from, length, flags) : -1;
}
