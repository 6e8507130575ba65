// A program that waits in every way that the C library offers, and says how long it took on the clocks.

#define _GNU_SOURCE
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/poll.h>
#include <sys/random.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <threads.h>
#include <time.h>
#include <unistd.h>

static int hold_a_second(void *mutex) {
    mtx_lock(mutex);
    thrd_sleep(&(struct timespec){.tv_sec = 1}, NULL);
    mtx_unlock(mutex);
    return 5;
}

static double now(clockid_t clock) {
    struct timespec time;
    clock_gettime(clock, &time);
    return (double)time.tv_sec + (double)time.tv_nsec / 1e9;
}

// Milliseconds since the last call.
static long passed(void) {
    static double before;
    double after = now(CLOCK_MONOTONIC), took = (after - before) * 1000;
    before = after;
    return (long)(took + 0.5);
}

static struct timespec until(clockid_t clock, double seconds) {
    double end = now(clock) + seconds;
    return (struct timespec){.tv_sec = (time_t)end, .tv_nsec = (long)((end - (double)(time_t)end) * 1e9)};
}

#define SAY(...) (printf(__VA_ARGS__), printf(": %ld ms\n", passed()), fflush(stdout))

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
static pthread_rwlock_t lock = PTHREAD_RWLOCK_INITIALIZER;
static sem_t semaphore;
static int turn;

static void *ping(void *name) {
    for (int i = 0; i < 3; i++) {
        pthread_mutex_lock(&mutex);
        while (turn != *(char *)name) pthread_cond_wait(&condition, &mutex);
        usleep(10000);
        turn = turn == 'a' ? 'b' : 'a';
        pthread_cond_broadcast(&condition);
        pthread_mutex_unlock(&mutex);
    }
    sem_post(&semaphore);
    return name;
}

static void *hold(void *seconds) {
    pthread_mutex_lock(&mutex);
    pthread_rwlock_wrlock(&lock);
    usleep((useconds_t)(*(double *)seconds * 1e6));
    pthread_rwlock_unlock(&lock);
    pthread_mutex_unlock(&mutex);
    return NULL;
}

static volatile sig_atomic_t handled;
static void handle(int signal) {
    handled = signal;
}

static void sleeps(void) {
    sleep(3);
    SAY("sleep");
    usleep(2500);
    SAY("usleep");
    nanosleep(&(struct timespec){.tv_nsec = 7000000}, NULL);
    SAY("nanosleep");
    struct timespec end = until(CLOCK_REALTIME, 86400);
    clock_nanosleep(CLOCK_REALTIME, TIMER_ABSTIME, &end, NULL);
    SAY("clock_nanosleep, a day");
    mtx_t held;
    thrd_t thread;
    mtx_init(&held, mtx_plain);
    thrd_create(&thread, hold_a_second, &held);
    thrd_yield();
    mtx_lock(&held);
    SAY("mtx_lock");
    int result;
    thrd_join(thread, &result);
    printf("%d, ", result);
    SAY("thrd_join");
}

static void descriptors(void) {
    int event = eventfd(0, 0), timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK), epoll = epoll_create1(0);
    struct pollfd polled = {.fd = event, .events = POLLIN};
    printf("%d, ", poll(&polled, 1, 250));
    SAY("poll");
    printf("%d, ", ppoll(&polled, 1, &(struct timespec){.tv_nsec = 500000}, NULL));
    SAY("ppoll, shorter than a millisecond");
    fd_set set;
    FD_ZERO(&set);
    FD_SET(event, &set);
    printf("%d, ", select(event + 1, &set, NULL, NULL, &(struct timeval){.tv_usec = 40000}));
    SAY("select");
    struct itimerspec periodic = {.it_value.tv_sec = 1, .it_interval.tv_nsec = 100000000};
    timerfd_settime(timer, 0, &periodic, NULL);
    epoll_ctl(epoll, EPOLL_CTL_ADD, timer, &(struct epoll_event){.events = EPOLLIN});
    uint64_t count = 0;
    struct epoll_event ready;
    printf("%d, ", epoll_wait(epoll, &ready, 1, -1));
    SAY("epoll_wait for a timer");
    usleep(450000);
    passed();
    printf("%zd read, ", read(timer, &count, sizeof count));
    printf("expired %d times, ", (int)count);
    timerfd_gettime(timer, &periodic);
    SAY("%ld ms left", (periodic.it_value.tv_nsec + 500000) / 1000000);
    printf("%d, ", epoll_wait(epoll, &ready, 1, 10));
    SAY("epoll_wait");
    close(timer);
    usleep(500000);
    SAY("a closed timer wakes nobody");
}

