/*
 * The values of the autopilot that can be changed while it runs. `configuration` keeps them; the autopilot flies
 * without it.
 */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include "geodesy.h"
#include "parameter_table.h"

/* Fields, names and defaults. */
#define PARAMETERS(X) \
    /* Angular rates to torque: the difference of motor set-points for 1 rad/s, its integral and its derivative. */ \
    X(rate_p, "rate.roll_pitch.p", 0.06) \
    X(rate_i, "rate.roll_pitch.i", 0.1) \
    X(rate_d, "rate.roll_pitch.d", 0.001) \
    X(yaw_rate_p, "rate.yaw.p", 0.15) \
    X(yaw_rate_i, "rate.yaw.i", 0.1) \
    /* Attitude to angular rates: rad/s for 1 rad. */ \
    X(attitude_p, "attitude.p", 6.0) \
    X(yaw_p, "attitude.yaw.p", 2.0) \
    /* Velocity to acceleration, horizontally and vertically: m/s^2 for 1 m/s, and for 1 m of its integral. */ \
    X(velocity_p, "velocity.p", 2.5) \
    X(velocity_i, "velocity.i", 0.8) \
    X(climb_p, "climb.p", 4.0) \
    X(climb_i, "climb.i", 2.0) \
    /* Position to velocity: m/s for 1 m. */ \
    X(position_p, "position.p", 1.0) \
    X(height_p, "height.p", 1.5) \
    /* Estimation: how fast each correction acts, 1/s, and the integrals, 1/s^2. */ \
    X(attitude_correction, "estimation.attitude.p", 2.0) \
    X(gyro_bias_correction, "estimation.attitude.i", 0.2) \
    X(position_correction, "estimation.position.p", 0.5) \
    X(velocity_correction, "estimation.velocity.p", 0.8) \
    X(bias_correction, "estimation.velocity.i", 0.1) \
    X(height_correction, "estimation.height.bandwidth", 2.5) \
    X(barometer_correction, "estimation.barometer.p", 0.3) \
    /* Thrust of each motor, 0 to 1. */ \
    X(thrust_hover, "thrust.hover", 0.45) \
    X(thrust_minimum, "thrust.minimum", 0.1) \
    X(thrust_maximum, "thrust.maximum", 0.9) \
    X(limit_tilt, "limit.tilt", 25.0) /* degrees */ \
    X(limit_speed, "limit.speed", 4.0) /* m/s */ \
    X(limit_climb, "limit.climb", 1.5) /* m/s, up and down */ \
    X(limit_acceleration, "limit.acceleration", 1.5) /* m/s^2 */ \
    X(limit_yaw_rate, "limit.yaw_rate", 60.0) /* degrees/s */ \
    X(land_speed, "land.speed", 0.5) /* m/s, in the last metres */ \
    X(fence_radius, "fence.radius", 100.0) /* m from home */ \
    X(fence_height, "fence.height", 30.0) /* m above home */ \
    X(home_latitude, "home.latitude", 50.6866) /* degrees */ \
    X(home_longitude, "home.longitude", 10.9190) /* degrees */ \
    X(home_altitude, "home.altitude", 480.0) /* m above mean sea level */

typedef struct parameters {
#define FIELD(field, name, default_value) double field;
    PARAMETERS(FIELD)
#undef FIELD
} parameters;

parameters parameters_default(void);

/* Takes over those values that the autopilot has. */
void parameters_read(parameters *self, const Arcade__Parameters *message);

home parameters_home(const parameters *self);

#endif
