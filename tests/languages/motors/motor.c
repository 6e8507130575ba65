/* Plays a motor of `motors.yaml` as `motors.rs` does: the one that SCL_COMPONENT names, or `motor left_motor`. `motor
 * controller` and `motor display` play these, and `motor test` tests itself. */
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

static void say(const char *sender, scl_message *message)
{
    size_t size;
    const char *text = (const char *)scl_message_data(message, &size);
    printf("%s %.*s\n", sender, (int)size, text);
    fflush(stdout);
    scl_message_free(message);
}

/* Follows commands such as `left 1`, and says which motor has answered. */
static void control(void)
{
    motors_controller controller;
    motors_motor_instance motor = MOTORS_MOTOR_INSTANCE_LEFT_MOTOR;
    scl_message *state;
    char side[16], value[16];
    expect(motors_controller_open(&controller, NULL), "open");
    if (motors_controller_states_last_sender(&controller, &motor) != SCL_NOTHING) {
        fputs("nothing was received yet\n", stderr);
        exit(1);
    }
    puts("open");
    fflush(stdout);
    while (scanf("%15s %15s", side, value) == 2) {
        expect(motors_controller_ready(&controller, -1), "ready");
        expect(strcmp(side, "left") == 0 ? motors_controller_left_send(&controller, value, strlen(value), -1)
                                         : motors_controller_right_send(&controller, value, strlen(value), -1),
               "send");
        expect(motors_controller_states_recv_from(&controller, &state, &motor, -1), "recv_from");
        say(motor == MOTORS_MOTOR_INSTANCE_LEFT_MOTOR ? "left_motor" : "right.motor", state);
    }
    expect(motors_controller_close(&controller, 0), "close");
}

/* Says every number and where it comes from. */
static void display(void)
{
    motors_display display;
    motors_display_numbers_sender sender;
    scl_message *number;
    expect(motors_display_open(&display, NULL), "open");
    puts("open");
    fflush(stdout);
    while (motors_display_numbers_recv(&display, &number, -1) == SCL_OK) {
        expect(motors_display_numbers_last_sender(&display, &sender), "last_sender");
        switch (sender) {
        case MOTORS_DISPLAY_NUMBERS_SENDER_LEFT_MOTOR:
            say("LeftMotor", number);
            break;
        case MOTORS_DISPLAY_NUMBERS_SENDER_RIGHT_MOTOR:
            say("RightMotor", number);
            break;
        case MOTORS_DISPLAY_NUMBERS_SENDER_CONTROLLER_LEFT:
            say("ControllerLeft", number);
            break;
        case MOTORS_DISPLAY_NUMBERS_SENDER_CONTROLLER_RIGHT:
            say("ControllerRight", number);
            break;
        }
    }
    expect(motors_display_close(&display, 0), "close");
}

int main(int count, char **arguments)
{
    motors_motor motor;
    const char *chosen = count > 1 ? arguments[1] : "";
    if (strcmp(chosen, "test") == 0) {
        test();
        return 0;
    }
    if (strcmp(chosen, "controller") == 0) {
        control();
        return 0;
    }
    if (strcmp(chosen, "display") == 0) {
        display();
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
    puts(motor.instance == MOTORS_MOTOR_INSTANCE_LEFT_MOTOR ? "left_motor" : "right.motor");
    fflush(stdout);
    while (answer(&motor)) {
    }
    return motors_motor_close(&motor, INT64_C(1000000000)) == SCL_OK ? 0 : 1;
}
