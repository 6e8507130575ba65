/* Plays a component of `every_kind.yaml` with generated code: `kinds left` asks and sends, `kinds right` does the rest. */
#include "every_kind_scl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SECOND INT64_C(1000000000)

static void say(const char *text)
{
    puts(text);
    fflush(stdout);
}

static void expect(scl_status status, scl_status expected, const char *what)
{
    if (status != expected) {
        fprintf(stderr, "%s: %s: %s\n", what, scl_status_name(status), scl_error());
        exit(1);
    }
}

static void say_bytes(const char *what, scl_message *message)
{
    size_t size;
    const char *data = (const char *)scl_message_data(message, &size);
    printf("%s %.*s\n", what, (int)size, data);
    fflush(stdout);
    scl_message_free(message);
}

static int left(void)
{
    every_kind_left self;
    Kinds__Value value = KINDS__VALUE__INIT;
    Kinds__GPSFix__InnerPart part = KINDS__GPSFIX__INNER_PART__INIT;
    Part__Part *answer;
    scl_message *bytes;
    char name[2000];
    expect(every_kind_left_open(&self, NULL), SCL_OK, "open");
    expect(every_kind_left_ready(&self, 30 * SECOND), SCL_OK, "ready");

    /* Longer than the buffer on the stack. */
    memset(name, 'x', sizeof name);
    name[sizeof name - 1] = 0;
    value.number = 42;
    value.name = name;
    expect(every_kind_left_values_send(&self, &value, -1), SCL_OK, "values");
    part.latitude = 48.5;
    expect(every_kind_left_class_send(&self, &part, -1), SCL_OK, "class");
    expect(every_kind_left_int_call(&self, &value, &answer, -1), SCL_OK, "int");
    printf("answer %d\n", (int)answer->state);
    every_kind_left_int_free(answer);
    expect(every_kind_left_raw_out_send(&self, "raw", 3, -1), SCL_OK, "raw_out");
    expect(every_kind_left_raw_jobs_send(&self, "job", 3, -1), SCL_OK, "raw_jobs");
    expect(every_kind_left_raw_question_call(&self, "question", 8, &bytes, -1), SCL_OK, "raw_question");
    say_bytes("raw answer", bytes);
    expect(every_kind_left_json_question_call(&self, "{}", 2, &bytes, -1), SCL_OK, "json_question");
    say_bytes("json answer", bytes);
    expect(every_kind_left_close(&self, 30 * SECOND), SCL_OK, "close");

    /* What can be known is refused. */
    expect(every_kind_left_values_send(&self, &value, -1), SCL_ARGUMENT, "closed");
    expect(every_kind_left_values_send(NULL, &value, -1), SCL_ARGUMENT, "NULL component");
    expect(every_kind_left_int_call(&self, &value, NULL, -1), SCL_ARGUMENT, "NULL result");
    expect(every_kind_left_values_send(&self, NULL, -1), SCL_ARGUMENT, "NULL message");
    say(scl_error());
    value.base.descriptor = NULL;
    expect(every_kind_left_values_send(&self, &value, -1), SCL_ARGUMENT, "no message");
    say(scl_error());
    return 0;
}

static void take_values(every_kind_right_side *self)
{
    Kinds__Value *value;
    scl_status status = every_kind_right_side_values_recv(self, &value, 0);
    if (status == SCL_DECODE) {
        char stats[2000];
        size_t length;
        say(scl_error());
        expect(scl_stats(self->gates.values, stats, sizeof stats, &length), SCL_OK, "stats");
        say(strstr(stats, "\"rejected\":1") ? "1 rejected" : stats);
        return;
    }
    expect(status, SCL_OK, "values");
    printf("value %d %d\n", (int)value->number, (int)strlen(value->name));
    every_kind_right_side_values_free(value);
    expect(every_kind_right_side_values_latest(self, &value), SCL_NOTHING, "latest");
    every_kind_right_side_values_free(value);
}

static void take_tree(every_kind_right_side *self)
{
    Kinds__Tree *tree;
    scl_status status = every_kind_right_side_trees_recv(self, &tree, 0);
    if (status != SCL_OK) {
        printf("tree %s\n", scl_status_name(status));
        return;
    }
    printf("tree %d %d\n", (int)tree->number, (int)tree->n_branches);
    every_kind_right_side_trees_free(tree);
}

