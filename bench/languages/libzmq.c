/* Raw libzmq: `libzmq client|echo FOLDER`, over sockets in that folder. */
#include "client.h"

#include <string.h>
#include <zmq.h>

struct client {
    void *ping, *pong;
};

static bool exchange(void *context) {
    const struct client *client = context;
    char payload[BYTES] = {0};
    return zmq_send(client->ping, payload, sizeof payload, 0) == BYTES &&
           zmq_recv(client->pong, payload, sizeof payload, 0) == BYTES;
}

/* Both sides bind where they publish. A subscription that has arrived is the first message of an XPUB socket. */
static bool await_subscriber(void *publisher) {
    char subscription[2];
    return zmq_recv(publisher, subscription, sizeof subscription, 0) == 1;
}

static bool run(bool is_client, const char *folder) {
    char endpoint[200];
    void *context = zmq_ctx_new();
    void *sending = zmq_socket(context, ZMQ_XPUB), *receiving = zmq_socket(context, ZMQ_SUB);
    snprintf(endpoint, sizeof endpoint, "ipc://%s/%s", folder, is_client ? "ping" : "pong");
    if (zmq_bind(sending, endpoint) != 0) {
        return false;
    }
    snprintf(endpoint, sizeof endpoint, "ipc://%s/%s", folder, is_client ? "pong" : "ping");
    zmq_setsockopt(receiving, ZMQ_SUBSCRIBE, "", 0);
    if (zmq_connect(receiving, endpoint) != 0 || !await_subscriber(sending)) {
        return false;
    }
    if (is_client) {
        struct client client = {sending, receiving};
        return measure_batches(exchange, &client);
    }
    char payload[BYTES];
    while (zmq_recv(receiving, payload, sizeof payload, 0) == BYTES) {
        zmq_send(sending, payload, sizeof payload, 0);
    }
    return true;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: libzmq client|echo FOLDER\n");
        return 2;
    }
    if (!run(strcmp(argv[1], "client") == 0, argv[2])) {
        fprintf(stderr, "libzmq: %s\n", zmq_strerror(zmq_errno()));
        return 1;
    }
    return 0;
}
