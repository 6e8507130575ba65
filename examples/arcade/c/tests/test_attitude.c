/* The attitude filter against known movements. */
#include "attitude.h"
#include "check.h"
#include "tests.h"

static const double BEAT = 1.0 / 300.0;

static void a_constant_bias_is_learned(void) {
    parameters parameters = parameters_default();
    attitude_estimator self = attitude_new();
    vector bias = {0.02, -0.01, 0.03};
    for (int beat = 0; beat < 300 * 60; beat++) {
        attitude_update(&self, bias, (vector){0}, BEAT, &parameters);
    }
    CHECK_NEAR(vector_length(vector_subtract(self.bias, bias)), 0.0, 1e-4);
    CHECK_NEAR(vector_length(quaternion_angles(self.attitude)), 0.0, 1e-3);
}

static void rates_are_integrated_without_delay(void) {
    parameters parameters = parameters_default();
    attitude_estimator self = attitude_new();
    for (int beat = 1; beat <= 300; beat++) {
        attitude_update(&self, (vector){.x = 1.0}, (vector){.x = beat * BEAT}, BEAT, &parameters);
    }
    CHECK_NEAR(quaternion_angles(self.attitude).x, 1.0, 1e-9);
}

static void noise_of_the_angles_is_suppressed(void) {
    parameters parameters = parameters_default();
    attitude_estimator self = attitude_new();
    for (int beat = 0; beat < 3000; beat++) {
        double noise = beat % 2 == 0 ? 0.05 : -0.05;
        attitude_update(&self, (vector){0}, (vector){noise, noise, 0.0}, BEAT, &parameters);
        CHECK_NEAR(vector_length(quaternion_angles(self.attitude)), 0.0, 0.002);
    }
}

static void a_reset_takes_the_angles_and_keeps_the_bias(void) {
    attitude_estimator self = attitude_new();
    self.bias = (vector){.z = 0.05};
    attitude_reset(&self, (vector){.z = 0.25}, (vector){.z = 2.0});
    CHECK_NEAR(self.rates.z, 0.2, 1e-12);
    CHECK_NEAR(quaternion_angles(self.attitude).z, 2.0, 1e-12);
}

void test_attitude(void) {
    a_constant_bias_is_learned();
    rates_are_integrated_without_delay();
    noise_of_the_angles_is_suppressed();
    a_reset_takes_the_angles_and_keeps_the_bias();
}
