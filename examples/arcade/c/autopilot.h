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
    bool silent;              /* and reported */
} autopilot;

/* Reads what the process before this one has saved. `gates` and `state` are open. */
void autopilot_begin(autopilot *self);

/* Works until a stop request or a failure. */
scl_status autopilot_run(autopilot *self);

#endif
