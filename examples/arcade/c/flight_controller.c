/* From readings to set-points of the motors, once per inertial reading. */
#include "flight_controller.h"

#include <string.h>

/* Measurements take effect this long after their time, so that they arrive before. */
static const uint64_t HEIGHT_DELAY_US = 20000;
static const uint64_t FIX_DELAY_US = 60000;
static const uint64_t FLIGHT_RATE = 30; /* messages a second */
/* A longer time between two readings, s, is a gap: readings were lost, or the autopilot was started again. */
static const double GAP = 0.02;
static const uint64_t LONGEST_GAP_US = 2000000; /* after a longer gap, the state is of no use */

flight_controller flight_controller_new(const arcade_autopilot_parameters *tuning) {
    return (flight_controller){.parameters.tuning = *tuning, .attitude = attitude_new()};
}

void flight_controller_receive_height(flight_controller *self, const Arcade__Height *message) {
    pending_message height = {.height = height_from_message(message)};
    pending_insert(&self->heights, message->time_us + HEIGHT_DELAY_US, height);
}

void flight_controller_receive_fix(flight_controller *self, const Arcade__Fix *message) {
    pending_message fix = {.fix = fix_from_message(message)};
    pending_insert(&self->fixes, message->time_us + FIX_DELAY_US, fix);
}

/* Those that take effect at the next whole second. */
static parameters *new_parameters(flight_controller *self) {
    if (!self->has_new_parameters) {
        self->new_parameters = self->parameters;
        self->has_new_parameters = true;
    }
    return &self->new_parameters;
}

void flight_controller_receive_tuning(flight_controller *self, const arcade_autopilot_parameters *tuning) {
    new_parameters(self)->tuning = *tuning;
}

void flight_controller_receive_limits(flight_controller *self, const Arcade__Limits *message) {
    new_parameters(self)->limits = limits_from_message(message);
}

static situation situation_of(const flight_controller *self) {
    return (situation){
        .mode = self->navigator.mode,
        .height = self->position.position.z,
        .position_valid = position_is_valid(&self->position, self->time_us),
    };
}

static bool is_known(const flight_controller *self, uint32_t id) {
    bool known = id == self->navigator.command_id;
    for (size_t index = 0; index < self->commands.count; index++) {
        known = known || self->commands.messages[index].command.id == id;
    }
    return known;
}

bool flight_controller_receive_command(flight_controller *self, const Arcade__Command *message,
                                       char reason[COMMANDS_REASON_SIZE]) {
    command command = command_from_message(message);
    if (command.id != 0 && is_known(self, command.id)) {
        return true;
    }
    if (!commands_check(&command, situation_of(self), &self->parameters, reason)) {
        return false;
    }
    pending_insert(&self->commands, command.effective_us, (pending_message){.command = command});
    return true;
}

/* Brings the estimates to the time of the reading. Returns the step for the controllers, s. */
static double update_estimates(flight_controller *self, const inertial_reading *reading, uint64_t before) {
    double elapsed = before == 0 ? 0.0 : (double)(reading->time_us - before) * 1e-6;
    bool gap = before == 0 || elapsed > GAP;
    if (gap) {
        attitude_reset(&self->attitude, reading->rates, reading->angles);
        position_coast(&self->position, reading->time_us, self->attitude.attitude, elapsed);
        self->rate_controller.rates = self->attitude.rates;
    } else {
        attitude_update(&self->attitude, reading->rates, reading->angles, elapsed, &self->parameters);
        position_predict(&self->position, reading->time_us, reading->acceleration, self->attitude.attitude, elapsed);
    }
    pending_message message;
    while (pending_take_due(&self->heights, reading->time_us, &message)) {
        position_correct_height(&self->position, &message.height, &self->parameters);
    }
    while (pending_take_due(&self->fixes, reading->time_us, &message)) {
        position_correct_fix(&self->position, &message.fix, &self->parameters);
    }
    return gap ? GAP : elapsed;
}

