/*
 * Mixing. When the motors cannot give everything, roll and pitch come first, because they keep the vehicle upright;
 * then thrust, then yaw (as "airmode" in PX4's control allocation).
 */
#include "mixer.h"

/* Left motors roll to positive roll; rear motors lower the nose, which is positive pitch. */
static const double ROLL[4] = {1.0, -1.0, 1.0, -1.0};
static const double PITCH[4] = {-1.0, -1.0, 1.0, 1.0};
/* Front left and rear right turn clockwise, so that their torque turns the vehicle counter-clockwise. */
static const double YAW[4] = {1.0, -1.0, -1.0, 1.0};

/* As much of the yaw as keeps each motor between 0 and 1. */
static double limit_yaw(double yaw, const double tilt[4], double kept, double thrust) {
    double size = fabs(yaw), allowed = size;
    for (int motor = 0; motor < 4; motor++) {
        double before = thrust + tilt[motor] * kept;
        double room = YAW[motor] * yaw > 0.0 ? 1.0 - before : before;
        allowed = room < allowed ? room : allowed;
    }
    allowed = allowed < 0.0 ? 0.0 : allowed;
    return allowed == size ? yaw : yaw < 0.0 ? -allowed : allowed;
}

mixed mixer_mix(const demand *demand) {
    double tilt[4], least = 0.0, most = 0.0;
    for (int motor = 0; motor < 4; motor++) {
        tilt[motor] = ROLL[motor] * demand->roll + PITCH[motor] * demand->pitch;
        least = tilt[motor] < least ? tilt[motor] : least;
        most = tilt[motor] > most ? tilt[motor] : most;
    }
    double span = most - least;
    double kept = span > 1.0 ? 1.0 / span : 1.0;
    /* Thrust moves to where roll and pitch have room on both sides. */
    double thrust = demand->thrust;
    thrust = thrust > 1.0 - most * kept ? 1.0 - most * kept : thrust;
    thrust = thrust < -least * kept ? -least * kept : thrust;
    double yaw = limit_yaw(demand->yaw, tilt, kept, thrust);
    mixed result;
    for (int motor = 0; motor < 4; motor++) {
        result.motors[motor] = clamp(thrust + tilt[motor] * kept + YAW[motor] * yaw, 0.0, 1.0);
    }
    result.cut = (vector){
        .x = demand->roll * kept - demand->roll,
        .y = demand->pitch * kept - demand->pitch,
        .z = yaw - demand->yaw,
    };
    return result;
}
