/* The moving set-point. */
#include "check.h"
#include "tests.h"
#include "trajectory.h"

static const double BEAT = 1.0 / 300.0;

static void the_target_is_reached_without_overshoot_and_within_limits(void) {
    parameters parameters = parameters_default();
    leg leg = {.target = {15.0, 0.0, 5.0}, .yaw = 1.0, .speed = 3.0, .climb = 1.0};
    set_point self = {0};
    double fastest = 0.0;
    for (int beat = 0; beat < 300 * 15; beat++) {
        vector before = self.velocity;
        trajectory_advance(&self, &leg, &parameters, BEAT);
        fastest = fmax(fastest, vector_horizontal(self.velocity));
        double change = vector_horizontal(vector_subtract(self.velocity, before));
        CHECK(change <= parameters.tuning.limit_acceleration * BEAT + 1e-9);
        CHECK(self.velocity.z <= 1.1);
        CHECK(self.position.x < 15.05);
    }
    CHECK_NEAR(vector_length(vector_subtract(self.position, leg.target)), 0.0, 0.02);
    CHECK_NEAR(fastest, 3.0, 0.1);
    CHECK_NEAR(self.yaw, 1.0, 1e-9);
}

static void a_turn_takes_the_shorter_way(void) {
    parameters parameters = parameters_default();
    set_point self = {.yaw = 3.0};
    trajectory_advance(&self, &(leg){.yaw = -3.0}, &parameters, BEAT);
    CHECK(self.yaw > 3.0);
}

void test_trajectory(void) {
    the_target_is_reached_without_overshoot_and_within_limits();
    a_turn_takes_the_shorter_way();
}
