/* Plays `left` or `right` of `topologies/matrix/matrix.yaml`: `matrix COMPONENT`, or, with the plan of another
 * topology, `matrix COMPONENT PLAN_FILE`. The commands are those of all programs in `languages`. */
#include "../common.h"
#include "matrix_scl.h"

#include <unistd.h>

static const int64_t FOREVER = -1, SECOND = 1000000000, MILLISECOND = 1000000;

/* Ends the program after a stop request, closing the component first; any other error ends it as a failure. */
static void check(scl_status status, scl_component *component) {
    if (status == SCL_OK) {
        return;
    }
    if (status == SCL_STOPPED) {
        exit(scl_close(component, SECOND) == SCL_OK ? 0 : 1);
    }
    printf("%s: %s\n", scl_status_name(status), scl_error());
    exit(1);
}

static void say_ready(scl_component *component, const command *given) {
    scl_status status = scl_ready(component, (int64_t)number_of(given, 1) * MILLISECOND);
    if (status == SCL_OK) {
        say("ready");
        return;
    }
    printf("error: ");
    for (const char *letter = scl_error(); *letter != 0; letter++) {
        putchar(*letter == '\n' ? ' ' : *letter);
    }
    say("");
}

static void say_account(scl_gate *gate) {
    char json[4096];
    size_t size;
    if (scl_stats(gate, json, sizeof json, &size) != SCL_OK) {
        say(scl_error());
        return;
    }
    const char *names[] = {"\"sent\":", "\"received\":", "\"rejected\":"};
    for (int name = 0; name < 3; name++) {
        const char *found = strstr(json, names[name]);
        printf("%s%llu", name == 0 ? "" : " ", found == NULL ? 0 : strtoull(found + strlen(names[name]), NULL, 10));
    }
    say("");
}

static Matrix__Sample sample(uint64_t number, char text[LONGEST]) {
    Matrix__Sample made = MATRIX__SAMPLE__INIT;
    text_of(number, text);
    made.number = number;
    made.text = text;
    return made;
}

static void add_sample(ranges *found, const Matrix__Sample *sample) {
    char text[LONGEST];
    text_of(sample->number, text);
    if (strcmp(sample->text, text) == 0) {
        add(found, sample->number);
    }
}

static void add_bytes(ranges *found, const void *data, size_t size) {
    uint64_t number;
    if (number_in(data, size, &number)) {
        add(found, number);
    }
}

static void add_message(ranges *found, scl_message *message) {
    size_t size;
    const void *data = scl_message_data(message, &size);
    add_bytes(found, data, size);
    scl_message_free(message);
}

static scl_status send_one(matrix_left *left, const command *given, uint64_t number) {
    char text[LONGEST], json[LONGEST];
    Matrix__Sample message = sample(number, text);
    if (is(given, 1, "pub_protobuf")) {
        return matrix_left_pub_protobuf_send(left, &message, FOREVER);
    } else if (is(given, 1, "push_protobuf")) {
        return matrix_left_push_protobuf_send(left, &message, FOREVER);
    } else if (is(given, 1, "pub_json")) {
        return matrix_left_pub_json_send(left, json, json_of(number, json), FOREVER);
    } else if (is(given, 1, "push_json")) {
        return matrix_left_push_json_send(left, json, json_of(number, json), FOREVER);
    } else if (is(given, 1, "pub_bytes")) {
        return matrix_left_pub_bytes_send(left, text, strlen(text), FOREVER);
    } else if (is(given, 1, "pub_latched_bytes")) {
        return matrix_left_pub_latched_bytes_send(left, text, strlen(text), FOREVER);
    }
    return matrix_left_push_bytes_send(left, text, strlen(text), FOREVER);
}

static scl_status call_one(matrix_left *left, const command *given, uint64_t number, ranges *found) {
    char text[LONGEST], json[LONGEST];
    scl_message *reply;
    scl_status status;
    if (is(given, 1, "req_protobuf")) {
        Matrix__Sample request = sample(number, text), *sample_reply;
        status = matrix_left_req_protobuf_call(left, &request, &sample_reply, FOREVER);
        if (status == SCL_OK) {
            add_sample(found, sample_reply);
            matrix_left_req_protobuf_free(sample_reply);
        }
        return status;
    } else if (is(given, 1, "req_json")) {
        status = matrix_left_req_json_call(left, json, json_of(number, json), &reply, FOREVER);
    } else {
        status = matrix_left_req_bytes_call(left, text, text_of(number, text), &reply, FOREVER);
    }
    if (status == SCL_OK) {
        add_message(found, reply);
    }
    return status;
}

static int play_left(void) {
    matrix_left left;
    check(matrix_left_open(&left, NULL), NULL);
    say("open");
    for (command given; next_command(&given);) {
        scl_gate *gate = scl_gate_by_name(left.component, given.words[1]);
        uint64_t from = number_of(&given, 2), to = number_of(&given, 3);
        ranges found = no_ranges();
        if (is(&given, 0, "ready")) {
            say_ready(left.component, &given);
        } else if (is(&given, 0, "send")) {
            for (uint64_t number = from; number < to; number++) {
                check(send_one(&left, &given, number), left.component);
            }
            say("sent");
        } else if (is(&given, 0, "call")) {
            for (uint64_t number = from; number < to; number++) {
                check(call_one(&left, &given, number, &found), left.component);
            }
            say_ranges(&found);
        } else if (is(&given, 0, "gone")) {
            while (scl_is_connected(gate)) {
                usleep(1000);
            }
            say("gone");
        } else {
            say_account(gate);
        }
    }
    return matrix_left_close(&left, SECOND) == SCL_OK ? 0 : 1;
}

