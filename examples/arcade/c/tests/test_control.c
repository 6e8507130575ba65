/* The controllers against known physics. */
#include "check.h"
#include "control.h"
#include "position.h"
#include "tests.h"

static const double BEAT = 1.0 / 300.0;

static void at_the_set_point_the_thrust_carries_the_weight(void) {
    parameters parameters = parameters_default();
    velocity_controller velocity = {0};
    rate_controller rates = {0};
    thrust thrust = control_velocity(&velocity, &(set_point){0}, (vector){0}, (vector){0}, false, &parameters, BEAT);
    demand demand = control_rates(&rates, &thrust, QUATERNION_IDENTITY, (vector){0}, (vector){0}, &parameters, BEAT);
    CHECK_NEAR(thrust.force.z, GRAVITY, 1e-12);
    CHECK_NEAR(demand.thrust, parameters.tuning.thrust_hover, 1e-12);
    CHECK_NEAR(fabs(demand.roll) + fabs(demand.pitch) + fabs(demand.yaw), 0.0, 1e-12);
}

/* A target east of a vehicle that looks north is to its right, so its left side has to rise: positive roll. */
static void the_vehicle_tilts_towards_the_target(void) {
    parameters parameters = parameters_default();
    velocity_controller velocity = {0};
    rate_controller rates = {0};
    set_point east = {.position = {.x = 1.0}, .yaw = 1.5707963267948966};
    quaternion north = quaternion_from_angles((vector){.z = east.yaw});
    thrust thrust = control_velocity(&velocity, &east, (vector){0}, (vector){0}, false, &parameters, BEAT);
    vector angles = quaternion_angles(thrust.attitude);
    CHECK_NEAR(angles.x, atan2(thrust.force.x, GRAVITY), 1e-9);
    CHECK_NEAR(angles.y, 0.0, 1e-9);
    CHECK(control_rates(&rates, &thrust, north, (vector){0}, (vector){0}, &parameters, BEAT).roll > 0.0);
}

static void the_tilt_is_limited(void) {
    parameters parameters = parameters_default();
    velocity_controller velocity = {0};
    set_point far = {.position = {1000.0, -1000.0, 0.0}};
    thrust thrust = control_velocity(&velocity, &far, (vector){0}, (vector){-8.0, 8.0, 0.0}, false, &parameters, BEAT);
    CHECK_NEAR(acos(quaternion_up(thrust.attitude).z), radians(parameters.tuning.limit_tilt), 1e-9);
    CHECK(velocity.integral.x == 0.0); /* no windup */
}

/* A steady wind is an acceleration that only the integral can balance. */
static void the_integral_balances_a_steady_wind(void) {
    parameters parameters = parameters_default();
    velocity_controller self = {0};
    vector position = {0}, velocity = {0};
    const double wind = 0.75; /* m/s^2 */
    for (int beat = 0; beat < 300 * 30; beat++) {
        thrust thrust = control_velocity(&self, &(set_point){0}, position, velocity, false, &parameters, BEAT);
        velocity.x += (thrust.force.x + wind) * BEAT;
        velocity.z += (thrust.force.z - GRAVITY) * BEAT;
        position = vector_add(position, vector_scale(velocity, BEAT));
    }
    CHECK_NEAR(position.x, 0.0, 0.01);
    CHECK_NEAR(self.integral.x, -wind, 0.01);
}

static void without_position_only_the_learned_wind_is_held_against(void) {
    parameters parameters = parameters_default();
    velocity_controller self = {.integral = {.x = -0.5}};
    set_point far = {.position = {.x = 50.0}};
    thrust thrust = control_velocity(&self, &far, (vector){0}, (vector){0}, true, &parameters, BEAT);
    CHECK_NEAR(thrust.force.x, -0.5, 1e-12);
    CHECK(self.integral.x == -0.5);
}

/* The set-point's rotation error decays to zero, for a body of the simulator's inertia and motors without delay. */
static void an_attitude_error_dies_away(void) {
    parameters parameters = parameters_default();
    rate_controller self = {0};
    thrust upright = {.force = {.z = GRAVITY}, .attitude = QUATERNION_IDENTITY};
    quaternion attitude = quaternion_from_angles((vector){0.3, -0.2, 0.5});
    vector rates = {0};
    /* Of 1 in the set-points: 4 motors of 6.5 N, at 0.225 m / sqrt(2) from the axes; 0.016 N m of yaw for each N. */
    const double arm = 0.225 / sqrt(2.0), newtons = 4.0 * 6.5;
    for (int beat = 0; beat < 300 * 10; beat++) {
        demand demand = control_rates(&self, &upright, attitude, rates, (vector){0}, &parameters, BEAT);
        vector acceleration = {demand.roll * newtons * arm / 0.012, demand.pitch * newtons * arm / 0.012,
                               demand.yaw * newtons * 0.016 / 0.022};
        rates = vector_add(rates, vector_scale(acceleration, BEAT));
        attitude = quaternion_multiply(attitude, quaternion_from_rotation_vector(vector_scale(rates, BEAT)));
    }
    CHECK_NEAR(vector_length(quaternion_angles(attitude)), 0.0, 0.02);
}

static void an_axis_at_its_limit_keeps_its_integral_and_no_others(void) {
    parameters parameters = parameters_default();
    thrust turned = {.force = {.z = GRAVITY}, .attitude = quaternion_from_angles((vector){0.3, 0.0, 0.3})};
    rate_controller self = {0};
    vector missed_yaw = {.z = -0.1};
    control_rates(&self, &turned, QUATERNION_IDENTITY, (vector){0}, missed_yaw, &parameters, BEAT);
    CHECK(self.integral.x > 0.0 && self.integral.z == 0.0);
    /* It is only kept from growing in the direction in which the motors could not follow. */
    vector passed_yaw = {.z = 0.1};
    control_rates(&self, &turned, QUATERNION_IDENTITY, (vector){0}, passed_yaw, &parameters, BEAT);
    CHECK(self.integral.z > 0.0);
}

void test_control(void) {
    at_the_set_point_the_thrust_carries_the_weight();
    the_vehicle_tilts_towards_the_target();
    the_tilt_is_limited();
    the_integral_balances_a_steady_wind();
    without_position_only_the_learned_wind_is_held_against();
    an_attitude_error_dies_away();
    an_axis_at_its_limit_keeps_its_integral_and_no_others();
}
