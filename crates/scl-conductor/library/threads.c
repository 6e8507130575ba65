// The baton: of the program's threads, one runs at a time. So the order in which they act is the same in every run.

#include "sim.h"

#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

#define MOST_THREADS 4096
// How often a call may pass before the other threads run.
#define PASSES 64

struct thread {
    bool used;
    // Set when the thread gets the baton.
    _Atomic int go;
    // Whether it could run if it had the baton, and since when.
    bool runnable;
    uint64_t order;
    // What it waits for otherwise.
    struct wait *waiting;
    // Whether it has handled a signal since its wait began.
    _Atomic bool interrupted;
    pthread_t id;
    void *(*routine)(void *);
    void *argument;
    int rounds;
};

static struct thread threads[MOST_THREADS];
// All threads are among the first `slots`.
static int slots;
static __thread struct thread *self __attribute__((tls_model("initial-exec")));
static bool active;
static pthread_key_t ending;
// Numbers what happens to threads, in its order.
static uint64_t orders;
// How many waits have an address.
static int addressed;

bool sim_takes_part(void) {
    return active && self != NULL;
}

// A signal ends this wait only because it has a limit: it would go on after handlers with `SA_RESTART`.
static void wait_for_baton(void) {
    const struct timespec year = {.tv_sec = 31536000};
    while (!atomic_exchange(&self->go, 0)) {
        long result = sim_call(SYS_futex, &self->go, FUTEX_WAIT_PRIVATE, 0, &year, NULL, 0);
        if (result < 0 && errno == EINTR) sim_interrupt();
    }
}

static void give_baton(struct thread *next) {
    atomic_store(&next->go, 1);
    sim_call(SYS_futex, &next->go, FUTEX_WAKE_PRIVATE, 1, NULL, NULL, 0);
}

static void make_runnable(struct thread *thread) {
    thread->runnable = true;
    thread->order = ++orders;
}

static void end_wait(struct thread *thread, enum reason reason) {
    if (thread->waiting->address != NULL) addressed--;
    thread->waiting->reason = reason;
    thread->waiting = NULL;
    make_runnable(thread);
}

// Ends the waits that are over.
static void end_waits(void) {
    sim_expire_timers();
    instant now = sim_now();
    for (int i = 0; i < slots; i++) {
        struct wait *wait = threads[i].used ? threads[i].waiting : NULL;
        if (wait == NULL) continue;
        if (wait->woken) {
            end_wait(&threads[i], WOKEN);
        } else if (wait->attempt != NULL && !wait->attempted && wait->attempt(wait)) {
            end_wait(&threads[i], READY);
        } else if (wait->deadline <= now) {
            end_wait(&threads[i], TIMED_OUT);
        } else if (threads[i].interrupted && wait->interruptible) {
            end_wait(&threads[i], INTERRUPTED);
        }
        wait->attempted = false;
    }
}

// Returns the thread that has been runnable for the longest time. While there is none, time passes.
static struct thread *next_thread(void) {
    for (bool again = false;; again = true) {
        sim_begin_looking();
        end_waits();
        struct thread *next = NULL;
        for (int i = 0; i < slots; i++) {
            struct thread *thread = &threads[i];
            if (thread->used && thread->runnable && (next == NULL || thread->order < next->order)) next = thread;
        }
        if (next != NULL) {
            next->runnable = false;
            return next;
        }
        sim_take_turn(again);
    }
}

static void run_others(void) {
    struct thread *next = next_thread();
    if (next == self) return;
    give_baton(next);
    wait_for_baton();
}

enum reason sim_wait(struct wait *wait) {
    int before = errno;
    wait->woken = false;
    wait->order = ++orders;
    if (wait->address != NULL) addressed++;
    self->interrupted = false;
    self->waiting = wait;
    run_others();
    errno = before;
    return wait->reason;
}

void sim_yield(void) {
    int before = errno;
    make_runnable(self);
    run_others();
    errno = before;
}

void sim_pass(void) {
    static int passes;
    if (slots > 1 && ++passes % PASSES == 0) sim_yield();
}

