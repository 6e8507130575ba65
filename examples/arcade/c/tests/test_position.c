/* Estimates of position against known movements. */
#include "check.h"
#include "position.h"
#include "tests.h"

static const double BEAT = 1.0 / 300.0;
static const uint64_t START_US = 1000000;

static uint64_t time_of(int beat) {
    return START_US + (uint64_t)(beat * 10000 / 3);
}

/* The fix that a receiver without errors would make. */
static fix_reading fix_at(uint64_t time_us, double east, double north, double east_speed,
                          const parameters *parameters) {
    local_position position = {.east = east, .north = north};
    geodetic_position degrees = geodesy_from_local(parameters->limits.home, position);
    return (fix_reading){.time_us = time_us, .valid = true, .latitude = degrees.latitude,
                         .longitude = degrees.longitude,
                         .east_speed = east_speed};
}

/* s = a t^2 / 2 */
static void a_constant_acceleration_gives_half_a_times_t_squared(void) {
    position_estimator self = {0};
    for (int beat = 1; beat <= 600; beat++) {
        position_predict(&self, time_of(beat), (vector){.x = 2.0, .z = GRAVITY}, QUATERNION_IDENTITY, BEAT);
    }
    CHECK_NEAR(self.position.x, 4.0, 1e-9);
    CHECK_NEAR(self.velocity.x, 4.0, 1e-9);
    CHECK_NEAR(self.position.z, 0.0, 1e-9);
}

/* Body axes are turned into the world's: pitched down by 0.1 rad, thrust accelerates forward. */
static void the_force_is_turned_by_the_attitude(void) {
    position_estimator self = {0};
    quaternion pitched = quaternion_from_angles((vector){.y = 0.1, .z = 1.5707963267948966});
    position_predict(&self, START_US, (vector){.z = GRAVITY / cos(0.1)}, pitched, 0.01);
    CHECK_NEAR(self.velocity.y, GRAVITY * tan(0.1) * 0.01, 1e-12); /* it looks north */
    CHECK_NEAR(self.velocity.x, 0.0, 1e-12);
    CHECK_NEAR(self.velocity.z, 0.0, 1e-12);
}

static void the_first_fix_sets_the_position(void) {
    parameters parameters = parameters_default();
    position_estimator self = {0};
    fix_reading fix = fix_at(START_US, 12.0, -7.0, 1.5, &parameters);
    CHECK(!position_is_valid(&self, START_US));
    position_correct_fix(&self, &fix, &parameters);
    CHECK_NEAR(self.position.x, 12.0, 1e-6);
    CHECK_NEAR(self.position.y, -7.0, 1e-6);
    CHECK(self.velocity.x == 1.5);
    CHECK(position_is_valid(&self, START_US + 5000000));
    CHECK(!position_is_valid(&self, START_US + 5000001));
}

static void a_fix_without_position_or_with_nonsense_is_ignored(void) {
    parameters parameters = parameters_default();
    position_estimator self = {0};
    fix_reading none = {.time_us = START_US}, nonsense = {.time_us = START_US, .valid = true, .latitude = NAN};
    position_correct_fix(&self, &none, &parameters);
    position_correct_fix(&self, &nonsense, &parameters);
    CHECK(!position_is_valid(&self, START_US));
    CHECK(self.position.x == 0.0);
}

/* A fix is 60 ms old when it takes effect. At 5 m/s that is 0.3 m, which must not look like an error. */
static void a_late_fix_of_a_correct_estimate_changes_nothing(void) {
    parameters parameters = parameters_default();
    position_estimator self = {.velocity = {.x = 5.0}};
    fix_reading first = fix_at(START_US, 0.0, 0.0, 5.0, &parameters);
    position_correct_fix(&self, &first, &parameters);
    for (int beat = 1; beat <= 300; beat++) {
        position_predict(&self, time_of(beat), (vector){.z = GRAVITY}, QUATERNION_IDENTITY, BEAT);
        if (beat % 60 == 18) {
            fix_reading fix = fix_at(time_of(beat - 18), 5.0 * (beat - 18) * BEAT, 0.0, 5.0, &parameters);
            position_correct_fix(&self, &fix, &parameters);
        }
    }
    CHECK_NEAR(self.position.x, 5.0, 1e-3);
    CHECK_NEAR(self.velocity.x, 5.0, 1e-3);
}

static void a_bias_of_the_accelerometer_is_learned_by_fixes_and_heights(void) {
    parameters parameters = parameters_default();
    position_estimator self = {0};
    for (int beat = 1; beat <= 300 * 120; beat++) {
        position_predict(&self, time_of(beat), (vector){.x = 0.2, .z = GRAVITY - 0.1}, QUATERNION_IDENTITY, BEAT);
        if (beat % 60 == 0) {
            fix_reading fix = fix_at(time_of(beat), 0.0, 0.0, 0.0, &parameters);
            position_correct_fix(&self, &fix, &parameters);
        }
        if (beat % 15 == 0) {
            height_reading height = {.time_us = time_of(beat), .in_range = true, .ultrasonic = 2.0, .barometer = 2.0};
            position_correct_height(&self, &height, &parameters);
        }
    }
    CHECK_NEAR(self.bias.x, 0.2, 0.02);
    CHECK_NEAR(self.bias.z, -0.1, 0.01);
    CHECK_NEAR(self.position.x, 0.0, 0.1);
    CHECK_NEAR(self.position.z, 2.0, 0.02);
}

/* In range the ultrasonic sensor calibrates the barometer, which then carries on alone. */
static void the_barometer_takes_over_out_of_range(void) {
    parameters parameters = parameters_default();
    position_estimator self = {0};
    for (int beat = 1; beat <= 300 * 60; beat++) {
        bool in_range = beat < 300 * 40;
        position_predict(&self, time_of(beat), (vector){.z = GRAVITY}, QUATERNION_IDENTITY, BEAT);
        if (beat % 15 == 0) {
            height_reading height = {.time_us = time_of(beat), .in_range = in_range, .ultrasonic = 3.0,
                                     .barometer = 4.5};
            position_correct_height(&self, &height, &parameters);
        }
    }
    CHECK_NEAR(self.barometer_offset, 1.5, 0.01);
    CHECK_NEAR(self.position.z, 3.0, 0.02);
}

/* The ultrasonic sensor measures along the body's axis: tilted, it shows too much. */
static void a_tilted_range_is_corrected(void) {
    parameters parameters = parameters_default();
    position_estimator self = {0};
    quaternion tilted = quaternion_from_angles((vector){.x = 0.4});
    vector at_rest = {.y = GRAVITY * sin(0.4), .z = GRAVITY * cos(0.4)};
    for (int beat = 1; beat <= 300 * 20; beat++) {
        position_predict(&self, time_of(beat), at_rest, tilted, BEAT);
        if (beat % 15 == 0) {
            height_reading height = {.time_us = time_of(beat), .in_range = true, .ultrasonic = 2.0 / cos(0.4),
                                     .barometer = 2.0};
            position_correct_height(&self, &height, &parameters);
        }
    }
    CHECK_NEAR(self.position.z, 2.0, 0.01);
}

void test_position(void) {
    a_constant_acceleration_gives_half_a_times_t_squared();
    the_force_is_turned_by_the_attitude();
    the_first_fix_sets_the_position();
    a_fix_without_position_or_with_nonsense_is_ignored();
    a_late_fix_of_a_correct_estimate_changes_nothing();
    a_bias_of_the_accelerometer_is_learned_by_fixes_and_heights();
    the_barometer_takes_over_out_of_range();
    a_tilted_range_is_corrected();
}
