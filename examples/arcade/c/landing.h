/* Detection of the ground: after touching down the vehicle stands still although it is told to sink. */
#ifndef LANDING_H
#define LANDING_H

#include "parameters.h"

#include <stdbool.h>

/* Measures for how long the vehicle has seemed to stand. */
typedef struct land_detector {
    double still; /* seconds */
} land_detector;

/* Returns true once the vehicle has stood for long enough. `thrust` is the motors' mean set-point. */
bool landing_update(land_detector *self, double height, double climb, double thrust, const parameters *parameters,
                    double elapsed);

#endif