/* The situation may have changed since a command was accepted, so it is checked again. */
static void begin_commands(flight_controller *self, const estimate *estimate) {
    char reason[COMMANDS_REASON_SIZE];
    pending_message message;
    while (pending_take_due(&self->commands, self->time_us, &message)) {
        if (commands_check(&message.command, situation_of(self), &self->parameters, reason)) {
            navigation_begin(&self->navigator, &message.command, estimate, &self->parameters);
        }
    }
}

/* Motors off, or idling: the controllers start from nothing. */
static void rest(flight_controller *self, double motors[4], double set_point) {
    self->velocity_controller = (velocity_controller){0};
    self->rate_controller = (rate_controller){.rates = self->attitude.rates};
    self->cut = (vector){0};
    for (int motor = 0; motor < 4; motor++) {
        motors[motor] = set_point;
    }
}

static void fly(flight_controller *self, double motors[4], bool level, double elapsed) {
    const parameters *parameters = &self->parameters;
    thrust thrust = control_velocity(&self->velocity_controller, &self->navigator.set_point, self->position.position,
                                     self->position.velocity, level, parameters, elapsed);
    demand demand = control_rates(&self->rate_controller, &thrust, self->attitude.attitude, self->attitude.rates,
                                  self->cut, parameters, elapsed);
    mixed mixed = mixer_mix(&demand);
    self->cut = mixed.cut;
    memcpy(motors, mixed.motors, sizeof mixed.motors);
}

static void control(flight_controller *self, double motors[4], drive drive, double elapsed) {
    if (drive == DRIVE_OFF || drive == DRIVE_IDLE) {
        rest(self, motors, drive == DRIVE_OFF ? 0.0 : self->parameters.tuning.thrust_minimum);
    } else {
        fly(self, motors, drive == DRIVE_FLY_LEVEL, elapsed);
    }
    self->thrust = 0.25 * (motors[0] + motors[1] + motors[2] + motors[3]);
}

estimate flight_controller_estimate(const flight_controller *self) {
    return (estimate){
        .position = self->position.position,
        .velocity = self->position.velocity,
        .yaw = quaternion_angles(self->attitude.attitude).z,
        .position_valid = position_is_valid(&self->position, self->time_us),
        .thrust = self->thrust,
    };
}

/* The clock has gone back: the simulated world began anew. */
static void start_anew(flight_controller *self) {
    parameters newest = *new_parameters(self);
    *self = flight_controller_new(&newest.tuning);
    self->parameters = newest;
}

bool flight_controller_step(flight_controller *self, const Arcade__Inertial *message, outputs *outputs) {
    inertial_reading reading = inertial_from_message(message);
    uint64_t now = reading.time_us;
    if (now + LONGEST_GAP_US < self->time_us) {
        start_anew(self);
    }
    uint64_t before = self->time_us;
    if (now <= before) {
        return false;
    }
    self->time_us = now;
    /* Not at once: when they arrive depends on the machine, and a recorded flight is to be repeated exactly. */
    bool whole_second = before / 1000000 != now / 1000000;
    if (whole_second && self->has_new_parameters) {
        self->parameters = self->new_parameters;
        self->has_new_parameters = false;
    }
    double elapsed = update_estimates(self, &reading, before);
    estimate estimate = flight_controller_estimate(self);
    begin_commands(self, &estimate);
    drive drive = navigation_update(&self->navigator, &estimate, &self->parameters, elapsed);
    control(self, outputs->motors, drive, elapsed);
    outputs->flight_due = before * FLIGHT_RATE / 1000000 != now * FLIGHT_RATE / 1000000;
    return true;
}

bool flight_controller_can_resume(const flight_controller *self, uint64_t reading_us) {
    return self->navigator.mode != ARCADE__MODE__MODE_GROUNDED && reading_us > self->time_us &&
           reading_us - self->time_us <= LONGEST_GAP_US;
}
