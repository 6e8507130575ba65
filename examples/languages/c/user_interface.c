/* Asks for another speed every second and shows what happens. */
#include "rover_scl.h"

#include <stdio.h>
#include <unistd.h>

static scl_status ask(rover_user_interface *ui, double target_speed) {
    Rover__Command command = ROVER__COMMAND__INIT;
    command.target_speed = target_speed;
    Rover__Status *answer;
    scl_status status = rover_user_interface_commands_call(ui, &command, &answer, -1);
    if (status == SCL_TIMEOUT || status == SCL_PEER_LOST) {
        /* The controller is not running, or is being replaced. */
        printf("asked for %.1f m/s: no answer\n", target_speed);
        return SCL_OK;
    }
    if (status != SCL_OK) {
        return status;
    }
    printf("asked for %.1f m/s: %s\n", target_speed, answer->accepted ? "accepted" : answer->reason);
    rover_user_interface_commands_free(answer);
    Rover__Event *event;
    status = rover_user_interface_events_recv(ui, &event, -1);
    if (status == SCL_OK) {
        printf("event: %s\n", event->text);
        rover_user_interface_events_free(event);
    }
    return status;
}

int main(void) {
    setlinebuf(stdout);
    rover_user_interface ui;
    scl_status status = rover_user_interface_open(&ui, NULL);
    for (int step = 0; status == SCL_OK; step++) {
        sleep(1);
        status = ask(&ui, step % 2 == 0 ? 0.5 : 1.5);
    }
    if (status != SCL_STOPPED) {
        fprintf(stderr, "%s\n", scl_error());
        return 1;
    }
    rover_user_interface_close(&ui, 1000000000);
    return 0;
}
