// Random numbers from the simulation's seed: hash maps, choices between several that are ready, and what programs draw.

#include "sim.h"

#include <string.h>
#include <sys/random.h>
#include <unistd.h>

static uint64_t state;

void sim_seed(uint64_t seed) {
    state = seed;
}

// SplitMix64.
static uint64_t next_number(void) {
    uint64_t number = state += UINT64_C(0x9E3779B97F4A7C15);
    number = (number ^ (number >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    number = (number ^ (number >> 27)) * UINT64_C(0x94D049BB133111EB);
    return number ^ (number >> 31);
}

EXPORT ssize_t getrandom(void *buffer, size_t length, unsigned flags) {
    if (!sim_takes_part()) return sim_call(SYS_getrandom, buffer, length, flags);
    for (size_t done = 0; done < length; done += sizeof state) {
        uint64_t number = next_number();
        memcpy((char *)buffer + done, &number, length - done < sizeof number ? length - done : sizeof number);
    }
    return (ssize_t)length;
}

EXPORT int getentropy(void *buffer, size_t length) {
    if (length > 256) {
        errno = EIO;
        return -1;
    }
    return getrandom(buffer, length, 0) < 0 ? -1 : 0;
}

// `std::random_device` of C++, which would otherwise ask the processor.
EXPORT unsigned _ZNSt13random_device9_M_getvalEv(void *device) {
    static unsigned (*real)(void *);
    if (sim_takes_part()) return (unsigned)next_number();
    if (real == NULL) real = (unsigned (*)(void *))(uintptr_t)sim_real("_ZNSt13random_device9_M_getvalEv");
    return real(device);
}
