/* Navigation: the mode of flight, and where the vehicle is to be now. */
#ifndef NAVIGATION_H
#define NAVIGATION_H

#include "landing.h"
#include "parameters.h"
#include "readings.h"
#include "trajectory.h"

/* What the motors are to do. */
typedef enum drive {
    DRIVE_OFF,
    DRIVE_IDLE,
    DRIVE_FLY,
    DRIVE_FLY_LEVEL, /* without horizontal position */
} drive;

/* Where the vehicle is, as far as navigation wants to know. */
typedef struct estimate {
    vector position, velocity;
    double yaw; /* radians */
    bool position_valid;
    double thrust; /* mean set-point of the motors */
} estimate;

/* The state of the flight. */
typedef struct navigator {
    Arcade__Mode mode;
    uint32_t command_id; /* of the command in effect */
    vector target;
    double target_yaw; /* radians */
    double speed;      /* m/s, at most */
    set_point set_point;
    double in_mode; /* seconds since the mode began */
    land_detector land_detector;
} navigator;

/* Starts to carry out a command that was checked. */
void navigation_begin(navigator *self, const command *command, const estimate *estimate, const parameters *parameters);

/* Moves the set-point on by `elapsed` seconds and changes the mode when its time has come. */
drive navigation_update(navigator *self, const estimate *estimate, const parameters *parameters, double elapsed);

#endif
