// A process that becomes another program, as `sh -c` does with its last command, takes its seat along.

#include "sim.h"

#include <stdarg.h>
#include <stdlib.h>
#include <unistd.h>

extern char **environ;

// Calls a function of the exec family, which returns only if it fails.
#define BECOME(call)       \
    sim_keep_seat(true);   \
    int result = call;     \
    sim_keep_seat(false);  \
    return result

EXPORT int execve(const char *path, char *const arguments[], char *const environment[]) {
    BECOME(REAL(execve)(path, arguments, environment));
}

EXPORT int execv(const char *path, char *const arguments[]) {
    BECOME(REAL(execv)(path, arguments));
}

EXPORT int execvp(const char *file, char *const arguments[]) {
    BECOME(REAL(execvp)(file, arguments));
}

EXPORT int execvpe(const char *file, char *const arguments[], char *const environment[]) {
    BECOME(REAL(execvpe)(file, arguments, environment));
}

EXPORT int fexecve(int descriptor, char *const arguments[], char *const environment[]) {
    BECOME(REAL(fexecve)(descriptor, arguments, environment));
}

// Gathers the arguments that follow the first one, up to and with the null pointer. `list` is left behind it.
#define GATHER(first, list, arguments)                                                        \
    va_list counted;                                                                          \
    va_copy(counted, list);                                                                   \
    size_t count = 2;                                                                         \
    while (va_arg(counted, char *) != NULL) count++;                                          \
    va_end(counted);                                                                          \
    char *arguments[count];                                                                   \
    arguments[0] = (char *)(uintptr_t)first;                                                  \
    for (size_t i = 1; i < count; i++) arguments[i] = va_arg(list, char *)

EXPORT int execl(const char *path, const char *first, ...) {
    va_list list;
    va_start(list, first);
    GATHER(first, list, arguments);
    va_end(list);
    return execv(path, arguments);
}

EXPORT int execlp(const char *file, const char *first, ...) {
    va_list list;
    va_start(list, first);
    GATHER(first, list, arguments);
    va_end(list);
    return execvp(file, arguments);
}

EXPORT int execle(const char *path, const char *first, ...) {
    va_list list;
    va_start(list, first);
    GATHER(first, list, arguments);
    char *const *environment = va_arg(list, char *const *);
    va_end(list);
    return execve(path, arguments, environment);
}
