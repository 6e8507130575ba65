/* Plays `left` or `right` of `topologies/matrix/matrix.yaml` with nothing but libzmq (and protobuf-c for the messages):
 * `matrix COMPONENT GATE=ENDPOINT...`, with the endpoints of `scl generate --for zmq`. The commands are those of all
 * programs in `languages`; a plain program has no counts and does not refuse anything. */
#include "../common.h"
#include "matrix.pb-c.h"

#include <zmq.h>

enum { GATES = 10 };

typedef struct {
    const char *name;
    void *socket;
    /* Tells when a connection breaks. */
    void *monitor;
} gate;

static gate gates[GATES];
static int gate_count = 0;

static void fail(const char *what) {
    printf("%s: %s\n", what, zmq_strerror(zmq_errno()));
    exit(1);
}

static bool begins(const char *text, const char *start) { return strncmp(text, start, strlen(start)) == 0; }

static int socket_type(const char *gate) {
    // Of a publisher, XPUB, because it tells who has subscribed.
    static const struct {
        const char *kind;
        int type;
    } types[] = {{"pub_", ZMQ_XPUB}, {"sub_", ZMQ_SUB}, {"push_", ZMQ_PUSH}, {"pull_", ZMQ_PULL}, {"req_", ZMQ_REQ}};
    for (size_t index = 0; index < sizeof types / sizeof *types; index++) {
        if (begins(gate, types[index].kind)) {
            return types[index].type;
        }
    }
    return ZMQ_REP;
}

static void open_gate(void *context, char *argument) {
    char *endpoint = strchr(argument, '='), monitored[64];
    *endpoint++ = 0;
    int type = socket_type(argument), on = 1, off = 0;
    bool binds = type == ZMQ_XPUB || type == ZMQ_PULL || type == ZMQ_REP;
    gate *opened = &gates[gate_count++];
    opened->name = argument;
    opened->socket = zmq_socket(context, type);
    snprintf(monitored, sizeof monitored, "inproc://monitor-%d", gate_count);
    zmq_socket_monitor(opened->socket, monitored, ZMQ_EVENT_DISCONNECTED);
    opened->monitor = zmq_socket(context, ZMQ_PAIR);
    zmq_connect(opened->monitor, monitored);
    if (type == ZMQ_PUSH || type == ZMQ_REQ) {
        // No message goes to a peer that is not there. A subscriber with this option would lose its subscription.
        zmq_setsockopt(opened->socket, ZMQ_IMMEDIATE, &on, sizeof on);
    }
    // What is queued when the program ends is still sent to a peer that is there.
    zmq_setsockopt(opened->socket, ZMQ_LINGER, &(int){1000}, sizeof(int));
    zmq_setsockopt(opened->socket, ZMQ_SNDHWM, &off, sizeof off);
    zmq_setsockopt(opened->socket, ZMQ_RCVHWM, &off, sizeof off);
    if (type == ZMQ_XPUB) {
        zmq_setsockopt(opened->socket, ZMQ_XPUB_VERBOSE, &on, sizeof on);
    } else if (type == ZMQ_SUB) {
        zmq_setsockopt(opened->socket, ZMQ_SUBSCRIBE, "", 0);
    }
    if ((binds ? zmq_bind(opened->socket, endpoint) : zmq_connect(opened->socket, endpoint)) != 0) {
        fail(endpoint);
    }
}

static gate *find(const command *given) {
    for (int index = 0; index < gate_count; index++) {
        if (is(given, 1, gates[index].name)) {
            return &gates[index];
        }
    }
    printf("no gate %s\n", given->words[1]);
    exit(1);
}

/* Receives a frame, and returns its length. */
static size_t receive(void *socket, uint8_t frame[LONGEST]) {
    int size = zmq_recv(socket, frame, LONGEST, 0);
    if (size < 0) {
        fail("recv");
    }
    return (size_t)size;
}

static void transmit(void *socket, const void *frame, size_t size) {
    if (zmq_send(socket, frame, size, 0) < 0) {
        fail("send");
    }
}

