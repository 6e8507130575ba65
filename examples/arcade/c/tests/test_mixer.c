/* Mixing, within the motors' limits and beyond. */
#include "check.h"
#include "mixer.h"
#include "tests.h"

/* What four set-points make of thrust, roll, pitch and yaw: the inverse of mixing. */
static demand met_by(mixed mixed) {
    const double *m = mixed.motors;
    return (demand){
        .thrust = (m[0] + m[1] + m[2] + m[3]) / 4.0,
        .roll = (m[0] - m[1] + m[2] - m[3]) / 4.0,
        .pitch = (-m[0] - m[1] + m[2] + m[3]) / 4.0,
        .yaw = (m[0] - m[1] - m[2] + m[3]) / 4.0,
    };
}

static void a_demand_within_limits_is_met_exactly(void) {
    mixed mixed = mixer_mix(&(demand){.thrust = 0.5, .roll = 0.1, .pitch = -0.2, .yaw = 0.05});
    demand met = met_by(mixed);
    CHECK(mixed.cut.x == 0.0 && mixed.cut.y == 0.0 && mixed.cut.z == 0.0);
    CHECK_NEAR(met.thrust, 0.5, 1e-12);
    CHECK_NEAR(met.roll, 0.1, 1e-12);
    CHECK_NEAR(met.pitch, -0.2, 1e-12);
    CHECK_NEAR(met.yaw, 0.05, 1e-12);
}

static void roll_and_pitch_survive_full_thrust_and_full_yaw(void) {
    mixed mixed = mixer_mix(&(demand){.thrust = 1.0, .roll = 0.2, .pitch = 0.1, .yaw = 0.5});
    demand met = met_by(mixed);
    CHECK(mixed.cut.x == 0.0 && mixed.cut.y == 0.0);
    CHECK_NEAR(mixed.cut.z, met.yaw - 0.5, 1e-12);
    CHECK_NEAR(met.roll, 0.2, 1e-12);
    CHECK_NEAR(met.pitch, 0.1, 1e-12);
    for (int motor = 0; motor < 4; motor++) {
        CHECK(mixed.motors[motor] >= 0.0 && mixed.motors[motor] <= 1.0);
    }
}

static void without_thrust_the_motors_speed_up_to_stay_upright(void) {
    demand met = met_by(mixer_mix(&(demand){.roll = 0.1}));
    CHECK_NEAR(met.roll, 0.1, 1e-12);
    CHECK_NEAR(met.thrust, 0.1, 1e-12);
}

static void impossible_torques_keep_their_direction(void) {
    mixed mixed = mixer_mix(&(demand){.thrust = 0.5, .roll = 2.0, .pitch = 1.0});
    demand met = met_by(mixed);
    CHECK_NEAR(met.roll / met.pitch, 2.0, 1e-12);
    CHECK_NEAR(mixed.cut.x, met.roll - 2.0, 1e-12);
    CHECK_NEAR(mixed.cut.y, met.pitch - 1.0, 1e-12);
    CHECK(mixed.cut.z == 0.0);
}

void test_mixer(void) {
    a_demand_within_limits_is_met_exactly();
    roll_and_pitch_survive_full_thrust_and_full_yaw();
    without_thrust_the_motors_speed_up_to_stay_upright();
    impossible_torques_keep_their_direction();
}
