/* Which commands are accepted, and in words why others are not. */
#include "commands.h"

#include <stdarg.h>
#include <stdio.h>

static const double LOWEST = 1.0; /* m: nearer to the ground the vehicle only takes off and lands */

__attribute__((format(printf, 2, 3))) static bool refuse(char reason[COMMANDS_REASON_SIZE], const char *format, ...) {
    va_list values;
    va_start(values, format);
    vsnprintf(reason, COMMANDS_REASON_SIZE, format, values);
    va_end(values);
    return false;
}

static bool check_height(double height, const parameters *parameters, char *reason) {
    if (height < LOWEST) {
        return refuse(reason, "height %.1f m is below %.1f m", height, LOWEST);
    }
    if (height > parameters->limits.fence_height) {
        return refuse(reason, "height %.1f m is above the fence at %.1f m", height, parameters->limits.fence_height);
    }
    return true;
}

static bool check_distance(vector target, const parameters *parameters, char *reason) {
    double distance = vector_horizontal(target);
    if (distance > parameters->limits.fence_radius) {
        return refuse(reason, "target is %.1f m from home, the fence at %.1f m", distance, parameters->limits.fence_radius);
    }
    return true;
}

static bool check_take_off(const command *command, situation situation, const parameters *parameters, char *reason) {
    if (situation.mode != ARCADE__MODE__MODE_GROUNDED) {
        return refuse(reason, "already in the air");
    }
    if (!situation.position_valid) {
        return refuse(reason, "no position: waiting for a GPS fix");
    }
    return check_height(command->target.z, parameters, reason);
}

static bool check_go_to(const command *command, situation situation, const parameters *parameters, char *reason) {
    if (situation.mode == ARCADE__MODE__MODE_GROUNDED) {
        return refuse(reason, "on the ground: take off first");
    }
    if (situation.height < LOWEST) {
        return refuse(reason, "too low: below %.1f m", LOWEST);
    }
    if (!situation.position_valid) {
        return refuse(reason, "no position: the last GPS fix is too old");
    }
    if (command->speed < 0.0) {
        return refuse(reason, "speed %.1f m/s is negative", command->speed);
    }
    return check_height(command->target.z, parameters, reason) && check_distance(command->target, parameters, reason);
}

bool commands_check(const command *command, situation situation, const parameters *parameters,
                    char reason[COMMANDS_REASON_SIZE]) {
    if (!vector_is_finite(command->target) || !isfinite(command->yaw) || !isfinite(command->speed)) {
        return refuse(reason, "a value is not a finite number");
    }
    if (command->id == 0) {
        return refuse(reason, "the command has no id");
    }
    switch (command->action) {
    case ARCADE__ACTION__ACTION_TAKE_OFF:
        return check_take_off(command, situation, parameters, reason);
    case ARCADE__ACTION__ACTION_GO_TO:
        return check_go_to(command, situation, parameters, reason);
    case ARCADE__ACTION__ACTION_LAND:
        return situation.mode != ARCADE__MODE__MODE_GROUNDED || refuse(reason, "already on the ground");
    case ARCADE__ACTION__ACTION_RETURN:
        return refuse(reason, "the autopilot does not plan a return: send GO_TO and LAND");
    default:
        return refuse(reason, "unknown action");
    }
}
