// Closing descriptors. Those by which the program takes part stay open, as if they were not there: some programs close
// all that they do not know.

#include "sim.h"

#include <unistd.h>

static bool is_seat(int descriptor) {
    for (int i = 0; i < SEAT_DESCRIPTORS; i++) {
        if (sim_seat()[i] == descriptor) return true;
    }
    return false;
}

static void forget(unsigned first, unsigned last) {
    sim_forget_timers(first, last);
    sim_forget_watched(first, last);
}

// A child that shares the memory of its parent until it becomes another program closes its own descriptors only.
static bool takes_part_itself(void) {
    return sim_takes_part() && sim_is_own_process();
}

EXPORT int close(int descriptor) {
    if (takes_part_itself()) {
        if (is_seat(descriptor)) {
            errno = EBADF;
            return -1;
        }
        forget((unsigned)descriptor, (unsigned)descriptor);
    }
    return (int)sim_call(SYS_close, descriptor);
}

EXPORT int close_range(unsigned first, unsigned last, int flags) {
    if (!takes_part_itself()) return (int)sim_call(SYS_close_range, first, last, flags);
    if (flags == 0) forget(first, last);
    // What lies before, between and behind those that stay open, which are in order.
    unsigned from = first;
    for (int i = 0; i < SEAT_DESCRIPTORS; i++) {
        unsigned own = (unsigned)sim_seat()[i];
        if (own < from || own > last) continue;
        if (own > from && sim_call(SYS_close_range, from, own - 1, flags) < 0) return -1;
        from = own + 1;
    }
    return from > last ? 0 : (int)sim_call(SYS_close_range, from, last, flags);
}

EXPORT void closefrom(int first) {
    close_range(first < 0 ? 0 : (unsigned)first, UINT_MAX, 0);
}

EXPORT int dup3(int from, int to, int flags) {
    if (takes_part_itself() && is_seat(to)) {
        errno = EBUSY;
        return -1;
    }
    if (takes_part_itself() && from != to) forget((unsigned)to, (unsigned)to);
    return (int)sim_call(SYS_dup3, from, to, flags);
}

EXPORT int dup2(int from, int to) {
    // `dup3` refuses what `dup2` ignores.
    return from == to ? REAL(dup2)(from, to) : dup3(from, to, 0);
}
