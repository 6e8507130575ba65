/* The loop of the autopilot between its gates, in one process. */
#include "autopilot.h"
#include "check.h"
#include "tests.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const int64_t SECOND = 1000000000; /* ns */
static const uint64_t START_US = 1000000;
enum { BEAT_US = 3333 };

/* An autopilot and the other ends of its gates. */
typedef struct scene {
    autopilot autopilot;
    arcade_autopilot_peer peer;
} scene;

static void send_limits(scene *self) {
    limits limits = parameters_default().limits;
    Arcade__Limits message = ARCADE__LIMITS__INIT;
    message.home_latitude = limits.home.latitude;
    message.home_longitude = limits.home.longitude;
    message.fence_radius = limits.fence_radius;
    message.fence_height = limits.fence_height;
    message.speed = limits.speed;
    message.climb = limits.climb;
    CHECK(arcade_autopilot_peer_limits_send(&self->peer, &message, SECOND) == SCL_OK);
}

/* `path`: of the state file, or NULL to do without. */
static scene *open_scene(const char *path) {
    scene *self = calloc(1, sizeof *self);
    CHECK(self != NULL && arcade_autopilot_test(&self->autopilot.gates, &self->peer) == SCL_OK);
    if (path != NULL) {
        CHECK(resume_open(&self->autopilot.state, path, sizeof(flight_controller)));
    }
    autopilot_begin(&self->autopilot);
    send_limits(self);
    return self;
}

/* Like a crash: nothing is saved or sent at the end. */
static void close_scene(scene *self) {
    resume_close(&self->autopilot.state);
    arcade_autopilot_close(&self->autopilot.gates, 0);
    arcade_autopilot_peer_close(&self->peer, 0);
    free(self);
}

static void send_reading(scene *self, uint64_t time_us) {
    Arcade__Vector gravity = ARCADE__VECTOR__INIT;
    Arcade__Inertial reading = ARCADE__INERTIAL__INIT;
    gravity.z = GRAVITY;
    reading.time_us = time_us;
    reading.acceleration = &gravity;
    CHECK(arcade_autopilot_peer_imu_send(&self->peer, &reading, SECOND) == SCL_OK);
}

static void send_fix(scene *self, uint64_t time_us) {
    Arcade__Fix fix = ARCADE__FIX__INIT;
    fix.time_us = time_us;
    fix.quality = ARCADE__FIX_QUALITY__FIX_QUALITY_3D;
    fix.latitude = 50.6866;
    fix.longitude = 10.9190;
    CHECK(arcade_autopilot_peer_fix_send(&self->peer, &fix, SECOND) == SCL_OK);
}

/* Turns the loop until the motors have their set-point, which the caller frees. */
static Arcade__Motors *turn_until_motors(scene *self) {
    Arcade__Motors *motors = NULL;
    scl_status status;
    while ((status = arcade_autopilot_peer_motors_recv(&self->peer, &motors, 0)) == SCL_NOTHING) {
        CHECK(autopilot_turn(&self->autopilot) == SCL_OK);
    }
    CHECK(status == SCL_OK);
    return motors;
}

static void run_beat(scene *self, uint64_t time_us) {
    send_reading(self, time_us);
    Arcade__Motors *motors = turn_until_motors(self);
    CHECK(motors->time_us == time_us);
    arcade_autopilot_peer_motors_free(motors);
}

static void run_beats(scene *self, uint64_t from_us, uint64_t until_us) {
    for (uint64_t time_us = from_us; time_us < until_us; time_us += BEAT_US) {
        run_beat(self, time_us);
    }
}

/* A call from another thread, while this one turns the loop. */
typedef struct call {
    scene *scene;
    const Arcade__Command *command;
    Arcade__CommandResult *result;
    atomic_bool done;
} call;

static void *make_call(void *argument) {
    call *self = argument;
    CHECK(arcade_autopilot_peer_control_call(&self->scene->peer, self->command, &self->result, -1) == SCL_OK);
    atomic_store(&self->done, true);
    return NULL;
}

/* Sends a command to take off. Its result is freed by the caller. */
static Arcade__CommandResult *call_take_off(scene *self) {
    Arcade__Vector target = ARCADE__VECTOR__INIT;
    Arcade__Command command = ARCADE__COMMAND__INIT;
    call call = {.scene = self, .command = &command};
    pthread_t thread;
    target.z = 5.0;
    command.id = 101;
    command.action = ARCADE__ACTION__ACTION_TAKE_OFF;
    command.target = &target;
    CHECK(pthread_create(&thread, NULL, make_call, &call) == 0);
    while (!atomic_load(&call.done)) {
        CHECK(autopilot_turn(&self->autopilot) == SCL_OK);
    }
    pthread_join(thread, NULL);
    return call.result;
}

