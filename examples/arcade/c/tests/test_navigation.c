/* Modes of flight. */
#include "check.h"
#include "navigation.h"
#include "tests.h"

static const double BEAT = 1.0 / 300.0;

static const command TAKE_OFF = {.id = 1, .action = ARCADE__ACTION__ACTION_TAKE_OFF, .target = {9.0, 9.0, 5.0}};
static const command GO_TO = {.id = 2, .action = ARCADE__ACTION__ACTION_GO_TO, .target = {10.0, 0.0, 5.0},
                              .speed = 2.0};
static const command LAND = {.id = 3, .action = ARCADE__ACTION__ACTION_LAND};

/* Navigation of a vehicle that is where it is told to be. */
typedef struct scene {
    navigator navigator;
    estimate estimate;
    parameters parameters;
} scene;

static scene scene_on_the_ground(void) {
    return (scene){.estimate = {.position = {2.0, 1.0, 0.0}, .position_valid = true, .thrust = 0.1},
                   .parameters = parameters_default()};
}

static void begin(scene *self, command command) {
    navigation_begin(&self->navigator, &command, &self->estimate, &self->parameters);
}

static drive run(scene *self, double seconds) {
    drive drive = DRIVE_OFF;
    for (double time = 0.0; time < seconds; time += BEAT) {
        drive = navigation_update(&self->navigator, &self->estimate, &self->parameters, BEAT);
        if (drive == DRIVE_FLY) {
            self->estimate.position = self->navigator.set_point.position;
            self->estimate.position.z = fmax(0.0, self->estimate.position.z);
            bool on_ground = self->navigator.set_point.position.z < 0.0;
            self->estimate.velocity = on_ground ? (vector){0} : self->navigator.set_point.velocity;
            self->estimate.thrust = on_ground ? 0.1 : 0.45;
        }
    }
    return drive;
}

static scene scene_in_the_air(void) {
    scene self = scene_on_the_ground();
    begin(&self, TAKE_OFF);
    run(&self, 10.0);
    return self;
}

static void a_take_off_idles_and_goes_straight_up(void) {
    scene self = scene_on_the_ground();
    CHECK(run(&self, 0.1) == DRIVE_OFF);
    begin(&self, TAKE_OFF);
    CHECK(run(&self, 0.9) == DRIVE_IDLE);
    CHECK(run(&self, 9.0) == DRIVE_FLY);
    CHECK(self.navigator.mode == ARCADE__MODE__MODE_FLYING && self.navigator.command_id == 1);
    CHECK_NEAR(self.estimate.position.x, 2.0, 1e-9);
    CHECK_NEAR(self.estimate.position.y, 1.0, 1e-9);
    CHECK_NEAR(self.estimate.position.z, 5.0, 0.05);
}

static void a_command_has_its_own_speed_up_to_the_limit(void) {
    scene self = scene_in_the_air();
    command fast = GO_TO;
    begin(&self, GO_TO);
    CHECK(self.navigator.speed == 2.0);
    fast.speed = 99.0;
    begin(&self, fast);
    CHECK(self.navigator.speed == self.parameters.limits.speed);
    run(&self, 15.0);
    CHECK_NEAR(self.estimate.position.x, 10.0, 0.05);
}

static void a_landing_ends_on_the_ground_below(void) {
    scene self = scene_in_the_air();
    begin(&self, LAND);
    CHECK(run(&self, 0.1) == DRIVE_FLY);
    CHECK(self.navigator.mode == ARCADE__MODE__MODE_LANDING);
    CHECK(run(&self, 15.0) == DRIVE_OFF);
    CHECK(self.navigator.mode == ARCADE__MODE__MODE_GROUNDED);
    CHECK_NEAR(self.estimate.position.x, 2.0, 1e-6);
}

static void a_lost_position_is_a_landing_without_horizontal_control(void) {
    scene self = scene_in_the_air();
    begin(&self, GO_TO);
    run(&self, 1.0);
    self.estimate.position_valid = false;
    CHECK(run(&self, 0.1) == DRIVE_FLY_LEVEL);
    CHECK(self.navigator.mode == ARCADE__MODE__MODE_LANDING);
    CHECK(self.navigator.set_point.velocity.x == 0.0);
    CHECK(self.navigator.set_point.velocity.z < 0.0);
}

void test_navigation(void) {
    a_take_off_idles_and_goes_straight_up();
    a_command_has_its_own_speed_up_to_the_limit();
    a_landing_ends_on_the_ground_below();
    a_lost_position_is_a_landing_without_horizontal_control();
}
