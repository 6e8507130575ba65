/* What the autopilot flies by: its own parameters, and the limits that `configuration` tells all components. */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include "arcade_scl.h"
#include "readings.h"

typedef struct parameters {
    arcade_autopilot_parameters tuning;
    limits limits; /* all 0 until they are known */
} parameters;

#endif
