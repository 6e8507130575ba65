/* Wrong arguments of every kind, and the status and words that answer each: `bad_input PLAN_FILE`. */
#include "support.h"
#include <limits.h>

static const char *plan_path;

/* Replaces the first `from` in the plan by `to`, and opens what comes out. */
static scl_status open_changed(const char *from, const char *to, scl_component **component) {
    size_t len;
    char *plan = read_file(plan_path, &len);
    char *place = strstr(plan, from);
    ASSERT(place != NULL);
    char *changed = malloc(len + strlen(to) + 1);
    ASSERT(changed != NULL);
    size_t before = (size_t)(place - plan);
    memcpy(changed, plan, before);
    strcpy(changed + before, to);
    strcat(changed, place + strlen(from));
    scl_status status = scl_open(changed, strlen(changed), "program", NULL, component);
    free(changed);
    free(plan);
    return status;
}

static void plans(void) {
    scl_component *component = (scl_component *)&plan_path;
    const char garbage[] = {'{', '"', (char)0xff, (char)0xfe, 0, 7};
    EXPECT(scl_open(garbage, sizeof garbage, "program", NULL, &component), SCL_PLAN, "not UTF-8");
    ASSERT(component == NULL);
    EXPECT(scl_open("", 0, "program", NULL, &component), SCL_PLAN, "the plan is not valid JSON");
    EXPECT(scl_open(NULL, 0, "program", NULL, &component), SCL_PLAN, "the plan is not valid JSON");
    EXPECT(scl_open("[[[[", 4, "program", NULL, &component), SCL_PLAN, "the plan is not valid JSON");
    EXPECT(scl_open("{}", 2, "program", NULL, &component), SCL_PLAN, "field `version` is missing");
    EXPECT(open_changed("\"version\": 1", "\"version\": 99", &component), SCL_PLAN, "version 99 of the format");
    EXPECT(open_changed("\"version\": 1", "\"version\": 1, \"sistem\": 1", &component), SCL_PLAN, "unknown field `sistem`");
    EXPECT(open_changed("\"max_size\"", "\"min_size\"", &component), SCL_PLAN, "min_size");
    EXPECT(open_changed("\"kind\": \"pub\"", "\"kind\": \"rep\"", &component), SCL_PLAN, "`program.out`");

    EXPECT(scl_open(NULL, 5, "program", NULL, &component), SCL_ARGUMENT, "`plan_json` is NULL, but `len` is 5");
    EXPECT(scl_open("{}", SIZE_MAX, "program", NULL, &component), SCL_ARGUMENT, "which no object can have");
    EXPECT(scl_open("{}", 2, NULL, NULL, &component), SCL_ARGUMENT, "`component` is NULL");
    EXPECT(scl_open("{}", 2, "\xff", NULL, &component), SCL_ARGUMENT, "`component` is not UTF-8");
    EXPECT(scl_open("{}", 2, "program", NULL, NULL), SCL_ARGUMENT, "`opened` is NULL");

    /* The plan of another topology has other components. */
    size_t len;
    char *plan = read_file(plan_path, &len);
    EXPECT(scl_open(plan, len, "progam", NULL, &component), SCL_NAME,
           "system `border` has no component `progam`; did you mean `program`?");
    EXPECT(scl_open(plan, len, "", NULL, &component), SCL_NAME, "has no component ``");
    free(plan);
}

