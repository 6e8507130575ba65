// What the parts of the library share.
//
// The library takes the place of the C library's functions that wait or tell the time, in a program that
// `scl simulate` has started:
//
// - Of the program's threads, one runs at a time: the one that holds the baton (threads.c). A thread that has to wait
//   gives the baton to the next one that can go on.
// - When none can go on, the program is idle. It tells `scl simulate` so, and when it needs its next turn at the
//   latest, and waits for that turn, which brings the new time (turn.c).
//
// In all other processes, such as those that the program starts, the functions do what they always do.
#ifndef SCL_SIM_H
#define SCL_SIM_H

#define _GNU_SOURCE
#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <time.h>

#define EXPORT __attribute__((visibility("default")))

// The size of a signal mask of the kernel, in bytes.
#define MASK (_NSIG / 8)

// A time, in nanoseconds since the start of the simulation.
typedef uint64_t instant;
#define NEVER UINT64_MAX

// real.c: the C library's own functions.
#define REAL(name)                                                        \
    ({                                                                    \
        static typeof(&name) found;                                       \
        if (found == NULL) found = (typeof(&name))(uintptr_t)sim_real(#name); \
        found;                                                            \
    })
void *sim_real(const char *name);
// A system call: like `syscall`, which this library replaces.
long sim_call(long number, ...);

// threads.c: which thread runs.

// Why a wait is over.
enum reason { READY, WOKEN, TIMED_OUT, INTERRUPTED };

// A wait. Members that are not set do not end it, except `deadline`, which is always set.
struct wait {
    // Returns true if what the thread waits for has happened. Called by whichever thread holds the baton.
    bool (*attempt)(struct wait *wait);
    // Calls `sim_watch` for the descriptors that may end it.
    void (*watch)(struct wait *wait);
    // What `sim_wake` names, and of which any bit.
    const void *address;
    uint32_t bits;
    // When it ends at the latest.
    instant deadline;
    // Whether a signal ends it.
    bool interruptible;
    // Whether an attempt has just failed, and need not be repeated at once.
    bool attempted;
    bool woken;
    uint64_t order;
    enum reason reason;
};

// Returns true if the calling thread is one of a simulated program.
bool sim_takes_part(void);
// Waits while other threads run and time passes. Leaves `errno` as it is.
enum reason sim_wait(struct wait *wait);
// Lets the other threads run that can.
void sim_yield(void);
// As `sim_yield`, but only now and then: for calls that return at once and may be repeated forever.
void sim_pass(void);
// Ends the waits for an address and any of these bits, at most `count` and the oldest first. Returns their number.
int sim_wake(const void *address, uint32_t bits, int count);
#define ALL_BITS UINT32_MAX
// Notes that the calling thread has handled a signal.
void sim_interrupt(void);
// Notes that the program's first thread has, which the kernel prefers.
void sim_interrupt_first(void);
// Calls `watch` of all waits. Returns when the first of them ends at the latest.
instant sim_watch_waits(void);

// turn.c: the turns that `scl simulate` gives.

// Notes that the threads are about to be looked at. `sim_take_turn` does nothing if one asks for a turn from then on.
void sim_begin_looking(void);
// Says that the program is idle, and returns with its next turn. `again` says that no thread could run in the last one.
void sim_take_turn(bool again);
// Makes `scl simulate` give the program a turn when a descriptor is ready for these events of `poll`.
void sim_watch(int descriptor, short events);
// The same for something to read from an epoll descriptor, which stays watched until it is closed.
void sim_watch_epoll(int descriptor);
// Forgets that descriptors with these numbers are watched, which are closed.
void sim_forget_watched(unsigned first, unsigned last);
// Makes `scl simulate` give the program a turn although nothing it waits for has happened.
void sim_ask_for_turn(void);
// If `scl simulate` has started this process, returns true with its first turn.
bool sim_join(void);
// Gives a descriptor a number that the program does not use by itself, and returns it.
int sim_hide(int descriptor);
// The descriptors by which the program takes part, in order.
#define SEAT_DESCRIPTORS 3
const int *sim_seat(void);
// Returns false in a child that shares the memory of its parent until it becomes another program.
bool sim_is_own_process(void);
// Lets the process become another program that takes its part, or no longer.
void sim_keep_seat(bool keep);
// Ends the part that a forked child takes in the simulation of its parent.
void sim_leave(void);
// Returns true if the program says to what it connects.
bool sim_tells_connections(void);
#define CONNECTION_PATH 108
// Says that a socket has connected to another one with this path. Returns the socket to use instead, or -1.
int sim_tell_connection(int socket, const char path[CONNECTION_PATH]);

// clock.c: the time.

instant sim_now(void);
void sim_set_now(instant now);
// Sets what the wall clock shows at the start, in nanoseconds since 1970.
void sim_set_start(uint64_t start);
// Returns false for clocks that do not follow the simulation: those of the processor.
bool sim_follows(clockid_t clock);
instant sim_instant(clockid_t clock, const struct timespec *time);
// The instant that is this long from now, which the calling thread waits for.
instant sim_after(const struct timespec *duration);
struct timespec sim_timespec(uint64_t nanoseconds);
bool sim_is_duration(const struct timespec *duration);
uint64_t sim_nanoseconds(const struct timespec *duration);

// futex.c: locks.

// Returns false for what this library does not take the place of: futexes of several processes, and with priorities.
bool sim_call_futex(const long arguments[6], long *result);

// calls.c: system calls by number.

// Returns -1 and sets `errno` as `syscall` does.
long sim_do(long number, const long arguments[6]);

// direct.c: system calls without the C library.

// Lets the calling thread take part with such calls, too, where the machine offers that.
void sim_catch_direct_calls(void);

// random.c: random numbers.
void sim_seed(uint64_t seed);

// schedule.c: when timers expire.

struct schedule {
    // When it expires next, or `NEVER`.
    instant due;
    // How long after each time it expires again, unless that is 0.
    uint64_t period;
};
// Sets it as `timerfd_settime` and `timer_settime` do. Returns false and sets `errno` if these are no times.
bool sim_set_schedule(struct schedule *schedule, clockid_t clock, bool absolute, const struct itimerspec *next);
// Returns how often it has expired since the last call.
uint64_t sim_expire(struct schedule *schedule);
struct itimerspec sim_left(const struct schedule *schedule);

// timer.c: timerfd.

// Lets the timers expire that are due. Returns when the next one is.
instant sim_expire_timers(void);

// Forgets the timers with these descriptors, which are closed.
void sim_forget_timers(unsigned first, unsigned last);

// alarm.c: the same for the timer that sends SIGALRM.
instant sim_expire_alarm(void);

// posix_timer.c: the same for those of `timer_create`.
instant sim_expire_posix_timers(void);

// poll.c: waiting for descriptors.

// Before a call that blocks unless a descriptor is ready for these events: waits until it is. Returns false if a signal
// came first.
bool sim_wait_for_descriptor(int descriptor, short events);

#endif