static void answer(every_kind_right_side *self)
{
    every_kind_right_side_answer_request request;
    Part__Part part = PART__PART__INIT;
    expect(every_kind_right_side_answer_take_request(self, &request, 0), SCL_OK, "answer");
    printf("question %d\n", (int)request.message->number);
    expect(every_kind_right_side_answer_reply(&request, NULL), SCL_ARGUMENT, "NULL reply");
    part.state = PART__PART__STATE__SOUND;
    expect(every_kind_right_side_answer_reply(&request, &part), SCL_OK, "reply");
    expect(every_kind_right_side_answer_reply(&request, &part), SCL_ARGUMENT, "second reply");
    every_kind_right_side_answer_free(&request);
}

static void answer_raw(every_kind_right_side *self)
{
    every_kind_right_side_raw_answer_request request;
    expect(every_kind_right_side_raw_answer_take_request(self, &request, 0), SCL_OK, "raw_answer");
    printf("raw question %.*s\n", (int)request.size, (const char *)request.data);
    expect(every_kind_right_side_raw_answer_reply(&request, request.data, request.size), SCL_OK, "reply");
}

static void answer_json(every_kind_right_side *self)
{
    every_kind_right_side_json_answer_request request;
    expect(every_kind_right_side_json_answer_take_request(self, &request, 0), SCL_OK, "json_answer");
    expect(every_kind_right_side_json_answer_reply(&request, "{\"state\":\"SOUND\"}", 17), SCL_OK, "reply");
}

static int right(void)
{
    const uint64_t gates = EVERY_KIND_RIGHT_SIDE_VALUES + EVERY_KIND_RIGHT_SIDE_FROM + EVERY_KIND_RIGHT_SIDE_ANSWER +
                           EVERY_KIND_RIGHT_SIDE_RAW_IN + EVERY_KIND_RIGHT_SIDE_RAW_JOBS +
                           EVERY_KIND_RIGHT_SIDE_RAW_ANSWER + EVERY_KIND_RIGHT_SIDE_JSON_ANSWER +
                           EVERY_KIND_RIGHT_SIDE_TREES;
    every_kind_right_side self;
    uint64_t ready;
    scl_status status;
    expect(every_kind_right_side_open(&self, NULL), SCL_OK, "open");
    say("open");
    while ((status = every_kind_right_side_wait(&self, gates, -1, &ready)) == SCL_OK) {
        Kinds__GPSFix__InnerPart *part;
        scl_message *bytes;
        if (ready & EVERY_KIND_RIGHT_SIDE_VALUES) {
            take_values(&self);
        }
        if (ready & EVERY_KIND_RIGHT_SIDE_FROM) {
            expect(every_kind_right_side_from_recv(&self, &part, 0), SCL_OK, "from");
            printf("part %.1f\n", part->latitude);
            every_kind_right_side_from_free(part);
        }
        if (ready & EVERY_KIND_RIGHT_SIDE_ANSWER) {
            answer(&self);
        }
        if (ready & EVERY_KIND_RIGHT_SIDE_RAW_IN) {
            expect(every_kind_right_side_raw_in_recv(&self, &bytes, 0), SCL_OK, "raw_in");
            say_bytes("bytes", bytes);
        }
        if (ready & EVERY_KIND_RIGHT_SIDE_RAW_JOBS) {
            expect(every_kind_right_side_raw_jobs_recv(&self, &bytes, 0), SCL_OK, "raw_jobs");
            say_bytes("bytes", bytes);
        }
        if (ready & EVERY_KIND_RIGHT_SIDE_TREES) {
            take_tree(&self);
        }
        if (ready & EVERY_KIND_RIGHT_SIDE_RAW_ANSWER) {
            answer_raw(&self);
        }
        if (ready & EVERY_KIND_RIGHT_SIDE_JSON_ANSWER) {
            answer_json(&self);
        }
        fflush(stdout);
    }
    expect(status, SCL_STOPPED, "wait");
    expect(every_kind_right_side_close(&self, SECOND), SCL_OK, "close");
    return 0;
}

int main(int count, char **arguments)
{
    return count > 1 && strcmp(arguments[1], "left") == 0 ? left() : right();
}
