/* The moving set-point on the way to a target, with limited speed and acceleration. */
#ifndef TRAJECTORY_H
#define TRAJECTORY_H

#include "parameters.h"
#include "vector.h"

/* Where the vehicle is to be now. */
typedef struct set_point {
    vector position, velocity, acceleration;
    double yaw; /* radians */
} set_point;

/* Where the set-point goes. */
typedef struct leg {
    vector target;
    double yaw;
    double speed; /* m/s, horizontally */
    double climb; /* m/s, up and down */
} leg;

/* Advances by `elapsed` seconds. Horizontal and vertical movement are independent. */
void trajectory_advance(set_point *self, const leg *leg, const parameters *parameters, double elapsed);

#endif