static void each_reading_is_answered_by_set_points_and_a_beat(void) {
    scene *self = open_scene(NULL);
    send_reading(self, START_US);
    Arcade__Motors *motors = turn_until_motors(self);
    CHECK(motors->time_us == START_US && motors->front_left == 0.0 && motors->rear_right == 0.0);
    arcade_autopilot_peer_motors_free(motors);
    Arcade__Beat *beat;
    CHECK(arcade_autopilot_peer_beats_recv(&self->peer, &beat, SECOND) == SCL_OK);
    CHECK(beat->time_us == START_US && beat->began_ns > 0 && beat->took_ns > 0);
    arcade_autopilot_peer_beats_free(beat);
    close_scene(self);
}

/* A turn that was delayed has several readings to catch up with. */
static void readings_that_waited_are_all_answered(void) {
    scene *self = open_scene(NULL);
    for (uint64_t beat = 0; beat < 5; beat++) {
        send_reading(self, START_US + beat * BEAT_US);
    }
    for (uint64_t beat = 0; beat < 5; beat++) {
        Arcade__Motors *motors = turn_until_motors(self);
        CHECK(motors->time_us == START_US + beat * BEAT_US);
        arcade_autopilot_peer_motors_free(motors);
    }
    close_scene(self);
}

static void a_command_is_answered_without_readings(void) {
    scene *self = open_scene(NULL);
    CHECK(autopilot_turn(&self->autopilot) == SCL_OK);
    Arcade__CommandResult *result = call_take_off(self);
    CHECK(!result->accepted);
    CHECK(strcmp(result->reason, "no inertial readings") == 0);
    arcade_autopilot_peer_control_free(result);
    close_scene(self);
}

static void missing_readings_are_noticed(void) {
    scene *self = open_scene(NULL);
    CHECK(autopilot_turn(&self->autopilot) == SCL_OK);
    CHECK(self->autopilot.silent);
    run_beat(self, START_US);
    CHECK(!self->autopilot.silent);
    close_scene(self);
}

static void a_clock_that_begins_anew_starts_on_the_ground(void) {
    scene *self = open_scene(NULL);
    run_beat(self, 100 * START_US);
    run_beat(self, START_US);
    CHECK(self->autopilot.controller.time_us == START_US);
    close_scene(self);
}

/* The newest message of the flight. */
static Arcade__Flight *receive_flight(scene *self) {
    Arcade__Flight *flight = NULL;
    CHECK(arcade_autopilot_peer_flight_latest(&self->peer, &flight) == SCL_OK);
    return flight;
}

static void a_killed_autopilot_goes_on_in_the_air(const char *path) {
    scene *self = open_scene(path);
    send_fix(self, START_US);
    run_beats(self, START_US, START_US + 200000);
    self->autopilot.last_reading_ns = UINT64_MAX / 2; /* however slow this machine is, readings are not missing */
    Arcade__CommandResult *result = call_take_off(self);
    CHECK(result->accepted && strcmp(result->reason, "") == 0);
    arcade_autopilot_peer_control_free(result);
    run_beats(self, START_US + 200000, START_US + 500000);
    close_scene(self);

    self = open_scene(path);
    run_beats(self, START_US + 800000, START_US + 900000);
    Arcade__Flight *flight = receive_flight(self);
    CHECK(flight->restarts == 1);
    CHECK(flight->mode == ARCADE__MODE__MODE_TAKING_OFF && flight->command_id == 101 && flight->target->z == 5.0);
    CHECK(flight->position_valid);
    arcade_autopilot_peer_flight_free(flight);
    close_scene(self);

    self = open_scene(path); /* more than 2 s later */
    run_beats(self, START_US + 2900000, START_US + 3000000);
    flight = receive_flight(self);
    CHECK(flight->restarts == 0 && flight->mode == ARCADE__MODE__MODE_GROUNDED);
    arcade_autopilot_peer_flight_free(flight);
    close_scene(self);
}

void test_beats(void) {
    char path[] = "/tmp/arcade-check-XXXXXX";
    int file = mkstemp(path);
    CHECK(file >= 0);
    close(file);
    each_reading_is_answered_by_set_points_and_a_beat();
    readings_that_waited_are_all_answered();
    a_command_is_answered_without_readings();
    missing_readings_are_noticed();
    a_clock_that_begins_anew_starts_on_the_ground();
    a_killed_autopilot_goes_on_in_the_air(path);
    unlink(path);
}