static void threads(void) {
    char a = 'a', b = 'b';
    turn = 'a';
    pthread_t first, second;
    pthread_create(&first, NULL, ping, &a);
    pthread_create(&second, NULL, ping, &b);
    sem_wait(&semaphore);
    SAY("sem_wait");
    void *result;
    pthread_join(first, &result);
    pthread_join(second, NULL);
    printf("%c, ", *(char *)result);
    SAY("pthread_join");
    double seconds = 2;
    pthread_create(&first, NULL, hold, &seconds);
    sched_yield();
    struct timespec end = until(CLOCK_REALTIME, 0.5);
    printf("%s, ", strerror(pthread_mutex_timedlock(&mutex, &end)));
    SAY("pthread_mutex_timedlock");
    pthread_rwlock_rdlock(&lock);
    SAY("pthread_rwlock_rdlock");
    pthread_rwlock_unlock(&lock);
    pthread_join(first, NULL);
    pthread_mutex_lock(&mutex);
    end = until(CLOCK_REALTIME, 4);
    printf("%s, ", strerror(pthread_cond_timedwait(&condition, &mutex, &end)));
    SAY("pthread_cond_timedwait");
    end = until(CLOCK_MONOTONIC, 5);
    printf("%s, ", strerror(pthread_cond_clockwait(&condition, &mutex, CLOCK_MONOTONIC, &end)));
    SAY("pthread_cond_clockwait");
    pthread_mutex_unlock(&mutex);
    end = until(CLOCK_REALTIME, 6);
    printf("%d, ", sem_timedwait(&semaphore, &end));
    SAY("sem_timedwait, for a thread that has ended");
    end = until(CLOCK_REALTIME, 6);
    printf("%d, ", sem_timedwait(&semaphore, &end));
    SAY("sem_timedwait");
}

static void clocks(void) {
    double start = now(CLOCK_MONOTONIC);
    long looks = 0;
    while (now(CLOCK_MONOTONIC) < start + 0.01) looks++;
    printf("%s, ", looks < 100000 ? "soon" : "late");
    SAY("a loop until a time");
    struct timeval day;
    gettimeofday(&day, NULL);
    printf("%ld, ", (long)(time(NULL) - day.tv_sec));
    time_t seconds = day.tv_sec;
    char text[32];
    strftime(text, sizeof text, "%F %R", gmtime(&seconds));
    SAY("%s", text);
}

static void others(void) {
    uint32_t numbers[2];
    getrandom(&numbers[0], sizeof numbers[0], 0);
    getentropy(&numbers[1], sizeof numbers[1]);
    printf("%s, ", numbers[0] == numbers[1] ? "equal" : "different");
    SAY("random numbers %08x %08x", numbers[0], numbers[1]);
    // A child lives in real time.
    pid_t child = fork();
    if (child == 0) {
        double start = now(CLOCK_REALTIME);
        usleep(1000);
        _exit(now(CLOCK_REALTIME) - start < 60 && start > 1767225600 ? 7 : 8);
    }
    int status;
    waitpid(child, &status, 0);
    printf("%d, ", WEXITSTATUS(status));
    SAY("a child");
    struct sigaction action = {.sa_handler = handle, .sa_flags = SA_RESTART};
    sigaction(SIGALRM, &action, NULL);
    raise(SIGALRM);
    printf("%d, ", handled == SIGALRM);
    SAY("a signal");
    handled = 0;
    alarm(5);
    printf("%d, ", pause());
    printf("%d, ", handled == SIGALRM);
    SAY("alarm");
    setitimer(ITIMER_REAL, &(struct itimerval){.it_value.tv_usec = 1, .it_interval.tv_usec = 250000}, NULL);
    for (int i = 0; i < 4; i++) pause();
    printf("%u left, ", alarm(0));
    SAY("setitimer");
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGALRM);
    sigprocmask(SIG_BLOCK, &set, NULL);
    printf("%d, ", sigtimedwait(&set, NULL, &(struct timespec){.tv_sec = 8}));
    SAY("sigtimedwait");
    raise(SIGALRM);
    sigwait(&set, &status);
    printf("%d, ", status == SIGALRM);
    SAY("sigwait");
}

