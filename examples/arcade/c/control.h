/* Control: a cascade from position to velocity, attitude and angular rates. */
#ifndef CONTROL_H
#define CONTROL_H

#include "mixer.h"
#include "parameters.h"
#include "quaternion.h"
#include "trajectory.h"

/* The thrust that the position controller asks for. */
typedef struct thrust {
    vector force;        /* as specific force, m/s^2, in the world's axes */
    quaternion attitude; /* with the body's z axis along the force */
} thrust;

/* From position to specific force. */
typedef struct velocity_controller {
    vector integral; /* m/s^2 */
} velocity_controller;

/* `level`: the horizontal position is unknown, so only what the integral has learned of the wind is held against it. */
thrust control_velocity(velocity_controller *self, const set_point *set_point, vector position, vector velocity,
                        bool level, const parameters *parameters, double elapsed);

/* From attitude to torques. */
typedef struct rate_controller {
    vector integral;   /* differences of motor set-points */
    vector rates;      /* of the last beat, rad/s */
    vector derivative; /* filtered, rad/s^2 */
} rate_controller;

/* `cut`: by how much the motors missed roll, pitch and yaw of the last beat, see `mixed`. */
demand control_rates(rate_controller *self, const thrust *thrust, quaternion attitude, vector rates, vector cut,
                     const parameters *parameters, double elapsed);

#endif
