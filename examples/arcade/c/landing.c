/*
 * Detection of the ground, by the conditions of PX4's land detector: low, no vertical movement, and little thrust, for
 * a while.
 */
#include "landing.h"

#include <math.h>

static const double LOW = 0.5;   /* m */
static const double STILL = 0.2; /* m/s */
/* Share of the hover thrust. In the air, thrust this low would mean a fall. */
static const double LITTLE_THRUST = 0.6;
static const double HOLD = 0.5; /* s */

bool landing_update(land_detector *self, double height, double climb, double thrust, const parameters *parameters,
                    double elapsed) {
    bool stands = height < LOW && fabs(climb) < STILL && thrust < LITTLE_THRUST * parameters->tuning.thrust_hover;
    self->still = stands ? self->still + elapsed : 0.0;
    return self->still >= HOLD;
}
