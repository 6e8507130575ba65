/* Makes the calls that its input names, one per line, and prints what comes back: `commands PLAN_FILE COMPONENT OPTIONS`. */
#include "support.h"

static scl_component *component;
static scl_request *request;

static void answer(scl_status status, const void *data, size_t len) {
    if (status == SCL_OK) {
        printf("%.*s\n", (int)len, data == NULL ? "" : (const char *)data);
    } else {
        printf("%s: %s\n", scl_status_name(status), scl_error());
    }
    fflush(stdout);
}

static void answer_message(scl_status status, scl_message *message) {
    size_t len;
    const void *data = scl_message_data(message, &len);
    answer(status, data, len);
    scl_message_free(message);
}

static scl_gate *gate(void) {
    const char *name = strtok(NULL, " ");
    return scl_gate_by_name(component, name == NULL ? "" : name);
}

static int64_t number(void) {
    const char *text = strtok(NULL, " ");
    return text == NULL ? FOREVER : strtoll(text, NULL, 10);
}

static const char *rest(void) {
    const char *text = strtok(NULL, "");
    return text == NULL ? "" : text;
}

static void wait_for_gates(void) {
    scl_gate *gates[8];
    size_t count = 0;
    uint64_t ready;
    char text[24];
    int64_t timeout = number();
    for (const char *name = strtok(NULL, " "); name != NULL && count < 8; name = strtok(NULL, " ")) {
        gates[count++] = scl_gate_by_name(component, name);
    }
    scl_status status = scl_wait(component, gates, count, timeout, &ready);
    answer(status, text, (size_t)snprintf(text, sizeof text, "%llu", (unsigned long long)ready));
}

static void receive_into(void) {
    char buffer[64];
    char text[32];
    size_t len;
    scl_gate *from = gate();
    int64_t timeout = number();
    scl_status status = scl_recv_into(from, buffer, (size_t)number(), &len, timeout);
    if (status == SCL_BUFFER) {
        answer(SCL_OK, text, (size_t)snprintf(text, sizeof text, "%zu needed", len));
    } else {
        answer(status, buffer, len);
    }
}

static void send_made_in_place(void) {
    void *buffer;
    scl_gate *to = gate();
    int64_t timeout = number();
    const char *text = rest();
    scl_status status = scl_buffer(to, strlen(text), &buffer);
    if (status == SCL_OK) {
        memcpy(buffer, text, strlen(text));
        status = scl_send(to, buffer, strlen(text), timeout);
    }
    answer(status, NULL, 0);
}

static void reply_made_in_place(void) {
    void *buffer;
    const char *text = rest();
    scl_status status = scl_reply_buffer(request, strlen(text), &buffer);
    if (status == SCL_OK) {
        memcpy(buffer, text, strlen(text));
        status = scl_reply(request, buffer, strlen(text));
        request = NULL;
    }
    answer(status, NULL, 0);
}

static void send_much(void) {
    scl_gate *to = gate();
    int64_t timeout = number();
    size_t len = (size_t)number();
    char *data = calloc(len, 1);
    answer(scl_send(to, data, len, timeout), NULL, 0);
    free(data);
}

static void statistics(void) {
    char text[1024];
    size_t len;
    scl_status status = scl_stats(gate(), text, sizeof text, &len);
    answer(status, text, len);
}

static void obey(const char *command) {
    scl_message *message = NULL;
    size_t len = 0;
    if (strcmp(command, "send") == 0) {
        scl_gate *to = gate();
        int64_t timeout = number();
        const char *text = rest();
        answer(scl_send(to, text, strlen(text), timeout), NULL, 0);
    } else if (strcmp(command, "recv") == 0) {
        scl_gate *from = gate();
        scl_status status = scl_recv(from, number(), &message);
        answer_message(status, message);
    } else if (strcmp(command, "latest") == 0) {
        scl_status status = scl_latest(gate(), &message);
        answer_message(status, message);
    } else if (strcmp(command, "call") == 0) {
        scl_gate *over = gate();
        int64_t timeout = number();
        const char *text = rest();
        scl_status status = scl_call(over, text, strlen(text), timeout, &message);
        answer_message(status, message);
    } else if (strcmp(command, "take") == 0) {
        scl_gate *from = gate();
        scl_status status = scl_take_request(from, number(), &request);
        const void *data = scl_request_data(request, &len);
        answer(status, data, len);
    } else if (strcmp(command, "reply") == 0) {
        const char *text = rest();
        scl_status status = scl_reply(request, text, strlen(text));
        request = NULL;
        answer(status, NULL, 0);
    } else if (strcmp(command, "drop") == 0) {
        scl_request_free(request);
        request = NULL;
        answer(SCL_OK, NULL, 0);
    } else if (strcmp(command, "into") == 0) {
        receive_into();
    } else if (strcmp(command, "send_in_place") == 0) {
        send_made_in_place();
    } else if (strcmp(command, "reply_in_place") == 0) {
        reply_made_in_place();
    } else if (strcmp(command, "send_much") == 0) {
        send_much();
    } else if (strcmp(command, "stats") == 0) {
        statistics();
    } else if (strcmp(command, "wait") == 0) {
        wait_for_gates();
    } else if (strcmp(command, "ready") == 0) {
        answer(scl_ready(component, number()), NULL, 0);
    } else if (strcmp(command, "connected") == 0) {
        answer(SCL_OK, scl_is_connected(gate()) ? "yes" : "no", 3);
    } else if (strcmp(command, "stopping") == 0) {
        answer(SCL_OK, scl_stop_requested() ? "yes" : "no", 3);
    } else if (strcmp(command, "handle_stop") == 0) {
        scl_handle_stop();
        answer(SCL_OK, NULL, 0);
    } else if (strcmp(command, "close") == 0) {
        answer(scl_close(component, number()), NULL, 0);
    } else {
        answer(SCL_OK, "unknown command", 15);
    }
}

int main(int count, char **arguments) {
    char line[1024];
    size_t len;
    if (count != 4) {
        return 2;
    }
    char *plan = read_file(arguments[1], &len);
    scl_status status = scl_open(plan, len, arguments[2], arguments[3], &component);
    free(plan);
    answer(status, "open", 4);
    while (status == SCL_OK && fgets(line, sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = 0;
        const char *command = strtok(line, " ");
        obey(command == NULL ? "" : command);
    }
    scl_request_free(request);
    scl_close(component, SECOND);
    return 0;
}
