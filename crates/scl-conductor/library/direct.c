// System calls that a program makes by itself and not through the C library, as some libraries in Rust do: the kernel
// sends a signal instead of doing them, and its handler does what the program wants.

#include "sim.h"

#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/prctl.h>
#include <ucontext.h>

#if defined(__x86_64__) && defined(PR_SET_SYSCALL_USER_DISPATCH)

// Code in memory.
struct range {
    uintptr_t start;
    uintptr_t length;
};

// Of the C library, which does all that it is asked for through this one; and of the loader, which waits for nothing.
static struct range library, loader;

static bool contains(struct range range, uintptr_t address) {
    return address - range.start < range.length;
}

static int find_ranges(struct dl_phdr_info *object, size_t size, void *data) {
    (void)size;
    (void)data;
    for (int i = 0; i < object->dlpi_phnum; i++) {
        const ElfW(Phdr) *part = &object->dlpi_phdr[i];
        if (part->p_type != PT_LOAD || (part->p_flags & PF_X) == 0) continue;
        struct range range = {object->dlpi_addr + part->p_vaddr, part->p_memsz};
        if (contains(range, (uintptr_t)sim_real("syscall"))) library = range;
        if (object->dlpi_addr == getauxval(AT_BASE)) loader = range;
    }
    return 0;
}

static void handle(int signal, siginfo_t *call, void *context) {
    (void)signal;
    int before = errno;
    greg_t *registers = ((ucontext_t *)context)->uc_mcontext.gregs;
    const long a[] = {registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                      registers[REG_R10], registers[REG_R8],  registers[REG_R9]};
    long number = call->si_syscall;
    bool takes_part = sim_takes_part() && !contains(loader, (uintptr_t)call->si_call_addr);
    long result = takes_part ? sim_do(number, a) : sim_call(number, a[0], a[1], a[2], a[3], a[4], a[5]);
    registers[REG_RAX] = result == -1 ? -errno : result;
    errno = before;
}

void sim_catch_direct_calls(void) {
    if (library.length == 0) {
        dl_iterate_phdr(find_ranges, NULL);
        struct sigaction action = {.sa_sigaction = handle, .sa_flags = SA_SIGINFO | SA_NODEFER};
        sigaction(SIGSYS, &action, NULL);
    }
    // An old kernel does not know it.
    prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, library.start, library.length, NULL);
}

// The time that the kernel tells without a call.
EXPORT unsigned long getauxval(unsigned long type) {
    if (type == AT_SYSINFO_EHDR && sim_takes_part()) return 0;
    return REAL(getauxval)(type);
}

// The signal stays as it is, in threads that want none, too.
EXPORT int pthread_sigmask(int how, const sigset_t *set, sigset_t *before) {
    sigset_t changed;
    if (set != NULL && how != SIG_UNBLOCK && sim_takes_part()) {
        changed = *set;
        sigdelset(&changed, SIGSYS);
        set = &changed;
    }
    return REAL(pthread_sigmask)(how, set, before);
}

EXPORT int sigprocmask(int how, const sigset_t *set, sigset_t *before) {
    int error = pthread_sigmask(how, set, before);
    if (error != 0) errno = error;
    return error == 0 ? 0 : -1;
}

#else

void sim_catch_direct_calls(void) {}

#endif
