// A program that waits for the signal that stops it, in the way that `WAY` says.

#define _GNU_SOURCE
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void handle(int signal) {
    (void)signal;
}

static void *wait_for_ever(void *unused) {
    poll(NULL, 0, -1);
    return unused;
}

int main(void) {
    const char *way = getenv("WAY");
    sigset_t stops;
    sigemptyset(&stops);
    sigaddset(&stops, SIGTERM);
    // `poll` and its kin end whatever the flags of the handler are.
    struct sigaction action = {.sa_handler = handle, .sa_flags = strcmp(way, "read") == 0 ? 0 : SA_RESTART};
    sigaction(SIGTERM, &action, NULL);
    // Before there is a thread that could handle it.
    if (strcmp(way, "sigwait") == 0) pthread_sigmask(SIG_BLOCK, &stops, NULL);
    pthread_t other;
    pthread_create(&other, NULL, wait_for_ever, NULL);
    int pipes[2], result = -1;
    errno = EINTR;
    if (strcmp(way, "sleep") == 0) result = sleep(100000) > 0 ? -1 : 0;
    if (strcmp(way, "pause") == 0) result = pause();
    if (strcmp(way, "poll") == 0) result = poll(NULL, 0, -1);
    if (strcmp(way, "read") == 0) result = pipe(pipes) == 0 ? (int)read(pipes[0], &result, 1) : 0;
    if (strcmp(way, "sigwait") == 0) {
        int signal;
        result = sigwait(&stops, &signal) == 0 && signal == SIGTERM ? -1 : 0;
        errno = EINTR;
    }
    if (result == -1 && errno == EINTR) printf("%s was ended by a signal\n", way);
    return 0;
}
