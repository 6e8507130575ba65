/* Publishes a made-up speed ten times a second. */
#include "rover_scl.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

int main(void) {
    setlinebuf(stdout);
    rover_sensor sensor;
    scl_status status = rover_sensor_open(&sensor, NULL);
    for (int step = 0; status == SCL_OK; step++) {
        usleep(100000);
        Rover__Measurement measurement = ROVER__MEASUREMENT__INIT;
        measurement.speed = 1.0 + sin(step);
        printf("speed %.2f m/s\n", measurement.speed);
        status = rover_sensor_measurements_send(&sensor, &measurement, -1);
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "%s\n", scl_error());
        return 1;
    }
    rover_sensor_close(&sensor, 1000000000);
    return 0;
}
