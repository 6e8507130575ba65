/*
 * The loop of the autopilot. It waits for nothing but the next inertial reading or request: what other gates have not
 * received yet is not waited for, and a peer that is missing does not delay a beat.
 */
#include "autopilot.h"
#include "clock.h"

#include <inttypes.h>
#include <stdio.h>

/* ns: without readings for this long the autopilot says so, and refuses commands. */
static const int64_t SILENCE = 200000000;

void autopilot_begin(autopilot *self) {
    self->controller = flight_controller_new(&self->gates.parameters);
    self->has_saved = resume_load(&self->state, &self->saved);
    self->last_reading_ns = clock_ns();
}

/* Returns true for failures that end the program. */
static bool is_fatal(scl_status status) {
    return status != SCL_OK && status != SCL_NOTHING && status != SCL_FULL && status != SCL_REQUESTER_GONE;
}

/* Takes all that other gates have received, without waiting. */
static scl_status take_inputs(autopilot *self) {
    Arcade__Height *height;
    Arcade__Fix *fix;
    Arcade__Limits *limits;
    scl_status status;
    bool changed;
    while ((status = arcade_autopilot_height_recv(&self->gates, &height, 0)) == SCL_OK) {
        flight_controller_receive_height(&self->controller, height);
        arcade_autopilot_height_free(height);
    }
    if (is_fatal(status)) {
        return status;
    }
    while ((status = arcade_autopilot_fix_recv(&self->gates, &fix, 0)) == SCL_OK) {
        flight_controller_receive_fix(&self->controller, fix);
        arcade_autopilot_fix_free(fix);
    }
    if (is_fatal(status)) {
        return status;
    }
    if ((status = arcade_autopilot_limits_latest(&self->gates, &limits)) == SCL_OK) {
        flight_controller_receive_limits(&self->controller, limits);
        arcade_autopilot_limits_free(limits);
    }
    if (is_fatal(status)) {
        return status;
    }
    status = arcade_autopilot_update_parameters(&self->gates, 0, &changed);
    if (status == SCL_OK && changed) {
        flight_controller_receive_tuning(&self->controller, &self->gates.parameters);
    }
    return status;
}

static scl_status send_motors(autopilot *self, const double motors[4]) {
    Arcade__Motors message = ARCADE__MOTORS__INIT;
    message.time_us = self->controller.time_us;
    message.front_left = motors[0];
    message.front_right = motors[1];
    message.rear_left = motors[2];
    message.rear_right = motors[3];
    return arcade_autopilot_motors_send(&self->gates, &message, 0);
}

static scl_status send_flight(autopilot *self) {
    const flight_controller *controller = &self->controller;
    const navigator *navigator = &controller->navigator;
    Arcade__Vector position = vector_to_message(controller->position.position);
    Arcade__Vector velocity = vector_to_message(controller->position.velocity);
    Arcade__Vector attitude = vector_to_message(quaternion_angles(controller->attitude.attitude));
    Arcade__Vector target = vector_to_message(navigator->target);
    Arcade__Flight message = ARCADE__FLIGHT__INIT;
    message.time_us = controller->time_us;
    message.mode = navigator->mode;
    message.command_id = navigator->command_id;
    message.position = &position;
    message.velocity = &velocity;
    message.attitude = &attitude;
    message.target = &target;
    message.target_yaw = navigator->target_yaw;
    message.position_valid = position_is_valid(&controller->position, controller->time_us);
    message.restarts = controller->restarts;
    return arcade_autopilot_flight_send(&self->gates, &message, 0);
}

static scl_status send_beat(autopilot *self, uint64_t began_ns, uint64_t sent_ns) {
    Arcade__Beat message = ARCADE__BEAT__INIT;
    message.time_us = self->controller.time_us;
    message.began_ns = began_ns;
    message.took_ns = (uint32_t)(sent_ns - began_ns);
    return arcade_autopilot_beats_send(&self->gates, &message, 0);
}

/*
 * At the first reading: carries on where the process before this one was killed, if that was in the air and a moment
 * ago.
 */
