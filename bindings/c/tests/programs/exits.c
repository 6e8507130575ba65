/* Sends messages over `lossless`, then ends the process; the last messages are sent, and the component is closed, by what runs at
 * the end: `exits PLAN_FILE HOW`. With `PLUGIN` defined, the library that `exits PLAN_FILE plugin LIBRARY` loads. */
#include "support.h"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

enum { BEFORE = 100, AFTER = 100 };

static scl_component *component;
static scl_gate *lossless;

/* Sends messages with the numbers from `first` to the one before `end`. */
static void send_numbers(int first, int end) {
    for (int number = first; number < end; number++) {
        char text[16];
        OK(scl_send(lossless, text, (size_t)snprintf(text, sizeof text, "%d", number), FOREVER));
    }
}

static void begin(const char *plan) {
    OK(open_program(plan, NULL, &component));
    lossless = scl_gate_by_name(component, "lossless");
    OK(scl_ready(component, FOREVER));
    send_numbers(0, BEFORE);
}

static void finish(void) {
    char stats[1024];
    size_t len = 0;
    /* A call that fails has its text here, too. */
    if (scl_gate_by_name(component, "lossles") != NULL || strstr(scl_error(), "did you mean `lossless`?") == NULL) {
        printf("no text: %s\n", scl_error());
    }
    send_numbers(BEFORE, BEFORE + AFTER);
    OK(scl_stats(lossless, stats, sizeof stats, &len));
    printf("%s\n", strstr(stats, "\"published\":200,") == NULL ? stats : "published 200");
    OK(scl_close(component, FOREVER));
    say("closed");
}

#ifdef PLUGIN

void start(const char *plan) { begin(plan); }

__attribute__((destructor)) static void unload(void) { finish(); }

#else

static bool at_unloading;

__attribute__((destructor)) static void unload(void) {
    if (at_unloading) {
        finish();
    }
}

static void finish_on_exit(int code, void *unused) {
    (void)code, (void)unused;
    finish();
}

static void finish_thread(void *unused) {
    (void)unused;
    finish();
}

static void *begin_on_thread(void *plan) {
    static pthread_key_t key;
    pthread_key_create(&key, finish_thread);
    begin(plan);
    pthread_setspecific(key, component);
    return NULL;
}

static void *wait_and_exit(void *unused) {
    (void)unused;
    /* The other thread waits in a call, or is about to. */
    usleep(1000);
    exit(0);
}

static pthread_t start_thread(void *(*run)(void *), void *argument) {
    pthread_t thread;
    pthread_create(&thread, NULL, run, argument);
    return thread;
}

static void load_and_unload(const char *plan, const char *library) {
    void *plugin = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (plugin == NULL) {
        printf("%s\n", dlerror());
        exit(1);
    }
    void (*start)(const char *);
    *(void **)&start = dlsym(plugin, "start");
    start(plan);
    dlclose(plugin);
    say("unloaded");
}

int main(int count, char **arguments) {
    char *plan = arguments[1];
    const char *how = arguments[2];
    if (count > 3) {
        load_and_unload(plan, arguments[3]);
    } else if (strcmp(how, "key of a thread") == 0) {
        pthread_join(start_thread(begin_on_thread, plan), NULL);
    } else {
        begin(plan);
    }
    if (strcmp(how, "atexit") == 0) {
        atexit(finish);
    } else if (strcmp(how, "on_exit") == 0) {
        on_exit(finish_on_exit, NULL);
    } else if (strcmp(how, "destructor") == 0) {
        at_unloading = true;
    } else if (strcmp(how, "quick_exit") == 0) {
        at_quick_exit(finish);
        quick_exit(0);
    } else if (strcmp(how, "exit of another thread") == 0) {
        scl_message *message;
        atexit(finish);
        start_thread(wait_and_exit, NULL);
        if (scl_recv(scl_gate_by_name(component, "values"), FOREVER, &message) != SCL_OK) {
            pause();
        }
    } else if (strcmp(how, "end of the main thread") == 0) {
        atexit(finish);
        start_thread(wait_and_exit, NULL);
        pthread_exit(NULL);
    }
    return 0;
}

#endif
