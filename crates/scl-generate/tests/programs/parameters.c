/* The parameters of `controls.yaml`. The environment has SCL_SET=controller.gain=1.5,left_motor.pin=3. */
#include "controls_scl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "line %d: not `%s`; last error: %s\n", __LINE__, #condition, scl_error()); \
            exit(1); \
        } \
    } while (0)
#define OK(call) CHECK((call) == SCL_OK)

static void every_type_has_its_default(void)
{
    controls_controller controller;
    controls_controller_peer peer;
    OK(controls_controller_test(&controller, &peer));
    const controls_controller_parameters *found = &controller.parameters;
    CHECK(found->gain == 0.8 && found->ratio == 0.5f && found->period_ns == 10000000);
    CHECK(strcmp(found->label, "left \"front\"") == 0 && found->enabled && !found->class_);
    CHECK(found->mode == CONTROLS_CONTROLLER_MODE_MANUAL);
    CHECK(found->offsets[0] == 0 && found->offsets[1] == 0.5 && found->offsets[2] == -1);
    CHECK(found->names_count == 2 && strcmp(found->names[0], "a") == 0 && strcmp(found->names[1], "b, c") == 0);
    CHECK(found->delays_count == 2 && found->delays_ns[0] == 1000000 && found->delays_ns[1] == 2000000000);
    CHECK(found->flags[0] && !found->flags[1] && found->limits_count == 0);
    CHECK(strcmp(found->corners[0], "north") == 0 && strcmp(found->corners[1], "south") == 0);
    CHECK(found->i8 == -8 && found->i16 == -16 && found->i32 == -32 && found->i64 == INT64_MIN);
    CHECK(found->u8 == 8 && found->u16 == 16 && found->u32 == 32 && found->u64 == UINT64_MAX);
    CHECK(found->list_count == 2 && found->list[1] == 2);
    OK(controls_controller_close(&controller, 0));
    CHECK(controller.parameters.label == NULL);
    OK(controls_controller_peer_close(&peer, 0));
}

static void values_are_set(void)
{
    controls_controller controller;
    OK(controls_controller_open(&controller, "{\"set\": {\"controller.mode\": \"auto\"}}"));
    CHECK(controller.parameters.gain == 1.5 && controller.parameters.mode == CONTROLS_CONTROLLER_MODE_AUTO);
    OK(controls_controller_close(&controller, 0));

    controls_motor motor;
    OK(controls_motor_open_as(&motor, CONTROLS_MOTOR_INSTANCE_LEFT_MOTOR, NULL));
    CHECK(motor.parameters.pin == 3 && motor.parameters.direction == CONTROLS_MOTOR_DIRECTION_CLOCK_WISE);
    OK(controls_motor_close(&motor, 0));

    controls_motor_peer peer;
    CHECK(controls_motor_test(&motor, &peer) == SCL_ENVIRONMENT);
    CHECK(strstr(scl_error(), "parameter `left_motor.pin` (u8) has no value") != NULL);
    OK(controls_motor_test_with(&motor, &peer, "{\"set\": {\"left_motor.pin\": \"4\"}}"));
    CHECK(motor.parameters.pin == 4);
    OK(controls_motor_close(&motor, 0));
    OK(controls_motor_peer_close(&peer, 0));
}

static void live_parameters_are_taken_over(void)
{
    controls_controller controller;
    controls_controller_peer peer;
    bool changed = true;
    OK(controls_controller_test(&controller, &peer));
    OK(controls_controller_update_parameters(&controller, 0, &changed));
    CHECK(!changed);
    OK(scl_set_parameter(controller.component, "mode", "auto"));
    OK(scl_set_parameter(controller.component, "names", "[c]"));
    CHECK(controller.parameters.mode == CONTROLS_CONTROLLER_MODE_MANUAL);
    OK(controls_controller_update_parameters(&controller, 0, &changed));
    CHECK(changed && controller.parameters.mode == CONTROLS_CONTROLLER_MODE_AUTO && controller.parameters.gain == 0.8);
    CHECK(controller.parameters.names_count == 1 && strcmp(controller.parameters.names[0], "c") == 0);
    CHECK(controls_controller_update_parameters(NULL, 0, &changed) == SCL_ARGUMENT);
    OK(controls_controller_close(&controller, 0));
    OK(controls_controller_peer_close(&peer, 0));
}

int main(void)
{
    every_type_has_its_default();
    live_parameters_are_taken_over();
    values_are_set();
    puts("done");
    return 0;
}
