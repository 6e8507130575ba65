/* SCL in C, by its plain calls: `scl_c client|echo PLAN`, where PLAN is the JSON file of `scl plan`. */
#include "client.h"

#include <scl.h>
#include <string.h>

struct client {
    scl_gate *ping, *pong;
};

static bool exchange(void *context) {
    const struct client *client = context;
    static const char payload[BYTES];
    scl_message *message;
    if (scl_send(client->ping, payload, sizeof payload, -1) != SCL_OK ||
        scl_recv(client->pong, -1, &message) != SCL_OK) {
        return false;
    }
    scl_message_free(message);
    return true;
}

static bool echo(scl_gate *ping, scl_gate *pong) {
    scl_message *message;
    while (scl_recv(ping, -1, &message) == SCL_OK) {
        size_t len;
        const void *data = scl_message_data(message, &len);
        scl_status sent = scl_send(pong, data, len, -1);
        scl_message_free(message);
        if (sent != SCL_OK) {
            return false;
        }
    }
    return true;
}

static bool run(const char *component, const char *plan) {
    scl_component *opened;
    if (scl_open(plan, strlen(plan), component, NULL, &opened) != SCL_OK) {
        return false;
    }
    scl_gate *ping = scl_gate_by_name(opened, "ping"), *pong = scl_gate_by_name(opened, "pong");
    bool done;
    if (strcmp(component, "echo") == 0) {
        done = echo(ping, pong);
    } else {
        struct client client = {ping, pong};
        done = scl_ready(opened, 10 * INT64_C(1000000000)) == SCL_OK && measure_batches(exchange, &client);
    }
    return scl_close(opened, 0) == SCL_OK && done;
}

int main(int argc, char **argv) {
    static char plan[1 << 16];
    FILE *file = argc == 3 ? fopen(argv[2], "r") : NULL;
    if (file == NULL || fread(plan, 1, sizeof plan - 1, file) == 0) {
        fprintf(stderr, "usage: scl_c client|echo PLAN\n");
        return 2;
    }
    fclose(file);
    if (!run(argv[1], plan)) {
        fprintf(stderr, "scl_c: %s\n", scl_error());
        return 1;
    }
    return 0;
}
