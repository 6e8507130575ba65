// The turns of the program: what it says to `scl simulate`, and what it hears. Both take turns strictly; the program
// begins.

#include "sim.h"

#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

// Its value: the format of the messages, the process, the socket, and the epoll descriptor that `scl simulate` watches.
#define VARIABLE "SCL_SIMULATION"
#define FORMAT 1

// Programs expect that the lowest numbers are free.
#define HIGH 500

// What the program says.
enum kind { WAITS, CONNECTS };

struct said {
    // The format, the kind from bit 16, and the process in the upper half.
    uint64_t head;
    // When the program has to have its next turn at the latest.
    instant due;
    // How far it has moved the time by looking at the clock.
    instant now;
};

struct heard {
    instant now;
    // Only in the first turn.
    uint64_t seed;
    // Whether the program was sent a signal, which it has handled by now.
    uint64_t signalled;
    // What the wall clock shows at the start of the simulation, in nanoseconds since 1970.
    uint64_t start;
    // Whether the program is to say to what it connects.
    uint64_t tells_connections;
};

static pid_t process;
// The three that follow, in order.
static int seat[SEAT_DESCRIPTORS] = {-1, -1, -1};
static int connection = -1;
static int watched = -1;
// Ready while the program asks for a turn although it is idle.
static int attention = -1;
static bool tells_connections;
static _Atomic bool idle;
static _Atomic bool asks;

// The descriptors that are watched, as far as they are still open.
static int *noted;
static size_t noted_count, noted_room;

// The epoll descriptors among them with low numbers. Only `close` closes those; others may be closed unseen.
#define LOW 1024
static bool watched_epolls[LOW];

static void note(int descriptor) {
    if (noted_count == noted_room) {
        noted_room = noted_room == 0 ? 64 : 2 * noted_room;
        noted = realloc(noted, noted_room * sizeof *noted);
        if (noted == NULL) abort();
    }
    noted[noted_count++] = descriptor;
}

static void unwatch_all(void) {
    for (size_t i = 0; i < noted_count; i++) {
        if (noted[i] != attention) sim_call(SYS_epoll_ctl, watched, EPOLL_CTL_DEL, noted[i], NULL);
    }
    noted_count = 0;
    memset(watched_epolls, 0, sizeof watched_epolls);
}

static void say(enum kind kind, instant due) {
    uint64_t head = FORMAT | (uint64_t)kind << 16 | (uint64_t)process << 32;
    struct said said = {.head = head, .due = due, .now = sim_now()};
    // Without `scl simulate`, the program cannot go on.
    if (sim_call(SYS_sendto, connection, &said, sizeof said, MSG_NOSIGNAL, NULL, 0) != sizeof said) _exit(126);
}

// Goes on after a call that has heard nothing, unless `scl simulate` is gone.
static void hear_nothing(long count) {
    if (count < 0 && errno == EINTR) {
        sim_interrupt();
    } else if (count == 0 || errno != EAGAIN) {
        _exit(126);
    }
}

// A signal ends `recv` only because the socket has a limit: it would go on after handlers with `SA_RESTART`.
static struct heard hear(void) {
    struct heard heard;
    size_t length = 0;
    while (length < sizeof heard) {
        char *rest = (char *)&heard + length;
        ssize_t count = sim_call(SYS_recvfrom, connection, rest, sizeof heard - length, 0, NULL, NULL);
        if (count > 0) {
            length += (size_t)count;
        } else {
            hear_nothing(count);
        }
    }
    return heard;
}

void sim_begin_looking(void) {
    asks = false;
}

void sim_watch(int descriptor, short events) {
    // The events of `poll` have the same values.
    struct epoll_event event = {.events = (uint32_t)(unsigned short)events};
    if (sim_call(SYS_epoll_ctl, watched, EPOLL_CTL_MOD, descriptor, &event) == 0) return;
    // It is new, or its number was used for another one before.
    if (sim_call(SYS_epoll_ctl, watched, EPOLL_CTL_ADD, descriptor, &event) == 0) note(descriptor);
}

void sim_watch_epoll(int descriptor) {
    bool low = descriptor >= 0 && descriptor < LOW;
    if (low && watched_epolls[descriptor]) return;
    sim_watch(descriptor, EPOLLIN);
    if (low) watched_epolls[descriptor] = true;
}

void sim_forget_watched(unsigned first, unsigned last) {
    for (unsigned number = first; number < LOW && number <= last; number++) watched_epolls[number] = false;
}

