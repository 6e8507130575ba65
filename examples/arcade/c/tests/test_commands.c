/* Which commands are refused, and why. */
#include "check.h"
#include "commands.h"
#include "tests.h"

#include <string.h>

#define TAKE_OFF ARCADE__ACTION__ACTION_TAKE_OFF
#define GO_TO ARCADE__ACTION__ACTION_GO_TO
#define LAND ARCADE__ACTION__ACTION_LAND
#define RETURN ARCADE__ACTION__ACTION_RETURN

static const situation FLYING = {ARCADE__MODE__MODE_FLYING, 5.0, true};
static const situation LOW = {ARCADE__MODE__MODE_FLYING, 0.4, true};
static const situation LOST = {ARCADE__MODE__MODE_FLYING, 5.0, false};
static const situation GROUNDED = {ARCADE__MODE__MODE_GROUNDED, 0.0, true};
static const situation GROUNDED_LOST = {ARCADE__MODE__MODE_GROUNDED, 0.0, false};

static const char *refusal(command command, situation situation) {
    static char reason[COMMANDS_REASON_SIZE];
    parameters parameters = parameters_default();
    return commands_check(&command, situation, &parameters, reason) ? "" : reason;
}

static command to(Arcade__Action action, double x, double y, double z) {
    return (command){.id = 1, .action = action, .target = {x, y, z}};
}

#define CHECK_REFUSED(command, situation, reason) CHECK(strcmp(refusal((command), (situation)), (reason)) == 0)

static void commands_within_limits_are_accepted(void) {
    CHECK_REFUSED(to(TAKE_OFF, 0.0, 0.0, 5.0), GROUNDED, "");
    CHECK_REFUSED(to(GO_TO, 60.0, -70.0, 29.0), FLYING, "");
    CHECK_REFUSED(to(LAND, 0.0, 0.0, 0.0), FLYING, "");
    CHECK_REFUSED(to(LAND, 0.0, 0.0, 0.0), LOST, "");
}

static void others_are_refused_with_the_reason(void) {
    command backwards = to(GO_TO, 0.0, 0.0, 5.0);
    backwards.speed = -1.0;
    CHECK_REFUSED(to(TAKE_OFF, 0.0, 0.0, 5.0), FLYING, "already in the air");
    CHECK_REFUSED(to(TAKE_OFF, 0.0, 0.0, 5.0), GROUNDED_LOST, "no position: waiting for a GPS fix");
    CHECK_REFUSED(to(TAKE_OFF, 0.0, 0.0, 31.0), GROUNDED, "height 31.0 m is above the fence at 30.0 m");
    CHECK_REFUSED(to(TAKE_OFF, 0.0, 0.0, 0.5), GROUNDED, "height 0.5 m is below 1.0 m");
    CHECK_REFUSED(to(GO_TO, 0.0, 0.0, 5.0), GROUNDED, "on the ground: take off first");
    CHECK_REFUSED(to(GO_TO, 0.0, 0.0, 5.0), LOW, "too low: below 1.0 m");
    CHECK_REFUSED(to(GO_TO, 0.0, 0.0, 5.0), LOST, "no position: the last GPS fix is too old");
    CHECK_REFUSED(to(GO_TO, 90.0, 80.0, 5.0), FLYING, "target is 120.4 m from home, the fence at 100.0 m");
    CHECK_REFUSED(to(GO_TO, NAN, 0.0, 5.0), FLYING, "a value is not a finite number");
    CHECK_REFUSED(backwards, FLYING, "speed -1.0 m/s is negative");
    CHECK_REFUSED(to(LAND, 0.0, 0.0, 0.0), GROUNDED, "already on the ground");
    CHECK_REFUSED(to(RETURN, 0.0, 0.0, 0.0), FLYING, "the autopilot does not plan a return: send GO_TO and LAND");
    CHECK_REFUSED((command){.action = LAND}, FLYING, "the command has no id");
    CHECK_REFUSED(to((Arcade__Action)77, 0.0, 0.0, 0.0), FLYING, "unknown action");
}

static void a_reason_fits_whatever_the_numbers(void) {
    CHECK(strlen(refusal(to(TAKE_OFF, 0.0, 0.0, 1.7e308), GROUNDED)) == COMMANDS_REASON_SIZE - 1);
}

void test_commands(void) {
    commands_within_limits_are_accepted();
    others_are_refused_with_the_reason();
    a_reason_fits_whatever_the_numbers();
}
