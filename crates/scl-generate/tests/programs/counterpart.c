/* Unit tests of a component of `testable.yaml`, as its generated code makes them possible. */
#include "testable_scl.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SECOND INT64_C(1000000000)

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "line %d: not `%s`; last error: %s\n", __LINE__, #condition, scl_error()); \
            exit(1); \
        } \
    } while (0)
#define OK(call) CHECK((call) == SCL_OK)

static testable_controller controller;
static testable_controller_peer peer;

static void send_reading(double speed)
{
    Testable__Reading reading = TESTABLE__READING__INIT;
    reading.speed = speed;
    OK(testable_controller_peer_readings_send(&peer, &reading, -1));
}

static double receive_reading(void)
{
    Testable__Reading *reading;
    OK(testable_controller_readings_recv(&controller, &reading, 60 * SECOND));
    double speed = reading->speed;
    testable_controller_readings_free(reading);
    return speed;
}

static void messages_go_both_ways(void)
{
    Testable__Setpoint setpoint = TESTABLE__SETPOINT__INIT, *received;
    scl_message *bytes;
    size_t size;
    /* It has two peers in the topology, and all of them are the one counterpart. */
    OK(testable_controller_ready(&controller, 0));
    OK(testable_controller_peer_ready(&peer, 0));
    send_reading(0.25);
    CHECK(receive_reading() == 0.25);
    setpoint.throttle = 0.75;
    OK(testable_controller_setpoints_send(&controller, &setpoint, -1));
    OK(testable_controller_peer_setpoints_recv(&peer, &received, 0));
    CHECK(received->throttle == 0.75);
    testable_controller_peer_setpoints_free(received);

    OK(testable_controller_log_send(&controller, "a line", 6, -1));
    uint64_t ready = 0;
    OK(testable_controller_peer_wait(&peer, TESTABLE_CONTROLLER_PEER_LOG, 0, &ready));
    CHECK(ready == TESTABLE_CONTROLLER_PEER_LOG);
    OK(testable_controller_peer_log_recv(&peer, &bytes, 0));
    CHECK(memcmp(scl_message_data(bytes, &size), "a line", 6) == 0 && size == 6);
    scl_message_free(bytes);
    OK(testable_controller_peer_jobs_send(&peer, "{\"speed\": 2}", 12, -1));
    OK(testable_controller_jobs_recv(&controller, &bytes, 60 * SECOND));
    CHECK(memcmp(scl_message_data(bytes, &size), "{\"speed\": 2}", 12) == 0 && size == 12);
    scl_message_free(bytes);
}

/* `queue: 1`: the newest value, also if nothing was received for a while. */
static void the_newest_reading_counts(void)
{
    for (int round = 0; round < 3; round++) {
        for (int speed = 0; speed < 100; speed++) {
            send_reading(speed);
        }
        CHECK(receive_reading() == 99);
    }
}

static void *accept_command(void *unused)
{
    testable_controller_commands_request request;
    Testable__Status status = TESTABLE__STATUS__INIT;
    OK(testable_controller_commands_take_request(&controller, &request, 60 * SECOND));
    status.accepted = request.message->target_speed < 2;
    OK(testable_controller_commands_reply(&request, &status));
    return unused;
}

static void requests_are_answered(void)
{
    Testable__Command command = TESTABLE__COMMAND__INIT;
    Testable__Status *status;
    for (int speed = 1; speed < 3; speed++) {
        pthread_t thread;
        pthread_create(&thread, NULL, accept_command, NULL);
        command.target_speed = speed;
        OK(testable_controller_peer_commands_call(&peer, &command, &status, -1));
        CHECK(status->accepted == (speed < 2));
        testable_controller_peer_commands_free(status);
        pthread_join(thread, NULL);
    }
    /* The other way, nobody answers. */
    CHECK(testable_controller_limits_call(&controller, &command, &status, -1) == SCL_TIMEOUT);
    CHECK(strstr(scl_error(), "gate `controller.limits` got no reply from `world.limits` within ") != NULL);
    testable_controller_peer_limits_request request;
    OK(testable_controller_peer_limits_take_request(&peer, &request, 0));
    testable_controller_peer_limits_free(&request);
}

static void a_gate_without_peers_is_open(void)
{
    Testable__Reading reading = TESTABLE__READING__INIT, *received;
    OK(testable_controller_spare_send(&controller, &reading, -1));
    CHECK(testable_controller_peer_spare_recv(&peer, &received, 0) == SCL_NOTHING);
}

static void *wait_for_a_reading(void *unused)
{
    Testable__Reading *reading;
    scl_status status = testable_controller_readings_recv(&controller, &reading, -1);
    CHECK(status == SCL_CLOSED || status == SCL_HANDLE || status == SCL_ARGUMENT);
    return unused;
}

static void closing_ends_calls_that_wait(void)
{
    Testable__Setpoint *setpoint;
    pthread_t thread;
    /* Nobody receives these, which is no reason to wait. */
    send_reading(1);
    CHECK(receive_reading() == 1);
    pthread_create(&thread, NULL, wait_for_a_reading, NULL);
    scl_component *component = controller.component;
    OK(scl_close(component, 0));
    pthread_join(thread, NULL);
    CHECK(testable_controller_peer_setpoints_recv(&peer, &setpoint, SECOND / 100) == SCL_TIMEOUT);
    CHECK(strstr(scl_error(), "gate `controller's peers.setpoints` received nothing from `controller.setpoints`"));
    OK(testable_controller_peer_close(&peer, 60 * SECOND));
    CHECK(peer.component == NULL && testable_controller_peer_ready(&peer, 0) == SCL_ARGUMENT);
}

static void wrong_arguments_are_refused(void)
{
    testable_empty empty;
    testable_empty_peer empty_peer;
    CHECK(testable_controller_test(NULL, &peer) == SCL_ARGUMENT && strcmp(scl_error(), "`self` is NULL") == 0);
    CHECK(testable_controller_test(&controller, NULL) == SCL_ARGUMENT && strcmp(scl_error(), "`peer` is NULL") == 0);
    OK(testable_empty_test(&empty, &empty_peer));
    OK(testable_empty_close(&empty, 0));
    OK(testable_empty_peer_close(&empty_peer, 0));
}

int main(void)
{
    /* Opened often, because any number of tests may run in one program. */
    for (int round = 0; round < 10; round++) {
        OK(testable_controller_test(&controller, &peer));
        messages_go_both_ways();
        the_newest_reading_counts();
        requests_are_answered();
        a_gate_without_peers_is_open();
        closing_ends_calls_that_wait();
    }
    wrong_arguments_are_refused();
    puts("done");
    return 0;
}
