/* Attitude estimation: a complementary filter of angular rates and angles. */
#ifndef ATTITUDE_H
#define ATTITUDE_H

#include "parameters.h"
#include "quaternion.h"

/* What is known about the attitude. */
typedef struct attitude_estimator {
    quaternion attitude;
    vector bias;  /* of the gyroscopes, rad/s */
    vector rates; /* without the bias, in body axes, rad/s */
} attitude_estimator;

attitude_estimator attitude_new(void);

/* Starts from a reading, and again after a gap in the readings. */
void attitude_reset(attitude_estimator *self, vector rates, vector angles);

/* Takes in the next reading, `elapsed` seconds after the last. */
void attitude_update(attitude_estimator *self, vector rates, vector angles, double elapsed,
                     const parameters *parameters);

#endif
