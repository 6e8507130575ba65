/* The GPS receiver: what it measures of the true position, with its errors. */
#include "receiver.h"

#include <math.h>
#include <stddef.h>

/*
 * A receiver with differential corrections, as aircraft that hover have: errors of each fix, and errors that wander
 * with the satellites and the ionosphere (Groves, section 9.3). Heights are worse because all satellites are above.
 */
static const double WHITE = 0.15;      /* metres, standard deviation */
static const double SLOW = 0.15;       /* metres, standard deviation */
static const double SLOW_TIME = 30.0;  /* seconds */
static const double HEIGHT_WORSE = 1.5;
static const double SPEED_WHITE = 0.05; /* m/s, by Doppler shift */

static const double SATELLITES = 10.0, SATELLITES_VARY = 1.2, SATELLITES_TIME = 60.0;
static const double SATELLITES_FOR_3D = 4.0; /* three coordinates and the clock's error */
static const double HOT_START = 1.0;         /* seconds from switching on to the first fix */

receiver receiver_new(uint64_t seed, outage outage) {
    return (receiver){.random = noise_from_seed(seed), .outage = outage};
}

static void switch_on(receiver *self, uint64_t time_us) {
    noise *random = &self->random;
    self->on = true;
    self->switched_on_us = self->measured_us = time_us;
    self->drift_east = SLOW * noise_normal(random);
    self->drift_north = SLOW * noise_normal(random);
    self->drift_up = SLOW * noise_normal(random);
    self->drift_satellites = SATELLITES_VARY * noise_normal(random);
}

/* Fixes are at whole multiples of the period, so a receiver that is started again keeps the beat. */
static bool is_due(const receiver *self, uint64_t time_us, double rate) {
    return floor((double)time_us * 1e-6 * rate) > floor((double)self->measured_us * 1e-6 * rate);
}

static void let_drift(receiver *self, double elapsed) {
    noise *random = &self->random;
    self->drift_east = noise_drift(random, self->drift_east, elapsed, SLOW, SLOW_TIME);
    self->drift_north = noise_drift(random, self->drift_north, elapsed, SLOW, SLOW_TIME);
    self->drift_up = noise_drift(random, self->drift_up, elapsed, SLOW, SLOW_TIME);
    self->drift_satellites = noise_drift(random, self->drift_satellites, elapsed, SATELLITES_VARY, SATELLITES_TIME);
}

static double satellites(const receiver *self, uint64_t time_us) {
    double now = (double)time_us * 1e-6;
    bool searching = now - (double)self->switched_on_us * 1e-6 < HOT_START;
    bool shadowed = self->outage.from <= now && now < self->outage.until;
    return searching || shadowed ? 0.0 : fmax(0.0, round(SATELLITES + self->drift_satellites));
}

static local_position position_with_errors(receiver *self, const Arcade__Vector *truth) {
    noise *random = &self->random;
    local_position measured = {
        .east = truth->x + self->drift_east + WHITE * noise_normal(random),
        .north = truth->y + self->drift_north + WHITE * noise_normal(random),
    };
    measured.up = truth->z + HEIGHT_WORSE * (self->drift_up + WHITE * noise_normal(random));
    return measured;
}

bool receiver_measure(receiver *self, const receiver_parameters *parameters, const Arcade__World *world,
                      Arcade__Fix *fix) {
    if (!self->on || world->time_us < self->measured_us) {
        switch_on(self, world->time_us);
    }
    if (!is_due(self, world->time_us, parameters->rate) || world->position == NULL || world->velocity == NULL) {
        return false;
    }
    let_drift(self, (double)(world->time_us - self->measured_us) * 1e-6);
    self->measured_us = world->time_us;
    *fix = (Arcade__Fix)ARCADE__FIX__INIT;
    fix->time_us = world->time_us;
    fix->satellites = (uint32_t)satellites(self, world->time_us);
    if (fix->satellites < SATELLITES_FOR_3D || !limits_are_known(&parameters->limits)) {
        return true; /* of quality NONE, without a position */
    }
    geodetic_position position = geodesy_from_local(parameters->limits.home, position_with_errors(self, world->position));
    fix->quality = ARCADE__FIX_QUALITY__FIX_QUALITY_3D;
    fix->latitude = position.latitude;
    fix->longitude = position.longitude;
    fix->altitude = position.altitude;
    fix->east_speed = world->velocity->x + SPEED_WHITE * noise_normal(&self->random);
    fix->north_speed = world->velocity->y + SPEED_WHITE * noise_normal(&self->random);
    return true;
}
