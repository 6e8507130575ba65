/* Whole beats: when inputs take effect, and what a restart carries on with. */
#include "check.h"
#include "flight_controller.h"
#include "tests.h"

#include <string.h>

static const uint64_t START_US = 1000000;

/* Knows its limits. */
static flight_controller new_controller(void) {
    parameters parameters = parameters_default();
    flight_controller self = flight_controller_new(&parameters.tuning);
    self.parameters.limits = parameters.limits;
    return self;
}

/* A reading at rest and level. */
static bool step_at(flight_controller *self, uint64_t time_us, outputs *outputs) {
    Arcade__Vector gravity = ARCADE__VECTOR__INIT;
    Arcade__Inertial reading = ARCADE__INERTIAL__INIT;
    gravity.z = GRAVITY;
    reading.time_us = time_us;
    reading.acceleration = &gravity;
    return flight_controller_step(self, &reading, outputs);
}

static outputs run(flight_controller *self, uint64_t from_us, uint64_t until_us) {
    outputs outputs = {0};
    for (uint64_t time_us = from_us; time_us < until_us; time_us += 3333) {
        CHECK(step_at(self, time_us, &outputs));
    }
    return outputs;
}

static void receive_fix(flight_controller *self, uint64_t time_us) {
    Arcade__Fix fix = ARCADE__FIX__INIT;
    fix.time_us = time_us;
    fix.quality = ARCADE__FIX_QUALITY__FIX_QUALITY_3D;
    fix.latitude = self->parameters.limits.home.latitude;
    fix.longitude = self->parameters.limits.home.longitude;
    flight_controller_receive_fix(self, &fix);
}

static bool receive_command(flight_controller *self, uint32_t id, Arcade__Action action, uint64_t effective_us,
                            char *reason) {
    Arcade__Vector target = ARCADE__VECTOR__INIT;
    Arcade__Command command = ARCADE__COMMAND__INIT;
    target.z = 5.0;
    command.id = id;
    command.action = action;
    command.target = &target;
    command.effective_us = effective_us;
    return flight_controller_receive_command(self, &command, reason);
}

static void a_reading_that_is_not_newer_is_passed_over(void) {
    flight_controller self = new_controller();
    outputs outputs;
    CHECK(step_at(&self, START_US, &outputs));
    CHECK(!step_at(&self, START_US, &outputs));
    CHECK(!step_at(&self, START_US - 1, &outputs));
    CHECK(self.time_us == START_US);
}

static void a_height_takes_effect_20_ms_and_a_fix_60_ms_after_it_was_measured(void) {
    flight_controller self = new_controller();
    Arcade__Height height = ARCADE__HEIGHT__INIT;
    height.time_us = START_US;
    outputs outputs;
    step_at(&self, START_US, &outputs);
    flight_controller_receive_height(&self, &height);
    receive_fix(&self, START_US);
    step_at(&self, START_US + 19999, &outputs);
    CHECK(self.position.height_us == 0);
    step_at(&self, START_US + 20000, &outputs);
    CHECK(self.position.height_us == START_US && self.position.fix_us == 0);
    step_at(&self, START_US + 59999, &outputs);
    CHECK(self.position.fix_us == 0);
    step_at(&self, START_US + 60000, &outputs);
    CHECK(self.position.fix_us == START_US);
}

static void parameters_take_effect_at_the_next_whole_second(void) {
    flight_controller self = new_controller();
    parameters parameters = self.parameters;
    Arcade__Limits limits = ARCADE__LIMITS__INIT;
    parameters.tuning.attitude_p = 5.0;
    limits.speed = 1.25;
    outputs outputs;
    step_at(&self, START_US, &outputs);
    flight_controller_receive_tuning(&self, &parameters.tuning);
    flight_controller_receive_limits(&self, &limits);
    step_at(&self, START_US + 999999, &outputs);
    CHECK(self.parameters.limits.speed == 4.0 && self.parameters.tuning.attitude_p == 6.0);
    step_at(&self, START_US + 1000000, &outputs);
    CHECK(self.parameters.limits.speed == 1.25 && self.parameters.tuning.attitude_p == 5.0);
}

