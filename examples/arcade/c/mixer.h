/* Mixing: from collective thrust and torques to the set-points of four motors. */
#ifndef MIXER_H
#define MIXER_H

#include "vector.h"

/* What the controllers ask for. Roll, pitch and yaw are differences of motor set-points. */
typedef struct demand {
    double thrust; /* mean set-point of the motors, 0 to 1 */
    double roll, pitch, yaw;
} demand;

/* Set-points of the motors in the order of the message: front left, front right, rear left, rear right. */
typedef struct mixed {
    double motors[4];
    vector cut; /* roll, pitch and yaw that were given less those that were asked for; 0 unless an axis was reduced */
} mixed;

/* Mixes a demand for motors of the X configuration. */
mixed mixer_mix(const demand *demand);

#endif
