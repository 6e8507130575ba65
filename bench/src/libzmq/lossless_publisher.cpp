// Publishes through libzmq without losing messages: with ZMQ_XPUB_NODROP a full queue makes the publisher wait.
//
// Arguments: endpoint, message size, messages per batch. Sends one batch for each line on standard input. Its messages
// start with the time at which the batch is sent, in nanoseconds of CLOCK_MONOTONIC, big endian.

#include <zmq.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

static void check(int result, const char *operation) {
    if (result < 0) {
        std::fprintf(stderr, "libzmq: %s: %s\n", operation, zmq_strerror(zmq_errno()));
        std::exit(1);
    }
}

static void write_time(std::vector<unsigned char> &message) {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    uint64_t nanoseconds = uint64_t(now.tv_sec) * 1000000000u + uint64_t(now.tv_nsec);
    for (int index = 7; index >= 0; --index, nanoseconds >>= 8) {
        message[index] = static_cast<unsigned char>(nanoseconds);
    }
}

static void report(const char *line) {
    std::puts(line);
    std::fflush(stdout);
}

int main(int argc, char **argv) {
    if (argc != 4 || std::atoi(argv[2]) < 8) {
        std::fputs("this program is used internally by `scl bench`\n", stderr);
        return 2;
    }
    std::vector<unsigned char> message(std::atoi(argv[2]));
    long batch = std::atol(argv[3]);
    void *socket = zmq_socket(zmq_ctx_new(), ZMQ_XPUB);
    int no_drop = 1;
    check(zmq_setsockopt(socket, ZMQ_XPUB_NODROP, &no_drop, sizeof no_drop), "ZMQ_XPUB_NODROP");
    check(zmq_bind(socket, argv[1]), "bind");
    report("listening");
    char subscription[16];
    check(zmq_recv(socket, subscription, sizeof subscription, 0), "receive a subscription");
    report("subscribed");
    while (std::getchar() != EOF) {
        write_time(message);
        for (long index = 0; index < batch; ++index) {
            check(zmq_send(socket, message.data(), message.size(), 0), "send");
        }
    }
    return 0;
}
