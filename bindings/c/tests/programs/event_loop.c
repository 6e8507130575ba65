/* An event loop with epoll, which serves gates and a stop request: `event_loop PLAN_FILE`. */
#include "support.h"
#include <errno.h>
#include <sys/epoll.h>
#include <unistd.h>

static void serve(scl_gate *values, scl_gate *work, scl_gate *answer) {
    scl_message *message;
    scl_request *request;
    size_t len;
    while (scl_recv(values, 0, &message) == SCL_OK) {
        const char *data = scl_message_data(message, &len);
        printf("value %.*s\n", (int)len, data);
        scl_message_free(message);
    }
    while (scl_recv(work, 0, &message) == SCL_OK) {
        const char *data = scl_message_data(message, &len);
        printf("job %.*s\n", (int)len, data);
        scl_message_free(message);
    }
    while (scl_take_request(answer, 0, &request) == SCL_OK) {
        const char *data = scl_request_data(request, &len);
        printf("request %.*s\n", (int)len, data);
        OK(scl_reply(request, data, len));
    }
    fflush(stdout);
}

int main(int count, char **arguments) {
    scl_component *component;
    struct epoll_event event = {.events = EPOLLIN};
    if (count != 2) {
        return 2;
    }
    OK(open_program(arguments[1], NULL, &component));
    scl_gate *values = scl_gate_by_name(component, "values"), *work = scl_gate_by_name(component, "work");
    scl_gate *answer = scl_gate_by_name(component, "answer");
    int loop = epoll_create1(EPOLL_CLOEXEC), fd = scl_fd(component);
    ASSERT(fd >= 0 && scl_fd(component) == fd);
    ASSERT(epoll_ctl(loop, EPOLL_CTL_ADD, fd, &event) == 0);
    /* Nothing has arrived, so nothing is readable. */
    ASSERT(epoll_wait(loop, &event, 1, 0) == 0);
    say("waiting");
    while (!scl_stop_requested()) {
        int found = epoll_wait(loop, &event, 1, -1);
        ASSERT(found == 1 || (found < 0 && errno == EINTR));
        serve(values, work, answer);
    }
    OK(scl_close(component, SECOND));
    close(loop);
    say("stopped");
    return 0;
}