int sim_wake(const void *address, uint32_t bits, int count) {
    int woken = 0;
    while (addressed > 0 && woken < count) {
        struct wait *oldest = NULL;
        for (int i = 0; i < slots; i++) {
            struct wait *wait = threads[i].used ? threads[i].waiting : NULL;
            if (wait == NULL || wait->woken || wait->address != address || (wait->bits & bits) == 0) continue;
            if (oldest == NULL || wait->order < oldest->order) oldest = wait;
        }
        if (oldest == NULL) break;
        oldest->woken = true;
        woken++;
    }
    // A signal handler may call this while all threads wait.
    if (woken > 0) sim_ask_for_turn();
    return woken;
}

void sim_interrupt(void) {
    if (self == NULL) return;
    self->interrupted = true;
    sim_ask_for_turn();
}

void sim_interrupt_first(void) {
    threads[0].interrupted = true;
}

instant sim_watch_waits(void) {
    instant first = NEVER;
    for (int i = 0; i < slots; i++) {
        struct wait *wait = threads[i].used ? threads[i].waiting : NULL;
        if (wait == NULL) continue;
        if (wait->watch != NULL) wait->watch(wait);
        if (wait->deadline < first) first = wait->deadline;
    }
    return first;
}

EXPORT int sched_yield(void) {
    if (!sim_takes_part()) return REAL(sched_yield)();
    sim_yield();
    return 0;
}

static struct thread *new_thread(void) {
    for (int i = 0; i < MOST_THREADS; i++) {
        if (threads[i].used) continue;
        if (i == slots) slots++;
        threads[i] = (struct thread){.used = true};
        return &threads[i];
    }
    return NULL;
}

static void *begin_thread(void *thread) {
    self = thread;
    sim_catch_direct_calls();
    pthread_setspecific(ending, thread);
    wait_for_baton();
    return self->routine(self->argument);
}

// Called after the destructors of thread-local values, and again after each round of those of keys, which may still
// wait. The last round gives the baton away for good.
static void end_thread(void *thread) {
    if (self != thread || !active) return;
    if (++self->rounds < PTHREAD_DESTRUCTOR_ITERATIONS) {
        pthread_setspecific(ending, thread);
        return;
    }
    self->used = false;
    sim_wake(self, ALL_BITS, INT_MAX);
    struct thread *next = next_thread();
    self = NULL;
    give_baton(next);
}

EXPORT int pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*routine)(void *), void *argument) {
    if (!sim_takes_part()) return REAL(pthread_create)(id, attributes, routine, argument);
    struct thread *thread = new_thread();
    if (thread == NULL) return EAGAIN;
    thread->routine = routine;
    thread->argument = argument;
    int error = REAL(pthread_create)(id, attributes, begin_thread, thread);
    if (error != 0) {
        thread->used = false;
        return error;
    }
    thread->id = *id;
    make_runnable(thread);
    return 0;
}

// Waits until a thread has ended, as far as the program can see. Returns false if the time is over before.
static bool wait_for_end(pthread_t id, instant deadline) {
    for (int i = 0; i < slots; i++) {
        if (!threads[i].used || &threads[i] == self || !pthread_equal(threads[i].id, id)) continue;
        struct wait wait = {.address = &threads[i], .bits = ALL_BITS, .deadline = deadline};
        return sim_wait(&wait) != TIMED_OUT;
    }
    return true;
}

EXPORT int pthread_join(pthread_t id, void **result) {
    if (sim_takes_part()) wait_for_end(id, NEVER);
    return REAL(pthread_join)(id, result);
}

EXPORT int pthread_clockjoin_np(pthread_t id, void **result, clockid_t clock, const struct timespec *until) {
    if (sim_takes_part() && !wait_for_end(id, sim_instant(clock, until))) return ETIMEDOUT;
    return REAL(pthread_join)(id, result);
}

EXPORT int pthread_timedjoin_np(pthread_t id, void **result, const struct timespec *until) {
    return pthread_clockjoin_np(id, result, CLOCK_REALTIME, until);
}

static void leave_in_child(void) {
    active = false;
    sim_leave();
}

__attribute__((constructor)) static void begin(void) {
    if (!sim_join()) return;
    self = new_thread();
    self->id = pthread_self();
    pthread_key_create(&ending, end_thread);
    pthread_setspecific(ending, self);
    pthread_atfork(NULL, NULL, leave_in_child);
    sim_catch_direct_calls();
    active = true;
}