static void a_command_takes_effect_at_its_time_and_once(void) {
    flight_controller self = new_controller();
    char reason[COMMANDS_REASON_SIZE];
    run(&self, START_US, START_US + 100000);
    CHECK(!receive_command(&self, 7, ARCADE__ACTION__ACTION_TAKE_OFF, 0, reason));
    CHECK(strcmp(reason, "no position: waiting for a GPS fix") == 0);
    receive_fix(&self, START_US + 90000);
    run(&self, START_US + 100000, START_US + 200000);

    CHECK(receive_command(&self, 7, ARCADE__ACTION__ACTION_TAKE_OFF, START_US + 300000, reason));
    CHECK(receive_command(&self, 7, ARCADE__ACTION__ACTION_TAKE_OFF, START_US + 300000, reason)); /* repeated */
    CHECK(self.commands.count == 1);
    CHECK(run(&self, START_US + 200000, START_US + 300000).motors[0] == 0.0);
    CHECK(self.navigator.mode == ARCADE__MODE__MODE_GROUNDED);
    CHECK(run(&self, START_US + 300000, START_US + 400000).motors[0] == self.parameters.tuning.thrust_minimum);
    CHECK(self.navigator.mode == ARCADE__MODE__MODE_TAKING_OFF && self.navigator.command_id == 7);
    CHECK(receive_command(&self, 7, ARCADE__ACTION__ACTION_TAKE_OFF, 0, reason)); /* in effect */
    CHECK(self.commands.count == 0);
}

static void thirty_messages_of_the_flight_are_due_in_a_second(void) {
    flight_controller self = new_controller();
    int due = 0;
    for (uint64_t time_us = START_US; time_us < START_US + 1000000; time_us += 3333) {
        outputs outputs;
        step_at(&self, time_us, &outputs);
        due += outputs.flight_due;
    }
    CHECK(due == 30);
}

static flight_controller controller_taking_off(void) {
    flight_controller self = new_controller();
    char reason[COMMANDS_REASON_SIZE];
    receive_fix(&self, START_US);
    run(&self, START_US, START_US + 100000);
    receive_command(&self, 1, ARCADE__ACTION__ACTION_TAKE_OFF, 0, reason);
    run(&self, START_US + 100000, START_US + 200000);
    return self;
}

static void a_flight_is_resumed_within_two_seconds(void) {
    flight_controller grounded = new_controller(), taking_off = controller_taking_off();
    run(&grounded, START_US, START_US + 100000);
    CHECK(!flight_controller_can_resume(&grounded, grounded.time_us + 1));
    CHECK(flight_controller_can_resume(&taking_off, taking_off.time_us + 2000000));
    CHECK(!flight_controller_can_resume(&taking_off, taking_off.time_us + 2000001));
    CHECK(!flight_controller_can_resume(&taking_off, taking_off.time_us));
}

/* After a gap the rates are not differentiated over it, and the position carries on at constant velocity. */
static void a_gap_does_not_upset_the_estimates(void) {
    flight_controller self = controller_taking_off();
    outputs outputs;
    self.position.velocity = (vector){.x = 2.0};
    double before = self.position.position.x;
    uint64_t time_us = self.time_us + 500000;
    CHECK(step_at(&self, time_us, &outputs));
    CHECK_NEAR(self.position.position.x - before, 1.0, 1e-9);
    CHECK_NEAR(vector_length(self.rate_controller.derivative), 0.0, 1e-9);
}

void test_flight_controller(void) {
    a_reading_that_is_not_newer_is_passed_over();
    a_height_takes_effect_20_ms_and_a_fix_60_ms_after_it_was_measured();
    parameters_take_effect_at_the_next_whole_second();
    a_command_takes_effect_at_its_time_and_once();
    thirty_messages_of_the_flight_are_due_in_a_second();
    a_flight_is_resumed_within_two_seconds();
    a_gap_does_not_upset_the_estimates();
}
