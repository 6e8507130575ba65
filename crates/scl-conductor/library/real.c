// The C library's own functions.

#include "sim.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *sim_real(const char *name) {
    // The C library keeps the first version of its condition variables, which are smaller, under the same names.
    const char *version = strncmp(name, "pthread_cond_", 13) == 0 ? "GLIBC_2.3.2" : NULL;
    void *found = version == NULL ? NULL : dlvsym(RTLD_NEXT, name, version);
    if (found == NULL) found = dlsym(RTLD_NEXT, name);
    if (found == NULL) {
        dprintf(STDERR_FILENO, "scl simulate: the C library has no `%s`\n", name);
        abort();
    }
    return found;
}

long sim_call(long number, ...) {
    va_list list;
    va_start(list, number);
    long arguments[6];
    for (int i = 0; i < 6; i++) arguments[i] = va_arg(list, long);
    va_end(list);
    return REAL(syscall)(number, arguments[0], arguments[1], arguments[2], arguments[3], arguments[4], arguments[5]);
}
