// Preloaded into a program under test, which may not contain unsafe code: makes it fork when it receives SIGUSR1. The child
// goes on where the parent was, with its standard streams replaced by the files that two environment variables name.

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

static void fork_now(int signal) {
    (void)signal;
    if (fork() != 0) {
        return;
    }
    int input = open(getenv("CHILD_INPUT"), O_RDONLY);
    int output = open(getenv("CHILD_OUTPUT"), O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (input < 0 || output < 0) {
        _exit(125);
    }
    dup2(input, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
}

__attribute__((constructor)) static void install(void) {
    struct sigaction action = {.sa_handler = fork_now};
    sigaction(SIGUSR1, &action, NULL);
}