static pthread_t called;

static void call(union sigval value) {
    called = pthread_self();
    printf("%s, ", (char *)value.sival_ptr);
    sem_post(&semaphore);
}

static void posix_timers(void) {
    struct sigaction action = {.sa_handler = handle, .sa_flags = SA_RESTART};
    sigaction(SIGUSR1, &action, NULL);
    timer_t timer;
    struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGUSR1};
    timer_create(CLOCK_MONOTONIC, &event, &timer);
    struct itimerspec times = {.it_value.tv_sec = 2, .it_interval.tv_nsec = 5000000};
    timer_settime(timer, 0, &times, NULL);
    for (int i = 0; i < 201; i++) pause();
    printf("%d, ", handled == SIGUSR1);
    SAY("timer_create with a signal");
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGUSR1);
    sigprocmask(SIG_BLOCK, &set, NULL);
    siginfo_t info;
    for (int i = 0; i < 3; i++) sigwaitinfo(&set, &info);
    printf("%d, ", info.si_code == SI_TIMER);
    timer_gettime(timer, &times);
    printf("%ld left, ", times.it_value.tv_nsec);
    timer_delete(timer);
    SAY("sigwaitinfo");
    event = (struct sigevent){
        .sigev_notify = SIGEV_THREAD, .sigev_notify_function = call, .sigev_value.sival_ptr = "a function"};
    timer_create(CLOCK_REALTIME, &event, &timer);
    times = (struct itimerspec){.it_value = until(CLOCK_REALTIME, 1.5)};
    timer_settime(timer, TIMER_ABSTIME, &times, NULL);
    sem_wait(&semaphore);
    printf("%d, ", pthread_equal(called, pthread_self()));
    timer_delete(timer);
    printf("%d, ", timer_gettime(timer, &times));
    SAY("timer_create with a thread");
}

// A system call without the C library, as far as this is known for the processor.
static long direct(long number, long a, long b, long c, long d) {
#ifdef __x86_64__
    register long fourth __asm__("r10") = d;
    long result;
    __asm__ volatile("syscall"
                     : "=a"(result)
                     : "a"(number), "D"(a), "S"(b), "d"(c), "r"(fourth)
                     : "rcx", "r11", "memory");
    return result;
#else
    return syscall(number, a, b, c, d);
#endif
}

static void *wait_directly(void *argument) {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, NULL);
    struct timespec hour = {.tv_sec = 3600};
    printf("%ld, ", direct(SYS_nanosleep, (long)&hour, 0, 0, 0));
    SAY("nanosleep without the C library");
    return argument;
}

static void direct_calls(void) {
    pthread_t thread;
    pthread_create(&thread, NULL, wait_directly, NULL);
    pthread_join(thread, NULL);
    struct timespec time;
    direct(SYS_clock_gettime, CLOCK_MONOTONIC, (long)&time, 0, 0);
    printf("%s, ", now(CLOCK_MONOTONIC) - (double)time.tv_sec < 2 ? "the same time" : "another time");
    int ends[2];
    printf("%d, ", pipe(ends));
    struct pollfd polled = {.fd = ends[0], .events = POLLIN};
    struct timespec second = {.tv_sec = 1};
    printf("%ld, ", direct(SYS_ppoll, (long)&polled, 1, (long)&second, 0));
    printf("%d, ", direct(SYS_read, -1, 0, 0, 0) < 0);
    SAY("ppoll without the C library");
}

int main(void) {
    sem_init(&semaphore, 0, 0);
    passed();
    sleeps();
    descriptors();
    threads();
    clocks();
    others();
    posix_timers();
    direct_calls();
    // A program that closes all that it does not know.
    printf("%d, ", close_range(3, ~0U, 0));
    printf("%d, ", dup2(1, 3) == 3 ? close(3) : -1);
    usleep(1000);
    SAY("close_range");
}
