/*
 * Control: position P, velocity PI with feed-forward, attitude P on quaternions, rates PID, as PX4's multicopter
 * controllers; the attitude law is that of Brescianini, Hehn and D'Andrea, Nonlinear Quadrocopter Attitude Control,
 * 2013. Integrators stop where an actuator has reached its limit (Astrom and Hagglund, PID Controllers, 1995, section
 * 3.5), each axis for itself and in that direction only, as the saturation flags of PX4's rate controller have it: with
 * the yaw at its limit, roll and pitch are still trimmed.
 */
#include "control.h"

#include "position.h"

static const double MAX_RATE = 3.5;                  /* rad/s, of rates set by the attitude controller */
static const double MAX_TORQUE_INTEGRAL = 0.1;       /* a difference of motor set-points */
static const double MAX_ACCELERATION_INTEGRAL = 4.0; /* m/s^2 */
static const double DERIVATIVE_TIME = 0.008;         /* s, of the low-pass filter of the differentiated rates */

/* The velocity that leads back to the set-point while it moves. */
static vector wanted_velocity(const set_point *set_point, vector position, const parameters *parameters) {
    vector error = vector_subtract(set_point->position, position);
    vector wanted = {
        set_point->velocity.x + parameters->tuning.position_p * error.x,
        set_point->velocity.y + parameters->tuning.position_p * error.y,
        set_point->velocity.z + parameters->tuning.height_p * error.z,
    };
    double speed = vector_horizontal(wanted);
    if (speed > parameters->limits.speed) {
        wanted.x *= parameters->limits.speed / speed;
        wanted.y *= parameters->limits.speed / speed;
    }
    wanted.z = limit(wanted.z, parameters->limits.climb);
    return wanted;
}

/* Limits the vertical force by the motors' thrust, and then the horizontal force by the tilt. */
static vector limit_force(vector force, const parameters *parameters) {
    double per_thrust = GRAVITY / parameters->tuning.thrust_hover;
    double z = clamp(force.z, parameters->tuning.thrust_minimum * per_thrust, parameters->tuning.thrust_maximum * per_thrust);
    double most = z * tan(radians(parameters->tuning.limit_tilt));
    double horizontal = vector_horizontal(force);
    double kept = horizontal > most ? most / horizontal : 1.0;
    return (vector){force.x * kept, force.y * kept, z};
}

/* The attitude with the body's z axis along `force`, turned to `yaw`. */
static quaternion attitude_along(vector force, double yaw) {
    vector up = vector_scale(force, 1.0 / vector_length(force));
    quaternion tilt = quaternion_normalize((quaternion){.w = 1.0 + up.z, .x = -up.y, .y = up.x, .z = 0.0});
    return quaternion_multiply(tilt, quaternion_from_angles((vector){0.0, 0.0, yaw}));
}

/* Grows the integral unless that would push further beyond a limit that was reached. */
static void integrate(velocity_controller *self, vector error, vector cut, const parameters *parameters,
                      double elapsed) {
    double horizontal = parameters->tuning.velocity_i * elapsed;
    self->integral.x += cut.x * error.x < 0.0 ? 0.0 : error.x * horizontal;
    self->integral.y += cut.y * error.y < 0.0 ? 0.0 : error.y * horizontal;
    self->integral.z += cut.z * error.z < 0.0 ? 0.0 : error.z * (parameters->tuning.climb_i * elapsed);
    self->integral.x = limit(self->integral.x, MAX_ACCELERATION_INTEGRAL);
    self->integral.y = limit(self->integral.y, MAX_ACCELERATION_INTEGRAL);
    self->integral.z = limit(self->integral.z, MAX_ACCELERATION_INTEGRAL);
}

thrust control_velocity(velocity_controller *self, const set_point *set_point, vector position, vector velocity,
                        bool level, const parameters *parameters, double elapsed) {
    vector error = vector_subtract(wanted_velocity(set_point, position, parameters), velocity);
    vector force = vector_add(set_point->acceleration, self->integral);
    force.z += parameters->tuning.climb_p * error.z + GRAVITY;
    if (level) {
        error = (vector){0.0, 0.0, error.z};
        force.x = self->integral.x;
        force.y = self->integral.y;
    }
    force.x += parameters->tuning.velocity_p * error.x;
    force.y += parameters->tuning.velocity_p * error.y;

    vector limited = limit_force(force, parameters);
    integrate(self, error, vector_subtract(limited, force), parameters, elapsed);
    return (thrust){.force = limited, .attitude = attitude_along(limited, set_point->yaw)};
}

/* Rates that turn the body to the wanted attitude, in body axes. */
static vector wanted_rates(quaternion wanted, quaternion attitude, const parameters *parameters) {
    vector error = quaternion_rotation_vector(quaternion_multiply(quaternion_conjugate(attitude), wanted));
    return (vector){
        limit(parameters->tuning.attitude_p * error.x, MAX_RATE),
        limit(parameters->tuning.attitude_p * error.y, MAX_RATE),
        limit(parameters->tuning.yaw_p * error.z, radians(parameters->tuning.limit_yaw_rate)),
    };
}

/* Grows the integral of an axis unless that would push further in the direction in which the motors could not follow. */
static double integrate_rate(double integral, double error, double cut, double gain) {
    double grown = cut * error < 0.0 ? integral : integral + error * gain;
    return limit(grown, MAX_TORQUE_INTEGRAL);
}

demand control_rates(rate_controller *self, const thrust *thrust, quaternion attitude, vector rates, vector cut,
                     const parameters *parameters, double elapsed) {
    vector error = vector_subtract(wanted_rates(thrust->attitude, attitude, parameters), rates);
    self->integral.x = integrate_rate(self->integral.x, error.x, cut.x, parameters->tuning.rate_i * elapsed);
    self->integral.y = integrate_rate(self->integral.y, error.y, cut.y, parameters->tuning.rate_i * elapsed);
    self->integral.z = integrate_rate(self->integral.z, error.z, cut.z, parameters->tuning.yaw_rate_i * elapsed);
    vector slope = vector_scale(vector_subtract(rates, self->rates), 1.0 / elapsed);
    vector change = vector_scale(vector_subtract(slope, self->derivative), elapsed / (DERIVATIVE_TIME + elapsed));
    self->derivative = vector_add(self->derivative, change);
    self->rates = rates;
    /* The part of the force that the motors give now, while the body still turns to its direction. */
    double along = vector_dot(thrust->force, quaternion_up(attitude)) * (parameters->tuning.thrust_hover / GRAVITY);
    return (demand){
        .thrust = clamp(along, parameters->tuning.thrust_minimum, parameters->tuning.thrust_maximum),
        .roll = parameters->tuning.rate_p * error.x + self->integral.x - parameters->tuning.rate_d * self->derivative.x,
        .pitch = parameters->tuning.rate_p * error.y + self->integral.y - parameters->tuning.rate_d * self->derivative.y,
        .yaw = parameters->tuning.yaw_rate_p * error.z + self->integral.z,
    };
}
