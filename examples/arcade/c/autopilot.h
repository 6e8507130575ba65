/* The loop of the autopilot: its gates, its clock and its state file around the flight controller. */
#ifndef AUTOPILOT_H
#define AUTOPILOT_H

#include "arcade_scl.h"
#include "flight_controller.h"
#include "resume.h"

typedef struct autopilot {
    arcade_autopilot gates;
    resume state;
    flight_controller controller;
    flight_controller saved; /* by the process before this one */
    bool has_saved;
    uint64_t last_reading_ns; /* CLOCK_MONOTONIC */
    bool silent;              /* readings are missing, and that is reported */
    Arcade__Mode mode;        /* that is reported */
} autopilot;

/* Reads what the process before this one has saved. `gates` and `state` are open. */
void autopilot_begin(autopilot *self);

/*
 * Waits for readings and requests, at most 200 ms, and handles what there is. Returns `SCL_OK`, or why the program has
 * to end.
 */
scl_status autopilot_turn(autopilot *self);

#endif
