/*
 * From readings to set-points of the motors, once per inertial reading. Everything depends on messages and the times in
 * them alone, not on clocks or the order of arrival, so a recorded flight can be repeated exactly, also by the twin in
 * Rust, which has the same files.
 */
#ifndef FLIGHT_CONTROLLER_H
#define FLIGHT_CONTROLLER_H

#include "attitude.h"
#include "commands.h"
#include "control.h"
#include "navigation.h"
#include "pending.h"
#include "position.h"

/* The whole state of the autopilot, without pointers: its bytes are what is kept for a restart in the air. */
typedef struct flight_controller {
    uint64_t time_us; /* of the last reading; 0 before the first */
    parameters parameters;
    attitude_estimator attitude;
    position_estimator position;
    navigator navigator;
    velocity_controller velocity_controller;
    rate_controller rate_controller;
    double thrust;     /* the mean set-point of the motors at the last beat */
    vector cut;        /* by how much the motors missed roll, pitch and yaw at the last beat */
    uint32_t restarts; /* how often the autopilot was started again in the air */
    pending heights, fixes, commands;
    bool has_new_parameters;
    parameters new_parameters;
} flight_controller;

/* What one beat results in. */
typedef struct outputs {
    double motors[4]; /* front left, front right, rear left, rear right */
    bool flight_due;  /* it is time for a message `Flight` */
} outputs;

flight_controller flight_controller_new(const arcade_autopilot_parameters *tuning);

/* Takes a height or a fix, which take effect a fixed time after they were measured. */
void flight_controller_receive_height(flight_controller *self, const Arcade__Height *message);
void flight_controller_receive_fix(flight_controller *self, const Arcade__Fix *message);

/* Takes parameters of its own, or limits, which take effect at the next whole second. */
void flight_controller_receive_tuning(flight_controller *self, const arcade_autopilot_parameters *tuning);
void flight_controller_receive_limits(flight_controller *self, const Arcade__Limits *message);

/*
 * Takes a command, which takes effect at a time of its own, and returns whether it is accepted. A command that is
 * repeated because its result was lost is accepted again, without effect.
 */
bool flight_controller_receive_command(flight_controller *self, const Arcade__Command *message,
                                       char reason[COMMANDS_REASON_SIZE]);

/* Works one beat. Returns false, and does nothing, for a reading that is not newer than the last. */
bool flight_controller_step(flight_controller *self, const Arcade__Inertial *message, outputs *outputs);

estimate flight_controller_estimate(const flight_controller *self);

/* Whether a state saved at `self->time_us` can be carried on with at the time of a reading. */
bool flight_controller_can_resume(const flight_controller *self, uint64_t reading_us);

#endif
