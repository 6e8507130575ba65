/* A wheel: it follows the set-point, and stops when none comes. */
#include "drive_scl.h"

#include <stdio.h>
#include <unistd.h>

static scl_status say(drive_wheel *wheel, char *text) {
    Drive__Record record = DRIVE__RECORD__INIT;
    record.component = (char *)scl_component_name(wheel->component);
    record.text = text;
    return drive_wheel_log_send(wheel, &record, -1);
}

/* Returns the newest set-point, zero if none has come in time, or else the last one. */
static scl_status follow(drive_wheel *wheel, double *target) {
    Drive__Setpoint *setpoint;
    uint64_t missed;
    scl_status status = scl_take_missed(wheel->gates.setpoint, &missed);
    if (missed > 0) {
        *target = 0;
    }
    if (status != SCL_OK || (status = drive_wheel_setpoint_latest(wheel, &setpoint)) != SCL_OK) {
        return status == SCL_NOTHING ? SCL_OK : status;
    }
    *target = setpoint->speed;
    drive_wheel_setpoint_free(setpoint);
    return SCL_OK;
}

int main(void) {
    drive_wheel wheel;
    double target = 0, speed = 0;
    scl_status status = drive_wheel_open(&wheel, NULL);
    if (status == SCL_OK) {
        status = say(&wheel, "runs in C");
    }
    while (status == SCL_OK) {
        usleep(50000);
        status = follow(&wheel, &target);
        if (status == SCL_OK) {
            speed += (target - speed) * wheel.parameters.response;
            Drive__WheelState state = DRIVE__WHEEL_STATE__INIT;
            state.speed = speed;
            state.language = "C";
            status = drive_wheel_state_send(&wheel, &state, -1);
        }
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "%s\n", scl_error());
        return 1;
    }
    drive_wheel_close(&wheel, 1000000000);
    return 0;
}
