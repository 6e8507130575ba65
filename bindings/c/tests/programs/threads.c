/* Several threads: on one gate, on different gates, and while the component is closed: `threads PLAN_FILE`. */
#include "support.h"
#include <pthread.h>
#include <stdatomic.h>

static const char *plan_path;
static scl_component *component;
static scl_gate *values, *newest, *work, *question, *answer, *lossless, *out;

/* Opens the component and looks up its gates. */
static void open_component(const char *options) {
    OK(open_program(plan_path, options, &component));
    values = scl_gate_by_name(component, "values");
    newest = scl_gate_by_name(component, "newest");
    work = scl_gate_by_name(component, "work");
    question = scl_gate_by_name(component, "question");
    answer = scl_gate_by_name(component, "answer");
    lossless = scl_gate_by_name(component, "lossless");
    out = scl_gate_by_name(component, "out");
}

typedef struct {
    scl_status (*call)(void);
    scl_status ended;
    char text[256];
} waiting_call;

static void *run(void *argument) {
    waiting_call *call = argument;
    /* Busy while the main thread looks whether it is. */
    do {
        call->ended = call->call();
    } while (call->ended == SCL_BUSY);
    snprintf(call->text, sizeof call->text, "%s", scl_error());
    return NULL;
}

static scl_status receive(void) {
    scl_message *message;
    return scl_recv(values, FOREVER, &message);
}

static scl_status receive_for_long(void) {
    scl_message *message;
    return scl_recv(newest, 600 * SECOND, &message);
}

static scl_status wait_for_work(void) {
    uint64_t ready;
    return scl_wait(component, &work, 1, FOREVER, &ready);
}

static scl_status ask(void) {
    scl_message *reply;
    return scl_call(question, "?", 1, FOREVER, &reply);
}

static scl_status take(void) {
    scl_request *request;
    return scl_take_request(answer, FOREVER, &request);
}

/* Until the queue of a peer that takes nothing is full. */
static scl_status send_until_full(void) {
    scl_status status;
    static const char data[1000];
    do {
        status = scl_send(lossless, data, sizeof data, FOREVER);
    } while (status == SCL_OK || status == SCL_BUSY);
    return status;
}

static scl_status wait_for_peers(void) {
    return scl_ready(component, FOREVER);
}

/* True when another thread has the gate locked. Threads that wait keep it locked. */
static bool is_busy(scl_gate *gate) {
    char text[1];
    size_t len;
    return scl_stats(gate, text, sizeof text, &len) == SCL_BUSY;
}

static void one_gate_in_two_threads(void) {
    waiting_call call = {.call = receive};
    pthread_t thread;
    scl_message *message;
    open_component(NULL);
    pthread_create(&thread, NULL, run, &call);
    while (!is_busy(values)) {
    }
    EXPECT(scl_recv(values, 0, &message), SCL_BUSY, "another thread is using this gate; use each gate from one thread");
    EXPECT(scl_recv(values, FOREVER, &message), SCL_BUSY, "another thread is using this gate");
    /* Other gates do not care. */
    OK(scl_send(out, "x", 1, FOREVER));
    EXPECT(scl_recv(newest, 0, &message), SCL_NOTHING, "");
    OK(scl_close(component, FOREVER));
    pthread_join(thread, NULL);
    ASSERT(call.ended == SCL_CLOSED);
}

/* Whatever threads wait for, closing ends it. */
static void closed_while_waiting(const char *options) {
    waiting_call calls[] = {{.call = receive}, {.call = receive_for_long}, {.call = wait_for_work},
                            {.call = ask},     {.call = take},             {.call = send_until_full},
                            {.call = wait_for_peers}};
    enum { COUNT = sizeof calls / sizeof *calls };
    pthread_t threads[COUNT];
    open_component(options);
    scl_gate *busy[] = {values, newest, work, question, answer, lossless};
    for (size_t index = 0; index < COUNT; index++) {
        pthread_create(&threads[index], NULL, run, &calls[index]);
    }
    for (size_t index = 0; index < sizeof busy / sizeof *busy; index++) {
        while (!is_busy(busy[index])) {
        }
    }
    scl_status closed = scl_close(component, 0);
    ASSERT(closed == SCL_OK || closed == SCL_NOT_FLUSHED);
    for (size_t index = 0; index < COUNT; index++) {
        pthread_join(threads[index], NULL);
        scl_status ended = calls[index].ended;
        /* SCL_HANDLE: it was about to be made again. The last may have found its peer. */
        bool is_ended = ended == SCL_CLOSED || ended == SCL_HANDLE || (index == COUNT - 1 && ended == SCL_OK && !options);
        if (!is_ended) {
            fprintf(stderr, "call %zu: %s %s\n", index, scl_status_name(ended), calls[index].text);
            exit(1);
        }
    }
}

static scl_gate *_Atomic shared[3];
static atomic_bool done;

/* Uses gates that come and go under its hands. */
static void *use_gates(void *unused) {
    unsigned long long closed = 0;
    (void)unused;
    while (!atomic_load(&done)) {
        scl_message *message = NULL, *late = NULL;
        uint64_t ready;
        char text[1024];
        size_t len;
        scl_gate *receives = atomic_load(&shared[0]), *sends = atomic_load(&shared[1]);
        scl_component *waits = (scl_component *)atomic_load(&shared[2]);
        scl_status found[] = {scl_recv(receives, 0, &message), scl_send(sends, "x", 1, 0),
                              scl_stats(sends, text, sizeof text, &len), scl_wait(waits, &receives, 1, 0, &ready),
                              scl_recv(receives, MILLISECOND, &late)};
        for (size_t index = 0; index < sizeof found / sizeof *found; index++) {
            switch (found[index]) {
            case SCL_HANDLE:
            case SCL_CLOSED:
                closed++;
                break;
            case SCL_OK:
            case SCL_NOTHING:
            case SCL_TIMEOUT:
            case SCL_BUSY:
            case SCL_ARGUMENT: /* the gate of one component and the handle of the next */
                break;
            default:
                fprintf(stderr, "call %zu: %s %s\n", index, scl_status_name(found[index]), scl_error());
                exit(1);
            }
        }
        scl_message_free(message);
        scl_message_free(late);
    }
    return NULL;
}

static void opened_and_closed_meanwhile(void) {
    pthread_t threads[3];
    open_component(NULL);
    atomic_store(&shared[0], values);
    atomic_store(&shared[1], out);
    atomic_store(&shared[2], (scl_gate *)component);
    for (size_t index = 0; index < 3; index++) {
        pthread_create(&threads[index], NULL, use_gates, NULL);
    }
    for (int round = 0; round < 50; round++) {
        scl_status closed = scl_close(component, 0);
        ASSERT(closed == SCL_OK || closed == SCL_NOT_FLUSHED);
        open_component(NULL);
        atomic_store(&shared[0], values);
        atomic_store(&shared[1], out);
        atomic_store(&shared[2], (scl_gate *)component);
    }
    atomic_store(&done, true);
    for (size_t index = 0; index < 3; index++) {
        pthread_join(threads[index], NULL);
    }
    OK(scl_close(component, FOREVER));
}

int main(int count, char **arguments) {
    if (count != 2) {
        return 2;
    }
    plan_path = arguments[1];
    one_gate_in_two_threads();
    say("one gate");
    closed_while_waiting(NULL);
    /* Without the peer, and nobody to be waited for but in vain. */
    closed_while_waiting("{\"system\": \"lonely\"}");
    say("closed");
    opened_and_closed_meanwhile();
    say("done");
    return 0;
}
