/* Plays a motor of `motors.yaml` as `motors.rs` does: the one that SCL_COMPONENT names, or `motor left_motor`. With `motor
 * test`, it tests itself. */
#include "motors_scl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void expect(scl_status status, const char *what)
{
    if (status != SCL_OK) {
        fprintf(stderr, "%s: %s: %s\n", what, scl_status_name(status), scl_error());
        exit(1);
    }
}

/* Receives a setpoint and answers it; false once the program is to stop. */
static int answer(motors_motor *motor)
{
    scl_message *setpoint;
    char state[16];
    size_t size;
    if (motors_motor_setpoint_recv(motor, &setpoint, -1) != SCL_OK) {
        return 0;
    }
    const char *text = (const char *)scl_message_data(setpoint, &size);
    snprintf(state, sizeof state, "%.*s0", (int)size, text);
    scl_message_free(setpoint);
    expect(motors_motor_state_send(motor, state, strlen(state), -1), "send");
    return 1;
}

static void test(void)
{
    motors_motor motor;
    motors_motor_peer peer;
    scl_message *state;
    size_t size;
    expect(motors_motor_test(&motor, &peer), "test");
    if (motor.instance != MOTORS_MOTOR_INSTANCE_LEFT_MOTOR) {
        fputs("a test opens the first component\n", stderr);
        exit(1);
    }
    expect(motors_motor_peer_setpoint_send(&peer, "7", 1, -1), "setpoint");
    answer(&motor);
    expect(motors_motor_peer_state_recv(&peer, &state, -1), "state");
    const char *text = (const char *)scl_message_data(state, &size);
    printf("%.*s\n", (int)size, text);
    scl_message_free(state);
    expect(motors_motor_close(&motor, 0), "close");
    expect(motors_motor_peer_close(&peer, 0), "close");
}

int main(int count, char **arguments)
{
    motors_motor motor;
    const char *chosen = count > 1 ? arguments[1] : "";
    if (strcmp(chosen, "test") == 0) {
        test();
        return 0;
    }
    if (strcmp(chosen, "left_motor") == 0) {
        expect(motors_motor_open_as(&motor, MOTORS_MOTOR_INSTANCE_LEFT_MOTOR, NULL), "open");
    } else if (strcmp(chosen, "neither") == 0) {
        expect(motors_motor_open_as(&motor, (motors_motor_instance)2, NULL), "open");
    } else {
        expect(motors_motor_open(&motor, NULL), "open");
    }
    expect(motors_motor_ready(&motor, -1), "ready");
    puts(motor.instance == MOTORS_MOTOR_INSTANCE_LEFT_MOTOR ? "left_motor" : "right_motor");
    fflush(stdout);
    while (answer(&motor)) {
    }
    return motors_motor_close(&motor, INT64_C(1000000000)) == SCL_OK ? 0 : 1;
}
