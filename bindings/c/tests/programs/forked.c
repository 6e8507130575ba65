/* A forked child can use nothing of its parent, and harms nothing: `forked PLAN_FILE`. */
#include "support.h"
#include <sys/wait.h>
#include <unistd.h>

static void in_child(const char *plan, scl_component *component, scl_gate *out, scl_gate *values, scl_gate *answer,
                     scl_message *received) {
    scl_message *message;
    scl_request *request;
    scl_component *again;
    uint64_t ready, missed;
    char text[8];
    size_t len;
    EXPECT(scl_send(out, "x", 1, 0), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_recv(values, FOREVER, &message), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_latest(values, &message), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_take_missed(values, &missed), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_take_request(answer, FOREVER, &request), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_wait(component, &values, 1, FOREVER, &ready), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_stats(out, text, sizeof text, &len), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_ready(component, FOREVER), SCL_FORKED, "belongs to the parent process");
    EXPECT(scl_close(component, FOREVER), SCL_FORKED, "belongs to the parent process");
    ASSERT(scl_gate_by_name(component, "out") == NULL);
    ASSERT(scl_fd(component) == -1);
    ASSERT(!scl_is_connected(out));
    /* A received message is only memory, of which the child has a copy. */
    ASSERT(scl_message_data(received, &len) != NULL && len == 5);
    scl_message_free(received);
    /* The component runs in the parent; another one may be opened here. */
    EXPECT(open_program(plan, NULL, &again), SCL_TAKEN, "is already running");
    OK(open_program(plan, "{\"system\": \"other\"}", &again));
    EXPECT(scl_recv(scl_gate_by_name(again, "values"), 0, &message), SCL_NOTHING, "no message");
    OK(scl_close(again, 0));
}

int main(int count, char **arguments) {
    scl_component *component;
    scl_message *received;
    int status;
    if (count != 2) {
        return 2;
    }
    OK(open_program(arguments[1], NULL, &component));
    scl_gate *out = scl_gate_by_name(component, "out"), *values = scl_gate_by_name(component, "values");
    scl_gate *answer = scl_gate_by_name(component, "answer");
    OK(scl_recv(values, FOREVER, &received));
    pid_t child = fork();
    if (child == 0) {
        in_child(arguments[1], component, out, values, answer, received);
        _exit(0);
    }
    ASSERT(waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0);
    scl_message_free(received);
    OK(scl_send(out, "still here", 10, FOREVER));
    OK(scl_close(component, FOREVER));
    say("done");
    return 0;
}
