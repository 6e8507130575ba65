/* Estimation of position and velocity: complementary filters of acceleration, GPS and height sensors. */
#ifndef POSITION_H
#define POSITION_H

#include "parameters.h"
#include "quaternion.h"
#include "readings.h"

static const double GRAVITY = 9.81; /* m/s^2 */

enum { POSITION_HISTORY = 256 }; /* estimates are kept for 0.85 s at 300 Hz */

/* What was estimated at one beat. */
typedef struct past_estimate {
    uint64_t time_us;
    vector position, velocity;
    double upright; /* the cosine of the angle between the body's z axis and the vertical */
} past_estimate;

/* What is known about position and velocity, in metres and m/s, x east, y north, z up from home. */
typedef struct position_estimator {
    vector position, velocity;
    vector bias;             /* of the acceleration in the world's axes, m/s^2 */
    double barometer_offset; /* what the barometer shows too much, m */
    uint64_t fix_us;         /* when the last fix was measured; 0 before the first */
    uint64_t height_us;      /* when the last height was measured; 0 before the first */
    past_estimate history[POSITION_HISTORY];
    size_t next; /* the index in `history` of the next estimate */
} position_estimator;

/* Integrates the specific force in body axes over the `elapsed` seconds before `time_us`. */
void position_predict(position_estimator *self, uint64_t time_us, vector force, quaternion attitude, double elapsed);

/* Carries on over a gap in the readings, at constant velocity. */
void position_coast(position_estimator *self, uint64_t time_us, quaternion attitude, double elapsed);

/* Takes in a height. Above the ultrasonic sensor's range the barometer counts, by what it showed before. */
void position_correct_height(position_estimator *self, const height_reading *height, const parameters *parameters);

/* Takes in a fix: its horizontal position and velocity. Heights by GPS are worse than by the other sensors. */
void position_correct_fix(position_estimator *self, const fix_reading *fix, const parameters *parameters);

/* Returns false before the first fix and long after the last one. */
bool position_is_valid(const position_estimator *self, uint64_t time_us);

#endif
