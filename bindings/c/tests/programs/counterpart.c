/* Opens the component `program` beside its counterpart. */
#include "support.h"
#include <pthread.h>
#include <signal.h>

static char *plan;
static size_t plan_len;
static scl_component *component, *peer;

static void open_both(void) {
    OK(scl_open_test(plan, plan_len, "program", &component, &peer));
    ASSERT(component != NULL && peer != NULL && component != peer);
}

/* Sends a text over a gate of one end, and receives it at the other end at once. */
static void pass(scl_component *from, scl_component *to, const char *gate, const char *text) {
    char buffer[64];
    size_t len;
    OK(scl_send(scl_gate_by_name(from, gate), text, strlen(text), 0));
    OK(scl_recv_into(scl_gate_by_name(to, gate), buffer, sizeof buffer, &len, 0));
    ASSERT(len == strlen(text) && memcmp(buffer, text, len) == 0);
}

/* Nothing is sent, so the deadline passes. Each missed message is told once. */
static void missed_messages_are_told(void) {
    scl_gate *work = scl_gate_by_name(component, "work");
    uint64_t told = 0, missed = 0;
    for (int count = 0; count < 3; count++) {
        do {
            OK(scl_take_missed(work, &missed));
        } while (missed == 0);
        told += missed;
    }
    char stats[1024];
    size_t len;
    OK(scl_stats(work, stats, sizeof stats, &len));
    const char *counted = strstr(stats, "\"missed\":");
    ASSERT(counted != NULL && strtoull(counted + 9, NULL, 10) >= told);
}

static void *answer(void *gate) {
    scl_request *request;
    OK(scl_take_request(gate, 60 * SECOND, &request));
    size_t len;
    const char *data = scl_request_data(request, &len);
    OK(scl_reply(request, data, len));
    return NULL;
}

static void ask(scl_component *from, scl_component *to, const char *gate) {
    pthread_t thread;
    scl_message *reply;
    size_t len;
    pthread_create(&thread, NULL, answer, scl_gate_by_name(to, gate));
    OK(scl_call(scl_gate_by_name(from, gate), "question", 8, 60 * SECOND, &reply));
    ASSERT(memcmp(scl_message_data(reply, &len), "question", 8) == 0 && len == 8);
    scl_message_free(reply);
    pthread_join(thread, NULL);
}

static void every_gate_works(void) {
    OK(scl_ready(component, 0));
    OK(scl_ready(peer, 0));
    pass(component, peer, "out", "out");
    pass(component, peer, "lossless", "lossless");
    pass(component, peer, "jobs", "jobs");
    pass(peer, component, "values", "values");
    pass(peer, component, "work", "work");
    for (int value = 0; value < 100; value++) {
        OK(scl_send(scl_gate_by_name(peer, "newest"), &value, sizeof value, -1));
    }
    int newest;
    size_t len;
    OK(scl_recv_into(scl_gate_by_name(component, "newest"), &newest, sizeof newest, &len, 0));
    ASSERT(newest == 99);
    ask(component, peer, "question");
    ask(peer, component, "answer");
}

static void *receive(void *gate) {
    scl_message *message;
    scl_status status = scl_recv(gate, -1, &message);
    ASSERT(status == SCL_CLOSED || status == SCL_HANDLE);
    return NULL;
}

static void closing_one_leaves_the_other(void) {
    scl_gate *out = scl_gate_by_name(peer, "out");
    pthread_t thread;
    scl_message *message;
    OK(scl_send(scl_gate_by_name(component, "out"), "last", 4, -1));
    pthread_create(&thread, NULL, receive, scl_gate_by_name(component, "values"));
    OK(scl_close(component, 0));
    pthread_join(thread, NULL);
    OK(scl_recv(out, 0, &message));
    scl_message_free(message);
    EXPECT(scl_recv(out, MILLISECOND, &message), SCL_TIMEOUT,
           "gate `program's peers.out` received nothing from `program.out` within");
    EXPECT(scl_ready(component, 0), SCL_HANDLE, "it was closed");
    pthread_create(&thread, NULL, receive, out);
    OK(scl_close(peer, 0));
    pthread_join(thread, NULL);
}

static void wrong_arguments_are_explained(void) {
    scl_component *other = (scl_component *)&plan;
    EXPECT(scl_open_test(NULL, 1, "program", &component, &peer), SCL_ARGUMENT, "`plan_json` is NULL");
    EXPECT(scl_open_test("{}", 2, "program", &component, &peer), SCL_PLAN, "");
    EXPECT(scl_open_test(plan, plan_len, NULL, &component, &peer), SCL_ARGUMENT, "`component` is NULL");
    EXPECT(scl_open_test(plan, plan_len, "progam", &other, &peer), SCL_NAME, "did you mean `program`?");
    ASSERT(other == NULL && peer == NULL);
    EXPECT(scl_open_test(plan, plan_len, "program", NULL, &peer), SCL_ARGUMENT, "`opened` is NULL");
    EXPECT(scl_open_test(plan, plan_len, "program", &component, NULL), SCL_ARGUMENT, "`peer` is NULL");
    EXPECT(scl_open_test(plan, plan_len, "program", &component, &component), SCL_ARGUMENT, "the same pointer");
}

int main(int count, char **arguments) {
    if (count != 2) {
        return 2;
    }
    plan = read_file(arguments[1], &plan_len);
    for (int round = 0; round < 10; round++) {
        open_both();
        every_gate_works();
        closing_one_leaves_the_other();
    }
    open_both();
    missed_messages_are_told();
    closing_one_leaves_the_other();
    wrong_arguments_are_explained();
    struct sigaction action;
    sigaction(SIGTERM, NULL, &action);
    ASSERT(action.sa_handler == SIG_DFL);
    free(plan);
    say("done");
    return 0;
}
