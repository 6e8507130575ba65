/* Steers towards the speed that the user interface asks for. */
#include "rover_scl.h"

#include <math.h>
#include <stdio.h>

static scl_status steer(rover_controller *c, double target_speed) {
    Rover__Measurement *measured;
    scl_status status = rover_controller_sensor_recv(c, &measured, -1);
    if (status != SCL_OK) {
        return status;
    }
    Rover__Setpoint setpoint = ROVER__SETPOINT__INIT;
    setpoint.throttle = fmax(-1.0, fmin(target_speed - measured->speed, 1.0));
    rover_controller_sensor_free(measured);
    return rover_controller_actuator_send(c, &setpoint, -1);
}

static scl_status obey(rover_controller *c, double *target_speed) {
    rover_controller_commands_request command;
    scl_status status = rover_controller_commands_take_request(c, &command, -1);
    if (status != SCL_OK) {
        return status;
    }
    *target_speed = command.message->target_speed;
    char text[60];
    snprintf(text, sizeof text, "target is now %.1f m/s", *target_speed);
    Rover__Event event = ROVER__EVENT__INIT;
    event.text = text;
    status = rover_controller_events_send(c, &event, -1);
    Rover__Status accepted = ROVER__STATUS__INIT;
    accepted.accepted = true;
    scl_status replied = rover_controller_commands_reply(&command, &accepted);
    /* A user interface that has been stopped no longer waits for the reply. */
    return status == SCL_OK && replied != SCL_REQUESTER_GONE ? replied : status;
}

int main(void) {
    rover_controller c;
    double target_speed = 1.0;
    scl_status status = rover_controller_open(&c, NULL);
    while (status == SCL_OK) {
        uint64_t ready;
        status = rover_controller_wait(&c, ROVER_CONTROLLER_SENSOR | ROVER_CONTROLLER_COMMANDS, -1, &ready);
        if (status == SCL_OK && (ready & ROVER_CONTROLLER_SENSOR) != 0) {
            status = steer(&c, target_speed);
        }
        if (status == SCL_OK && (ready & ROVER_CONTROLLER_COMMANDS) != 0) {
            status = obey(&c, &target_speed);
        }
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "%s\n", scl_error());
        return 1;
    }
    rover_controller_close(&c, 1000000000);
    return 0;
}