static void options(void) {
    scl_component *component;
    /* First, because real-time settings are read once. */
    setenv("SCL_LOG", "loud", 1);
    EXPECT(open_program(plan_path, NULL, &component), SCL_ENVIRONMENT, "`SCL_LOG=loud` is not understood");
    setenv("SCL_LOG", "off", 1);
    setenv("SCL_STOP_WITHIN", "soon", 1);
    EXPECT(open_program(plan_path, NULL, &component), SCL_ENVIRONMENT, "`SCL_STOP_WITHIN=soon` is not understood");
    unsetenv("SCL_STOP_WITHIN");
    setenv("SCL_SCHED", "round", 1);
    EXPECT(open_program(plan_path, NULL, &component), SCL_ENVIRONMENT, "`SCL_SCHED=round` is not understood");
    unsetenv("SCL_SCHED");
    EXPECT(open_program(plan_path, "{\"sistem\": \"x\"}", &component), SCL_ARGUMENT, "unknown field `sistem`");
    EXPECT(open_program(plan_path, "{\"transport\": \"udp\"}", &component), SCL_ARGUMENT, "`udp` is not understood");
    EXPECT(open_program(plan_path, "{\"signals\": 1}", &component), SCL_ARGUMENT, "expected a boolean");
    EXPECT(open_program(plan_path, "{", &component), SCL_ARGUMENT, "`options_json` is not valid");
    EXPECT(open_program(plan_path, "\xff", &component), SCL_ARGUMENT, "`options_json` is not UTF-8");
    EXPECT(open_program(plan_path, "{\"runtime_dir\": \"here\"}", &component), SCL_FOLDER, "not an absolute path");
    EXPECT(open_program(plan_path, "{\"runtime_dir\": \"/dev/null\"}", &component), SCL_FOLDER, "not a folder");
    EXPECT(open_program(plan_path, "{\"system\": \"../x\"}", &component), SCL_FOLDER, "cannot be the name of a system");
    ASSERT(component == NULL);
}

static void nulls(scl_component *component) {
    scl_gate *out = scl_gate_by_name(component, "out"), *values = scl_gate_by_name(component, "values");
    scl_gate *question = scl_gate_by_name(component, "question"), *answer = scl_gate_by_name(component, "answer");
    scl_message *message = NULL;
    scl_request *request = NULL;
    void *memory;
    char text[8];
    size_t len = 1;
    uint64_t ready, missed = 1;

    ASSERT(scl_gate_by_name(NULL, "out") == NULL && strstr(scl_error(), "the component is NULL"));
    ASSERT(scl_gate_by_name(component, NULL) == NULL && strstr(scl_error(), "`name` is NULL"));
    EXPECT(scl_ready(NULL, 0), SCL_ARGUMENT, "the component is NULL");
    EXPECT(scl_close(NULL, 0), SCL_ARGUMENT, "the component is NULL");
    EXPECT(scl_send(NULL, "x", 1, 0), SCL_ARGUMENT, "the gate is NULL");
    EXPECT(scl_send(out, NULL, 1, 0), SCL_ARGUMENT, "`data` is NULL, but `len` is 1");
    EXPECT(scl_send(out, "x", SIZE_MAX, 0), SCL_ARGUMENT, "which no object can have");
    OK(scl_send(out, NULL, 0, 0));
    EXPECT(scl_buffer(out, 1, NULL), SCL_ARGUMENT, "`buffer` is NULL");
    EXPECT(scl_buffer(NULL, 1, &memory), SCL_ARGUMENT, "the gate is NULL");
    EXPECT(scl_recv(values, 0, NULL), SCL_ARGUMENT, "`message` is NULL");
    EXPECT(scl_recv(NULL, 0, &message), SCL_ARGUMENT, "the gate is NULL");
    EXPECT(scl_latest(values, NULL), SCL_ARGUMENT, "`message` is NULL");
    EXPECT(scl_take_missed(NULL, &missed), SCL_ARGUMENT, "the gate is NULL");
    EXPECT(scl_take_missed(values, NULL), SCL_ARGUMENT, "`missed` is NULL");
    ASSERT(missed == 0);
    EXPECT(scl_take_missed(values, &missed), SCL_FAILED, "gate `program.values` has no `deadline`");
    EXPECT(scl_recv_into(values, NULL, 1, &len, 0), SCL_ARGUMENT, "`buffer` is NULL, but `capacity` is 1");
    ASSERT(len == 0);
    EXPECT(scl_recv_into(values, text, SIZE_MAX, &len, 0), SCL_ARGUMENT, "which no object can have");
    EXPECT(scl_recv_into(values, text, sizeof text, NULL, 0), SCL_ARGUMENT, "`len` is NULL");
    EXPECT(scl_call(question, NULL, 1, 0, &message), SCL_ARGUMENT, "`data` is NULL");
    EXPECT(scl_call(question, "x", 1, 0, NULL), SCL_ARGUMENT, "`message` is NULL");
    EXPECT(scl_take_request(answer, 0, NULL), SCL_ARGUMENT, "`request` is NULL");
    EXPECT(scl_reply(NULL, "x", 1), SCL_ARGUMENT, "`request` is NULL");
    EXPECT(scl_reply_buffer(NULL, 1, &memory), SCL_ARGUMENT, "`request` is NULL");
    EXPECT(scl_stats(NULL, text, sizeof text, &len), SCL_ARGUMENT, "the gate is NULL");
    EXPECT(scl_stats(out, text, sizeof text, NULL), SCL_ARGUMENT, "`len` is NULL");
    EXPECT(scl_stats(out, NULL, 8, &len), SCL_ARGUMENT, "`buffer` is NULL");
    EXPECT(scl_stats(out, text, sizeof text, &len), SCL_BUFFER, "the buffer of 8 bytes is too small");
    ASSERT(len > 100);
    EXPECT(scl_wait(component, NULL, 1, 0, &ready), SCL_ARGUMENT, "`gates` is NULL");
    EXPECT(scl_wait(component, &values, 1, 0, NULL), SCL_ARGUMENT, "`ready` is NULL");
    EXPECT(scl_wait(component, &values, 0, 0, &ready), SCL_ARGUMENT, "1 to 64 gates");
    EXPECT(scl_wait(component, &values, 65, 0, &ready), SCL_ARGUMENT, "1 to 64 gates");
    EXPECT(scl_wait(NULL, &values, 1, 0, &ready), SCL_ARGUMENT, "the component is NULL");
    ASSERT(scl_fd(NULL) == -1 && strstr(scl_error(), "the component is NULL"));
    ASSERT(!scl_is_connected(NULL));
    ASSERT(scl_component_name(NULL) == NULL && strstr(scl_error(), "the component is NULL"));
    ASSERT(strcmp(scl_component_name(component), "program") == 0);
    ASSERT(scl_sender(NULL) == NULL && strstr(scl_error(), "the gate is NULL"));
    ASSERT(scl_sender(values) == NULL && scl_sender(out) == NULL && scl_sender(answer) == NULL);
    ASSERT(scl_message_data(NULL, NULL) == NULL);
    ASSERT(scl_request_data(NULL, &len) == NULL && len == 0);
    scl_message_free(NULL);
    scl_request_free(NULL);
    ASSERT(message == NULL && request == NULL);
}