static size_t encode(const gate *gate, uint64_t number, uint8_t frame[LONGEST]) {
    char text[LONGEST];
    if (strstr(gate->name, "_json") != NULL) {
        return json_of(number, (char *)frame);
    } else if (strstr(gate->name, "_bytes") != NULL) {
        return text_of(number, (char *)frame);
    }
    Matrix__Sample sample = MATRIX__SAMPLE__INIT;
    text_of(number, text);
    sample.number = number;
    sample.text = text;
    return matrix__sample__pack(&sample, frame);
}

static bool decode(const gate *gate, const uint8_t *frame, size_t size, uint64_t *number) {
    char text[LONGEST];
    if (strstr(gate->name, "_protobuf") == NULL) {
        return number_in(frame, size, number);
    }
    Matrix__Sample *sample = matrix__sample__unpack(NULL, size, frame);
    if (sample == NULL) {
        return false;
    }
    *number = sample->number;
    text_of(*number, text);
    bool right = strcmp(sample->text, text) == 0;
    matrix__sample__free_unpacked(sample, NULL);
    return right;
}

/* A publisher waits for a subscription at each of its gates. What connects sends as soon as it is connected. */
static void wait_until_ready(void) {
    uint8_t frame[LONGEST];
    for (int index = 0; index < gate_count; index++) {
        if (begins(gates[index].name, "pub_")) {
            do {
                receive(gates[index].socket, frame);
            } while (frame[0] != 1);
        }
    }
}

static void follow(const command *given) {
    uint8_t frame[LONGEST];
    uint64_t number, from = number_of(given, 2), to = number_of(given, 3);
    ranges found = no_ranges();
    if (is(given, 0, "ready")) {
        wait_until_ready();
        say("ready");
        return;
    }
    gate *used = find(given);
    if (is(given, 0, "gone")) {
        receive(used->monitor, frame);
        receive(used->monitor, frame);
        say("gone");
    } else if (is(given, 0, "send")) {
        for (number = from; number < to; number++) {
            transmit(used->socket, frame, encode(used, number, frame));
        }
        say("sent");
    } else if (is(given, 0, "garbage")) {
        // A field of wire type 7, which there is not; and no JSON either.
        transmit(used->socket, "\xff\xff\xff", 3);
        say("sent");
    } else if (is(given, 0, "call")) {
        for (uint64_t sent = from; sent < to; sent++) {
            transmit(used->socket, frame, encode(used, sent, frame));
            if (decode(used, frame, receive(used->socket, frame), &number)) {
                add(&found, number);
            }
        }
        say_ranges(&found);
    } else {
        for (uint64_t taken = 0; taken < from; taken++) {
            if (decode(used, frame, receive(used->socket, frame), &number)) {
                add(&found, number);
            }
            if (is(given, 0, "serve")) {
                transmit(used->socket, frame, encode(used, number + REPLY, frame));
            }
        }
        say_ranges(&found);
    }
}

/* Waits for the next command. Meanwhile each socket is looked at now and then, because libzmq renews a subscription
 * only in a call of its socket. */
static void wait_for_command(void) {
    zmq_pollitem_t input = {.fd = 0, .events = ZMQ_POLLIN};
    while (zmq_poll(&input, 1, 10) == 0) {
        for (int index = 0; index < gate_count; index++) {
            int events;
            zmq_getsockopt(gates[index].socket, ZMQ_EVENTS, &events, &(size_t){sizeof events});
        }
    }
}

int main(int count, char **arguments) {
    void *context = zmq_ctx_new();
    for (int index = 2; index < count; index++) {
        open_gate(context, arguments[index]);
    }
    say("open");
    command given;
    for (wait_for_command(); next_command(&given); wait_for_command()) {
        follow(&given);
    }
    for (int index = 0; index < gate_count; index++) {
        zmq_close(gates[index].monitor);
        zmq_close(gates[index].socket);
    }
    zmq_ctx_term(context);
    return 0;
}