static scl_status take_one(matrix_right *right, const command *given, ranges *found) {
    Matrix__Sample *received = NULL;
    scl_message *message = NULL;
    scl_status status;
    if (is(given, 1, "sub_protobuf")) {
        status = matrix_right_sub_protobuf_recv(right, &received, FOREVER);
    } else if (is(given, 1, "pull_protobuf")) {
        status = matrix_right_pull_protobuf_recv(right, &received, FOREVER);
    } else if (is(given, 1, "sub_json")) {
        status = matrix_right_sub_json_recv(right, &message, FOREVER);
    } else if (is(given, 1, "pull_json")) {
        status = matrix_right_pull_json_recv(right, &message, FOREVER);
    } else if (is(given, 1, "sub_bytes")) {
        status = matrix_right_sub_bytes_recv(right, &message, FOREVER);
    } else if (is(given, 1, "sub_latched_bytes")) {
        status = matrix_right_sub_latched_bytes_recv(right, &message, FOREVER);
    } else {
        status = matrix_right_pull_bytes_recv(right, &message, FOREVER);
    }
    if (status == SCL_OK && received != NULL) {
        add_sample(found, received);
        matrix_right_sub_protobuf_free(received);
    } else if (status == SCL_OK) {
        add_message(found, message);
    }
    return status;
}

static scl_status serve_one(matrix_right *right, const command *given, ranges *found) {
    char text[LONGEST];
    uint64_t number = 0;
    scl_status status;
    if (is(given, 1, "rep_protobuf")) {
        matrix_right_rep_protobuf_request request;
        status = matrix_right_rep_protobuf_take_request(right, &request, FOREVER);
        if (status != SCL_OK) {
            return status;
        }
        add_sample(found, request.message);
        Matrix__Sample reply = sample(request.message->number + REPLY, text);
        return matrix_right_rep_protobuf_reply(&request, &reply);
    } else if (is(given, 1, "rep_json")) {
        matrix_right_rep_json_request request;
        status = matrix_right_rep_json_take_request(right, &request, FOREVER);
        if (status != SCL_OK) {
            return status;
        }
        add_bytes(found, request.data, request.size);
        number_in(request.data, request.size, &number);
        return matrix_right_rep_json_reply(&request, text, json_of(number + REPLY, text));
    }
    matrix_right_rep_bytes_request request;
    status = matrix_right_rep_bytes_take_request(right, &request, FOREVER);
    if (status != SCL_OK) {
        return status;
    }
    add_bytes(found, request.data, request.size);
    number_in(request.data, request.size, &number);
    return matrix_right_rep_bytes_reply(&request, text, text_of(number + REPLY, text));
}

/* Whether the last message is latched. Its age is an hour at most, in the right unit. */
static void say_age(const scl_gate *gate) {
    int64_t age = scl_latched_age(gate);
    say(age == -1 ? "new" : 0 < age && age < 3600 * SECOND ? "latched" : "wrong age");
}

static int play_right(void) {
    matrix_right right;
    check(matrix_right_open(&right, NULL), NULL);
    say("open");
    for (command given; next_command(&given);) {
        ranges found = no_ranges();
        bool serves = is(&given, 0, "serve");
        if (is(&given, 0, "ready")) {
            say_ready(right.component, &given);
        } else if (serves || is(&given, 0, "take")) {
            for (uint64_t left = number_of(&given, 2); left > 0; left--) {
                scl_status status = (serves ? serve_one : take_one)(&right, &given, &found);
                if (status == SCL_DECODE) {
                    say("undecodable");
                } else {
                    check(status, right.component);
                }
            }
            say_ranges(&found);
        } else if (is(&given, 0, "age")) {
            say_age(scl_gate_by_name(right.component, given.words[1]));
        } else {
            say_account(scl_gate_by_name(right.component, given.words[1]));
        }
    }
    return matrix_right_close(&right, SECOND) == SCL_OK ? 0 : 1;
}

/* Only opens, and tells why it does not find its peers. */
static int play_plan(const char *component, const char *path) {
    static char plan[1 << 20];
    FILE *file = fopen(path, "rb");
    size_t size = file == NULL ? 0 : fread(plan, 1, sizeof plan, file);
    scl_component *opened;
    check(scl_open(plan, size, component, NULL, &opened), NULL);
    say("open");
    for (command given; next_command(&given);) {
        say_ready(opened, &given);
    }
    return scl_close(opened, SECOND) == SCL_OK ? 0 : 1;
}

int main(int count, char **arguments) {
    if (count > 2) {
        return play_plan(arguments[1], arguments[2]);
    }
    return strcmp(arguments[1], "left") == 0 ? play_left() : play_right();
}