static void kinds(scl_component *component) {
    scl_gate *out = scl_gate_by_name(component, "out"), *values = scl_gate_by_name(component, "values");
    scl_gate *question = scl_gate_by_name(component, "question"), *answer = scl_gate_by_name(component, "answer");
    scl_message *message;
    scl_request *request;
    uint64_t ready;
    char text[8];
    size_t len;
    EXPECT(scl_send(values, "x", 1, 0), SCL_KIND, "`scl_send` is not for `sub` gates such as `program.values`; use `scl_recv`");
    EXPECT(scl_recv(out, 0, &message), SCL_KIND, "use `scl_send`");
    EXPECT(scl_recv_into(question, text, sizeof text, &len, 0), SCL_KIND, "use `scl_call`");
    EXPECT(scl_latest(answer, &message), SCL_KIND, "use `scl_take_request`");
    EXPECT(scl_take_missed(out, &ready), SCL_KIND, "`scl_take_missed` is not for `pub` gates such as `program.out`");
    EXPECT(scl_call(out, "x", 1, 0, &message), SCL_KIND, "`scl_call` is not for `pub` gates");
    EXPECT(scl_take_request(values, 0, &request), SCL_KIND, "`scl_take_request` is not for `sub` gates");
    scl_gate *pair[] = {values, out};
    EXPECT(scl_wait(component, pair, 2, 0, &ready), SCL_KIND, "`scl_wait` is not for `pub` gates");
    pair[1] = values;
    EXPECT(scl_wait(component, pair, 2, 0, &ready), SCL_BUSY, "another thread is using this gate");
    ASSERT(scl_gate_by_name(component, "vlues") == NULL);
    ASSERT(strstr(scl_error(), "component `program` has no gate `vlues`; did you mean `values`?"));
    ASSERT(scl_gate_by_name(component, "") == NULL);
    ASSERT(scl_gate_by_name(component, "values") == values);
}

