/* A bare loop of 300 Hz: sleeps to absolute deadlines and prints when it woke, in nanoseconds of CLOCK_MONOTONIC. It
 * shows what the machine itself can do, to compare the beats of the autopilot with. Ctrl-C or SIGTERM ends it. */
#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#define RATE 300
#define SECOND 1000000000LL
/* Ten minutes. They are kept until the end, because printing takes time. */
#define MOST (RATE * 600)

static volatile sig_atomic_t stopped;
static int64_t woke[MOST];

static void stop(int signal)
{
    (void)signal;
    stopped = 1;
}

static int64_t now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * SECOND + time.tv_nsec;
}

int main(void)
{
    /* Without SA_RESTART, so that a signal ends the sleep. */
    struct sigaction action = {.sa_handler = stop};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);

    /* The priority of the autopilot in launch.yaml. */
    struct sched_param priority = {.sched_priority = 80};
    if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
        perror("timer: no real-time priority");

    int64_t start = now();
    int beats = 0;
    while (!stopped && beats < MOST) {
        /* From the start, so that rounding and delays do not add up. */
        int64_t deadline = start + (beats + 1) * SECOND / RATE;
        struct timespec until = {.tv_sec = deadline / SECOND, .tv_nsec = deadline % SECOND};
        if (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL) == EINTR)
            continue;
        woke[beats++] = now();
    }
    for (int beat = 0; beat < beats; beat++)
        printf("%lld\n", (long long)woke[beat]);
    return fflush(stdout) == 0 ? 0 : 1;
}
