/* The GPS receiver: what it measures of the true position, with its errors. */
#ifndef RECEIVER_H
#define RECEIVER_H

#include "arcade.pb-c.h"
#include "noise.h"
#include "readings.h"

#include <stdbool.h>

typedef struct receiver_parameters {
    double rate; /* fixes a second */
    limits limits; /* all 0 until they are known */
} receiver_parameters;

/* A time without reception, in seconds of the vehicle's clock. */
typedef struct outage {
    double from, until;
} outage;

typedef struct receiver {
    noise random;
    outage outage;
    bool on;
    uint64_t switched_on_us, measured_us; /* by the vehicle's clock */
    double drift_east, drift_north, drift_up; /* metres */
    double drift_satellites;
} receiver;

receiver receiver_new(uint64_t seed, outage outage);

/*
 * Measures if a fix is due at the time of `world`. Returns false otherwise. The first call switches the receiver on; a
 * clock that goes back means that the world began anew, and switches it on again.
 */
bool receiver_measure(receiver *self, const receiver_parameters *parameters, const Arcade__World *world,
                      Arcade__Fix *fix);

#endif