static void lengths(scl_component *component) {
    static const char data[2048];
    scl_message *message;
    void *memory;
    scl_gate *jobs = scl_gate_by_name(component, "jobs"), *question = scl_gate_by_name(component, "question");
    EXPECT(scl_send(jobs, data, sizeof data, 0), SCL_TOO_LONG,
           "gate `program.jobs` cannot send a message of 2048 bytes: `peer.jobs` accepts at most 1024");
    EXPECT(scl_call(question, data, sizeof data, 0, &message), SCL_TOO_LONG, "`peer.question` accepts at most 1024");
    EXPECT(scl_buffer(jobs, sizeof data, &memory), SCL_TOO_LONG, "at most 1024 are accepted");
    ASSERT(memory == NULL);
    EXPECT(scl_buffer(jobs, SIZE_MAX, &memory), SCL_TOO_LONG, "at most 1024 are accepted");
    /* Nothing was counted as sent, and the gate still works. */
    OK(scl_send(jobs, data, 1024, 0));
}

/* Handles that are none: of another kind, closed, or made up. */
static void handles(scl_component *component) {
    scl_component *again;
    scl_message *message;
    scl_gate *values = scl_gate_by_name(component, "values");
    uint64_t memory[8] = {0}, ready;
    scl_gate *made_up[] = {(scl_gate *)component, (scl_gate *)memory, (scl_gate *)&message, (scl_gate *)1,
                           (scl_gate *)5, (scl_gate *)(uintptr_t)UINTPTR_MAX, (scl_gate *)((uintptr_t)values + 1),
                           (scl_gate *)((uintptr_t)values ^ (UINTPTR_MAX / 2 + 1))};
    for (size_t index = 0; index < sizeof made_up / sizeof *made_up; index++) {
        EXPECT(scl_recv(made_up[index], 0, &message), SCL_HANDLE, "this is not an open gate");
    }
    EXPECT(scl_ready((scl_component *)values, 0), SCL_HANDLE, "this is not an open component");
    EXPECT(scl_close((scl_component *)memory, 0), SCL_HANDLE, "this is not an open component");
    ASSERT(scl_message_data((scl_message *)memory, NULL) == NULL && strstr(scl_error(), "this is not a message"));
    scl_message_free((scl_message *)memory);
    EXPECT(scl_reply((scl_request *)memory, "x", 1), SCL_HANDLE, "this is not a request");
    scl_request_free((scl_request *)((char *)memory + 1));

    EXPECT(open_program(plan_path, NULL, &again), SCL_TAKEN, "component `program` is already running");
    OK(scl_close(component, 0));
    EXPECT(scl_recv(values, 0, &message), SCL_HANDLE, "it was closed, or never was one");
    EXPECT(scl_close(component, 0), SCL_HANDLE, "it was closed, or never was one");
    EXPECT(scl_ready(component, 0), SCL_HANDLE, "it was closed, or never was one");
    ASSERT(scl_fd(component) == -1);
    /* The next component uses the same memory, but has other handles. */
    OK(open_program(plan_path, NULL, &again));
    EXPECT(scl_recv(values, 0, &message), SCL_HANDLE, "it was closed, or never was one");
    EXPECT(scl_close(component, 0), SCL_HANDLE, "it was closed, or never was one");
    scl_gate *new_values = scl_gate_by_name(again, "values");
    EXPECT(scl_recv(new_values, 0, &message), SCL_NOTHING, "no message has arrived yet");

    /* Gates of two components. */
    scl_component *other;
    OK(open_program(plan_path, "{\"system\": \"other\"}", &other));
    scl_gate *pair[] = {new_values, scl_gate_by_name(other, "values")};
    EXPECT(scl_wait(again, pair, 2, 0, &ready), SCL_ARGUMENT, "`gates[1]` is not a gate of this component");
    OK(scl_close(other, 0));
    OK(scl_close(again, 0));
}

int main(int count, char **arguments) {
    scl_component *component;
    if (count != 2) {
        return 2;
    }
    plan_path = arguments[1];
    ASSERT(scl_abi() == SCL_ABI);
    ASSERT(scl_error()[0] == 0);
    ASSERT(strcmp(scl_status_name(SCL_TOO_LONG), "SCL_TOO_LONG") == 0);
    ASSERT(strcmp(scl_status_name(INT_MIN), "unknown status") == 0);
    plans();
    options();
    OK(open_program(plan_path, NULL, &component));
    nulls(component);
    kinds(component);
    lengths(component);
    handles(component);
    say("done");
    return 0;
}