static void begin_at(autopilot *self, uint64_t reading_us) {
    if (self->has_saved && flight_controller_can_resume(&self->saved, reading_us)) {
        self->controller = self->saved;
        self->controller.parameters.tuning = self->gates.parameters;
        self->controller.has_new_parameters = false;
        self->controller.restarts++;
        self->mode = self->controller.navigator.mode;
        printf("carrying on in the air: restart %" PRIu32 "\n", self->controller.restarts);
    } else {
        printf("ready on the ground\n");
    }
    self->has_saved = false;
}

/* One line when the mode changes. */
static void report_mode(autopilot *self) {
    const navigator *navigator = &self->controller.navigator;
    vector position = self->controller.position.position;
    if (navigator->mode == self->mode) {
        return;
    }
    self->mode = navigator->mode;
    if (navigator->mode == ARCADE__MODE__MODE_TAKING_OFF) {
        printf("taking off to %.1f m\n", navigator->target.z);
    } else if (navigator->mode == ARCADE__MODE__MODE_FLYING) {
        printf("flying at %.1f m\n", position.z);
    } else if (navigator->mode == ARCADE__MODE__MODE_LANDING) {
        printf("landing from %.1f m\n", position.z);
    } else {
        printf("landed, %.2f m from home\n", vector_horizontal(position));
    }
}

static scl_status beat(autopilot *self, const Arcade__Inertial *reading, uint64_t began_ns) {
    if (self->controller.time_us == 0) {
        begin_at(self, reading->time_us);
    }
    scl_status status = take_inputs(self);
    outputs outputs;
    if (status != SCL_OK || !flight_controller_step(&self->controller, reading, &outputs)) {
        return status;
    }
    status = send_motors(self, outputs.motors);
    uint64_t sent_ns = clock_ns();
    resume_store(&self->state, &self->controller);
    if (!is_fatal(status) && outputs.flight_due) {
        status = send_flight(self);
    }
    if (!is_fatal(status)) {
        status = send_beat(self, began_ns, sent_ns);
    }
    report_mode(self);
    return is_fatal(status) ? status : SCL_OK;
}

/* Works a beat for each reading that has arrived. */
static scl_status take_readings(autopilot *self) {
    Arcade__Inertial *reading;
    scl_status status;
    while ((status = arcade_autopilot_imu_recv(&self->gates, &reading, 0)) == SCL_OK) {
        self->last_reading_ns = clock_ns();
        status = beat(self, reading, self->last_reading_ns);
        arcade_autopilot_imu_free(reading);
        if (status != SCL_OK) {
            break;
        }
    }
    return is_fatal(status) ? status : SCL_OK;
}

static bool is_silent(const autopilot *self) {
    return clock_ns() > self->last_reading_ns + (uint64_t)SILENCE;
}

static scl_status answer_requests(autopilot *self) {
    arcade_autopilot_control_request request;
    scl_status status;
    while ((status = arcade_autopilot_control_take_request(&self->gates, &request, 0)) == SCL_OK) {
        char reason[COMMANDS_REASON_SIZE] = "no inertial readings";
        Arcade__CommandResult result = ARCADE__COMMAND_RESULT__INIT;
        result.reason = reason;
        result.accepted =
            !is_silent(self) && flight_controller_receive_command(&self->controller, request.message, reason);
        if (result.accepted) {
            result.reason = "";
        } else {
            printf("command %" PRIu32 " refused: %s\n", request.message->id, reason);
        }
        status = arcade_autopilot_control_reply(&request, &result);
        if (is_fatal(status)) {
            break;
        }
    }
    return is_fatal(status) ? status : SCL_OK;
}

/* One line when readings begin to be missing. */
static void report_silence(autopilot *self) {
    bool silent = is_silent(self);
    if (silent && !self->silent) {
        printf("no inertial readings for %d ms\n", (int)(SILENCE / 1000000));
    }
    self->silent = silent;
}

scl_status autopilot_turn(autopilot *self) {
    uint64_t ready;
    scl_status status =
        arcade_autopilot_wait(&self->gates, ARCADE_AUTOPILOT_IMU | ARCADE_AUTOPILOT_CONTROL, SILENCE, &ready);
    if (status == SCL_OK) {
        status = take_readings(self);
    }
    if (status == SCL_OK) {
        status = answer_requests(self);
    }
    report_silence(self);
    return status == SCL_TIMEOUT ? SCL_OK : status;
}