void sim_take_turn(bool again) {
    idle = true;
    if (!asks) {
        // The turn was of no use: a descriptor is ready for which no thread waits any longer.
        if (again) unwatch_all();
        instant wait = sim_watch_waits();
        instant timer = sim_expire_timers();
        say(WAITS, wait < timer ? wait : timer);
        struct heard heard = hear();
        sim_set_now(heard.now);
        if (heard.signalled != 0) sim_interrupt_first();
    }
    idle = false;
    uint64_t count;
    if (asks) sim_call(SYS_read, attention, &count, sizeof count);
}


void sim_ask_for_turn(void) {
    asks = true;
    if (!idle) return;
    int before = errno;
    const uint64_t one = 1;
    sim_call(SYS_write, attention, &one, sizeof one);
    errno = before;
}

int sim_hide(int descriptor) {
    int high = (int)sim_call(SYS_fcntl, descriptor, F_DUPFD_CLOEXEC, HIGH);
    if (high < 0) return descriptor;
    sim_call(SYS_close, descriptor);
    return high;
}

bool sim_join(void) {
    const char *value = getenv(VARIABLE);
    int format, owner, socket, epoll;
    if (value == NULL || sscanf(value, "%d,%d,%d,%d", &format, &owner, &socket, &epoll) != 4) return false;
    // The program's own children inherit the variable.
    if (format != FORMAT || owner != getpid()) return false;
    process = owner;
    connection = socket;
    watched = epoll;
    attention = sim_hide(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
    const int own[] = {connection, watched, attention};
    for (int i = 0; i < SEAT_DESCRIPTORS; i++) {
        fcntl(own[i], F_SETFD, FD_CLOEXEC);
        int at = i;
        for (; at > 0 && seat[at - 1] > own[i]; at--) seat[at] = seat[at - 1];
        seat[at] = own[i];
    }
    const struct timeval year = {.tv_sec = 31536000};
    setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &year, sizeof year);
    sim_watch(attention, EPOLLIN);
    say(WAITS, 0);
    struct heard heard = hear();
    sim_set_now(heard.now);
    sim_set_start(heard.start);
    sim_seed(heard.seed);
    tells_connections = heard.tells_connections != 0;
    return true;
}

bool sim_tells_connections(void) {
    return tells_connections;
}

// The message of a descriptor.
union descriptor_message {
    char buffer[CMSG_SPACE(sizeof(int))];
    struct cmsghdr header;
};

int sim_tell_connection(int socket, const char path[CONNECTION_PATH]) {
    say(CONNECTS, 0);
    union descriptor_message control = {.header = {
        .cmsg_len = CMSG_LEN(sizeof(int)),
        .cmsg_level = SOL_SOCKET,
        .cmsg_type = SCM_RIGHTS,
    }};
    memcpy(CMSG_DATA(&control.header), &socket, sizeof socket);
    struct iovec part = {.iov_base = (char *)(uintptr_t)path, .iov_len = CONNECTION_PATH};
    struct msghdr message = {
        .msg_iov = &part, .msg_iovlen = 1, .msg_control = &control, .msg_controllen = sizeof control};
    if (sim_call(SYS_sendmsg, connection, &message, MSG_NOSIGNAL) != CONNECTION_PATH) _exit(126);
    char answer;
    part = (struct iovec){.iov_base = &answer, .iov_len = sizeof answer};
    long count;
    while ((count = sim_call(SYS_recvmsg, connection, &message, MSG_CMSG_CLOEXEC)) <= 0) hear_nothing(count);
    struct cmsghdr *header = CMSG_FIRSTHDR(&message);
    if (header == NULL || header->cmsg_type != SCM_RIGHTS) return -1;
    int other;
    memcpy(&other, CMSG_DATA(header), sizeof other);
    return other;
}

bool sim_is_own_process(void) {
    return getpid() == process;
}

void sim_keep_seat(bool keep) {
    if (connection < 0 || !sim_is_own_process()) return;
    const int own[] = {connection, watched};
    for (int i = 0; i < 2; i++) sim_call(SYS_fcntl, own[i], F_SETFD, keep ? 0 : FD_CLOEXEC);
}

const int *sim_seat(void) {
    return seat;
}

void sim_leave(void) {
    for (int i = 0; i < SEAT_DESCRIPTORS; i++) sim_call(SYS_close, seat[i]);
}
