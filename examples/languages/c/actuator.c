/* Applies each set-point. */
#include "rover_scl.h"

#include <stdio.h>

int main(void) {
    setlinebuf(stdout);
    rover_actuator actuator;
    Rover__Setpoint *setpoint;
    scl_status status = rover_actuator_open(&actuator, NULL);
    while (status == SCL_OK && (status = rover_actuator_setpoint_recv(&actuator, &setpoint, -1)) == SCL_OK) {
        printf("throttle %+.2f\n", setpoint->throttle);
        rover_actuator_setpoint_free(setpoint);
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "%s\n", scl_error());
        return 1;
    }
    rover_actuator_close(&actuator, 1000000000);
    return 0;
}
